// Virtual bench: pressing the indenter in, its gauge, kept readings, and the report of a fit.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { answered, findBody, frames, keepPicture, openSession, startProgram, temporaryFolder } from "../../../../web/test/e2e/harness.mjs";

const folder = temporaryFolder();
const scene = join(folder, "block.toml");
writeFileSync(
  scene,
  `gravity = [0, 0, 0]
[time]
step = 0.01
integrator = "quasi_static"
[[body]]
name = "block"
shape = { box = { upper = [0.12, 0.06, 0.08], cells = [6, 3, 4] } }
material = { model = "neo_hookean", young = "X < 0.06 ? 1e4 : 4e4", poisson = 0.4, density = 1000 }
[[body.pin]]
where = "Y < 1e-6"
`,
);
process.chdir(folder); // the bench writes to out/bench
const program = await startProgram(scene);
const benchOf = ({ messages }) => messages.findLast(({ kind }) => kind === "bench");

async function openBench(more = {}) {
  const opened = await openSession(program, more);
  await opened.page.getByRole("tab", { name: "Bench" }).click();
  return opened;
}

// Touches the body at a place relative to its middle, and presses the indenter to a depth in millimeters.
async function pressIn(opened, depth, right = 0) {
  const { page, heard, until } = opened;
  if (heard.state.a.tool) {
    await page.getByRole("button", { name: "Lift", exact: true }).click();
    const step = heard.state.a.step;
    await until("no indenter", () => heard.state.a.tool === null && (!heard.state.playing || heard.state.a.step > step + 2));
  }
  const [x, y] = await findBody(opened);
  await page.mouse.move(x + right, y);
  await page.mouse.down();
  await page.mouse.up();
  await until("an indenter", () => heard.state.a.tool?.wanted === 0);
  const field = page.getByLabel("Depth [mm]");
  await field.fill(String(depth));
  await field.press("Enter");
  await until("a depth", () => Math.abs(1000 * heard.state.a.tool.depth - depth) < 1e-9);
}

const press = (opened, name, what, isIt) =>
  answered(opened, what, isIt, () => opened.page.getByRole("button", { name, exact: true }).click());

test("the gauge shows force, depth and radius", async () => {
  const opened = await openBench();
  const { page, heard, until, close } = opened;
  await pressIn(opened, 3);
  const gauge = page.getByLabel("Force of the indenter");
  await until("a force in newtons", async () => / N$/.test(await gauge.textContent()) && heard.state.a.tool.force > 0.01);
  await until("its place", async () => /^sphere of radius [\d.]+ mm, 3 mm deep$/.test(await page.locator(".bench-force + p").textContent()));
  const before = heard.state.a.tool.force;
  await page.getByLabel("Depth [mm]").fill("6");
  await page.getByLabel("Depth [mm]").press("Enter");
  await until("more force", () => heard.state.a.tool.depth > 0.0059 && heard.state.a.tool.force > 1.5 * before);
  await page.getByRole("button", { name: "Lift", exact: true }).click();
  await until("no indenter", () => heard.state.a.tool === null);
  await frames(page);
  assert.equal(await gauge.textContent(), "–");
  await close();
});

test("readings are kept, forgotten and fitted", async () => {
  const opened = await openBench();
  const { page, heard, until, close } = opened;
  const items = page.getByRole("list", { name: "Readings" }).getByRole("listitem");
  for (const right of [-60, 0, 60]) {
    await pressIn(opened, 6, right);
    const kept = await press(opened, "Keep this reading", "a reading", ({ do: what }) => what === "keep");
    assert.equal(kept.kind, "reply", kept.why);
  }
  await until("three lines", async () => (await items.count()) === 3);
  assert.match(await items.first().textContent(), /poke \d+r [\d.]+ mm6 mm[\d.]+ N/);
  await items.nth(1).getByRole("button").click();
  await until("two lines", async () => benchOf(heard).readings.length === 2 && (await items.count()) === 2);
  const begun = await press(opened, "Fit the stiffness", "a fit", ({ do: what }) => what === "fit");
  assert.equal(begun.kind, "reply", begun.why);
  const report = page.getByRole("button", { name: "Open the report" });
  await report.waitFor({ timeout: 180_000 });
  await keepPicture(page, "bench");
  const [shown] = await Promise.all([page.waitForEvent("popup"), report.click()]);
  await shown.getByRole("heading", { level: 1, name: "Fit of block" }).waitFor();
  await keepPicture(shown, "bench_report");
  await close();
});

// Virtual bench: pressing the probe in, its gauge, recorded cases, and a fit that appears on the body.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { answered, findBody, frames, openSession, startProgram, temporaryFolder } from "./harness.mjs";

const folder = temporaryFolder();
const scene = join(folder, "block.toml");
writeFileSync(
  scene,
  `gravity = [0, 0, 0]
[time]
step = 0.01
[[body]]
name = "block"
shape = { box = { upper = [0.12, 0.06, 0.08], cells = [6, 3, 4] } }
material = { model = "neo_hookean", young = "X < 0.06 ? 1e4 : 4e4", poisson = 0.4, density = 1000 }
[[body.pin]]
where = "Y < 1e-6"
`,
);
const program = await startProgram(scene);
const size = (v) => Math.hypot(...v);
const captureOf = ({ messages }) => messages.findLast(({ kind }) => kind === "capture");

async function openBench() {
  const opened = await openSession(program);
  await opened.page.getByRole("tab", { name: "Capture" }).click();
  await opened.until("markers", (heard) => captureOf(heard)?.markers.triangles.length > 10);
  return opened;
}

// Touches the body and presses the tip to a depth by keys.
async function pressIn(opened, notches) {
  const { page, heard, until } = opened;
  const [x, y] = await findBody(opened);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await until("a tip", () => heard.state.a.probe);
  await page.mouse.up();
  for (let k = 0; k < notches; ++k) await page.keyboard.press("j");
  await until("a depth", () => heard.state.a.probe.depth > 0 && Math.abs(heard.state.a.probe.depth - heard.state.a.probe.wanted) < 1e-12);
}

const press = (opened, name, what, isIt) =>
  answered(opened, what, isIt, () => opened.page.getByRole("button", { name, exact: true }).click());

test("a tip's force grows with its depth", async () => {
  const opened = await openBench();
  const { page, heard, until, close } = opened;
  await pressIn(opened, 8);
  const gauge = page.getByLabel("Force of the tip");
  await until("a force on the gauge", async () => / m?N$/.test(await gauge.textContent()));
  await until("a force at rest", () => size(heard.state.a.probe.force) > 0.01);
  const before = { ...heard.state.a.probe, force: size(heard.state.a.probe.force) };
  for (let k = 0; k < 8; ++k) await page.keyboard.press("j");
  await until("more force", () => heard.state.a.probe.depth > 1.5 * before.depth && size(heard.state.a.probe.force) > 1.2 * before.force);
  await page.getByRole("button", { name: "Lift" }).click();
  await until("no tip", () => heard.state.a.probe === null);
  await frames(page);
  assert.equal(await gauge.textContent(), "–");
  await close();
});

test("cases are recorded, listed and deleted", async () => {
  const opened = await openBench();
  const { page, heard, until, close } = opened;
  await pressIn(opened, 12);
  const reply = await press(opened, "3 depths here", "recording", ({ do: what }) => what === "record");
  assert.equal(reply.kind, "reply", reply.why);
  await until("three cases", () => captureOf(heard).cases.length === 3);
  const items = page.getByRole("list", { name: "Cases" }).getByRole("listitem");
  await until("three lines", async () => (await items.count()) === 3);
  assert.match(await items.first().textContent(), /poke 1, depth 1/);
  await items.nth(1).getByRole("button").click();
  await until("two lines", async () => captureOf(heard).cases.length === 2 && (await items.count()) === 2);
  await page.getByRole("button", { name: "Forget all" }).click();
  await until("no line", async () => (await items.count()) === 0);
  await close();
});

test("pokes are fitted and the result simulated", async () => {
  const opened = await openBench();
  const { page, heard, until, close } = opened;
  await page.getByLabel("places").fill("6");
  const poked = await press(opened, "Poke all over", "pokes", ({ do: what }) => what === "poke_all");
  assert.equal(poked.kind, "reply", poked.why);
  await until("twelve cases", () => captureOf(heard).cases.length === 12);
  const begun = await press(opened, "Fit the stiffness", "a fit", ({ do: what }) => what === "fit");
  assert.equal(begun.kind, "reply", begun.why);
  await until("a stiffness on the body", () => heard.scenes.a.field === "fitted_young" && heard.pictures.a.max > heard.pictures.a.min);
  await until("the end of the fit", () => captureOf(heard).fit?.running === false && captureOf(heard).fit.has_material);
  assert.equal(captureOf(heard).fit.failure, "");
  await until("words about it", async () => /Done: iteration/.test(await page.getByLabel("Fit", { exact: true }).textContent()));
  const shown = await press(opened, "Simulate it", "a comparison", ({ do: what }) => what === "simulate_fit");
  assert.equal(shown.kind, "reply", shown.why);
  await until("both sides", () => heard.state.b && heard.scenes.b?.label === "fitted material" && heard.scenes.b.field === "young");
  await close();
});

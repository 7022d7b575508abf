// Minimization in detail: single iterations, their tables, curves and landscapes; functions of two variables.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { answered, assertSameBits, boxOf, contrast, downloaded, frames, isDrawn, keepPicture, openSession, pageModule, pressAndWait, settled, shownBy, startProgram, toTheStart, until as eventually } from "./harness.mjs";

const { kPresets } = await pageModule("panels/functionForm.ts");
const program = await startProgram("scenes/cantilever.toml", ["--set", "time.step=0.05"]); // needs several iterations

async function open(panel) {
  const opened = await openSession(program, { keepsPixels: true });
  const tab = opened.page.getByRole("tab", { name: panel });
  await tab.click();
  assert.equal(await tab.getAttribute("aria-selected"), "true");
  return opened;
}

const isQuestion = ({ ask }) => ask === "function";
const rowsOf = (page, label) => page.getByRole("grid", { name: label });
const countOf = async (page, label) => Number(await rowsOf(page, label).getAttribute("aria-rowcount"));

async function iterate(opened) {
  await pressAndWait(opened, "i", "an iteration", () => true);
  return opened.heard.state.a;
}

test("single iterations have a row each", async () => {
  const opened = await open("Microscope");
  const { page, heard, until, close } = opened;
  let rows = 0;
  for (;;) {
    const { iteration, step } = await iterate(opened);
    if (iteration < 0) {
      assert.equal(step, 1);
      break;
    }
    assert.equal(step, 0);
    rows = iteration + 1;
    await until("its row", async () => (await countOf(page, "Iterations of the chosen step")) === rows);
    if (iteration === 1) await keepPicture(page, "microscope_mid_step");
    await until("the picture of this iteration", () => heard.pictures.a.iteration === iteration);
  }
  assert.ok(rows > 1, `${rows} iterations`);
  const { steps } = heard.messages.findLast(({ kind }) => kind === "steps");
  await until("a row of the last one", async () => (await countOf(page, "Iterations of the chosen step")) === steps.at(-1).iterations.length);
  await until("one step", async () => (await countOf(page, "Steps")) === 1);
  await page.getByText(/^Step 1\./).waitFor();
  await close();
});

test("the error of the mesh is estimated on request", async () => {
  const opened = await open("Certificate");
  const { page, heard, until, close } = opened;
  for (let step = 1; step <= 5; ++step) await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step === step);
  await page.getByRole("button", { name: "Estimate", exact: true }).click();
  await page.locator(".mesh-error").filter({ hasText: /makes 'beam' about .*\(step\s5\)/ }).waitFor();
  await page.getByRole("button", { name: "Show as color", exact: true }).click();
  await until("its color", () => heard.scenes.a.field === "mesh_error" && heard.pictures.a.values?.some((value) => value > 0));
  await keepPicture(page, "mesh_error");
  await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step === 6);
  await until("no color", () => heard.scenes.a.field === "");
  await toTheStart(opened);
  await close();
});

test("a step by iterations is bit-identical", async () => {
  const opened = await open("Microscope");
  const { heard, until, close } = opened;
  await pressAndWait(opened, "s", "a step", ({ state, pictures }) => state.a.step === 1 && pictures.a.step === 1);
  const whole = heard.pictures.a.positions;
  await toTheStart(opened);
  while (heard.state.a.step === 0) await iterate(opened);
  await until("its picture", ({ pictures }) => pictures.a.step === 1 && pictures.a.iteration === -1);
  assertSameBits(heard.pictures.a.positions, whole);
  await close();
});

test("keys choose iterations and their line search", async () => {
  const opened = await open("Microscope");
  const { page, heard, until, close } = opened;
  await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step === 1);
  const replies = () => heard.messages.filter(({ kind, reply }) => kind === "reply" && reply?.curve);
  await until("E along d", () => replies().length > 0);
  const table = rowsOf(page, "Iterations of the chosen step");
  await table.locator('tr[aria-selected="true"]').waitFor();
  const last = heard.messages.findLast(({ kind }) => kind === "steps").steps.at(-1).iterations.length - 1;
  await until("a row for each", async () => (await countOf(page, "Iterations")) === last + 1);
  await table.press("Home");
  await until("iteration 0", () => replies().some(({ reply }) => reply.iteration === 0));
  await table.press("End");
  await until("the last iteration", () => replies().some(({ reply }) => reply.iteration === last));
  await table.press("Home");
  const { curve, trials, value } = replies().find(({ reply }) => reply.iteration === 0).reply;
  assert.ok(curve.alpha.length > 20 && curve.value.length === curve.alpha.length);
  assert.ok(trials.some(({ accepted }) => accepted));
  assert.ok(Number.isFinite(value));
  const charts = page.locator(".microscope-charts canvas");
  await until("several charts", async () => (await charts.count()) >= 2);
  for (const chart of await charts.all()) if (await chart.isVisible()) await until("a chart that is not blank", () => isDrawn(chart));
  await keepPicture(page, "microscope");
  await close();
});

test("the worst tets are listed and marked", async () => {
  const opened = await open("Microscope");
  const { page, heard, until, close } = opened;
  await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step === 1);
  await page.getByRole("button", { name: "Worst elements", exact: true }).click();
  await until("the list", () => heard.messages.some(({ kind, reply }) => kind === "reply" && reply?.items?.length > 0));
  await page.locator("ol.worst li").first().waitFor();
  await keepPicture(page, "worst_elements");
  await close();
});

test("the landscape shows E, model and path", async () => {
  const opened = await open("Landscape");
  const { page, heard, until, close } = opened;
  await page.getByText("No iteration has been computed yet").waitFor();
  await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step === 1);
  const slice = await until("the slice", () => heard.messages.find(({ kind, reply }) => kind === "reply" && reply?.slice)?.reply.slice);
  assert.equal(slice.value.length, slice.columns * slice.rows);
  const canvas = page.getByRole("tabpanel", { name: "Landscape" }).locator("canvas").first();
  await page.getByText("This is E over the plane").waitFor();
  await until("a surface", () => isDrawn(canvas));
  await keepPicture(page, "landscape");
  await settled(opened);
  const { print } = await shownBy(canvas);
  await page.getByRole("checkbox", { name: "quadratic model" }).uncheck();
  await until("another picture", async () => (await shownBy(canvas)).print !== print);
  await page.getByRole("button", { name: "◀" }).or(page.getByTitle("The iteration before")).first().click();
  await page.getByText(/step 1, iteration \d+ of/).waitFor();
  await close();
});

test("each example function is minimized from anywhere", async () => {
  const opened = await open("Functions");
  const { page, heard, until, close } = opened;
  const panel = page.getByRole("tabpanel", { name: "Functions" });
  const replies = () => heard.messages.filter(({ kind, reply }) => kind === "reply" && reply?.formula !== undefined);
  await until("the first function", () => replies().length > 0);
  const canvas = panel.locator("canvas").first();
  for (const [i, preset] of kPresets.entries()) {
    const { reply } = await answered(opened, preset.title, isQuestion, () => panel.getByRole("button", { name: preset.title, exact: true }).click());
    assert.deepEqual([reply.path[0].x, reply.path[0].y], preset.start);
    assert.equal(reply.value.length, reply.samples ** 2);
    assert.ok(reply.iterations.length > 0 && reply.text !== "");
    await until("its surface", () => isDrawn(canvas));
    await keepPicture(page, `functions_${i}`);
  }
  for (const typed of ["0.25", "-0.5"]) {
    const x = panel.getByLabel("start x");
    await x.fill(typed);
    await x.press("Enter");
    await until(`a start at ${typed}`, () => replies().at(-1).reply.path[0].x === Number(typed));
  }
  await close();
});

test("keys and mouse move the initial point", async () => {
  const opened = await open("Functions");
  const { page, heard, until, close } = opened;
  const panel = page.getByRole("tabpanel", { name: "Functions" });
  const replies = () => heard.messages.filter(({ kind, reply }) => kind === "reply" && reply?.formula !== undefined);
  await until("the first function", () => replies().length > 0);
  const startOf = () => replies().at(-1).reply.path[0];
  const start = startOf();
  const view = panel.locator("canvas").first();
  await view.press("Shift+ArrowRight");
  await until("a start to the right", () => startOf().x > start.x);
  const nudged = startOf();
  const ring = panel.getByText("start: drag me");
  const typed = async () => [await panel.getByLabel("start x").inputValue(), await panel.getByLabel("y", { exact: true }).inputValue()].join();
  const before = await typed();
  let tries = 0;
  await eventually("a start that the mouse took", async () => {
    await settled(opened);
    const [mark, box] = [await boxOf(ring), await boxOf(view)];
    // The label is beside its ring. A mouse that misses the ring turns the picture.
    const sides = [[-9, 9], [-10, 0], [-8, -8], [mark.width + 10, 0]];
    const [dx, dy] = sides[tries++ % sides.length];
    await page.mouse.move(mark.x + dx, mark.y + mark.height / 2 + dy);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2, { steps: 3 });
    await page.mouse.up();
    await frames(page);
    return (await typed()) !== before;
  });
  await until("a start elsewhere", () => startOf().x !== nudged.x || startOf().y !== nudged.y);
  await close();
});

test("impossible functions are refused", async () => {
  const opened = await open("Functions");
  const { page, heard, until, close } = opened;
  const panel = page.getByRole("tabpanel", { name: "Functions" });
  await panel.getByLabel("f", { exact: true }).selectOption("formula");
  const formula = panel.getByLabel("Formula of x and y");
  for (const typed of ["x +", "sin(", "z^2", "1/0", "(".repeat(900), ""]) {
    const answer = await answered(opened, `'${typed}'`, ({ ask, name }) => ask === "function" && name === typed, async () => {
      await formula.fill(typed);
      await formula.press("Enter");
    });
    if (answer.kind === "refused") await panel.locator("#function-error").filter({ hasText: /\w{3}/ }).waitFor();
  }
  await formula.fill("x^2 + 3 * y^2");
  await formula.press("Enter");
  await until("a function again", () => heard.messages.some(({ reply }) => reply?.formula?.includes("3")));
  await page.waitForFunction(() => document.querySelector("#function-error").textContent === "");
  await close();
});

test("energies are plotted and saved per step", async () => {
  const opened = await open("Energy");
  const { page, heard, close } = opened;
  for (let step = 1; step <= 12; ++step) await pressAndWait(opened, "s", `step ${step}`, ({ state }) => state.a.step === step);
  const panel = page.getByRole("tabpanel", { name: "Energy" });
  const file = await downloaded(page, () => panel.getByRole("button", { name: "CSV" }).click());
  const [head, ...rows] = readFileSync(await file.path(), "utf8").trim().split("\n").map((line) => line.split(","));
  assert.equal(rows.filter(([step]) => Number(step) > 0).length, 12);
  const kinetic = head.findIndex((name) => /kinetic/.test(name));
  assert.ok(kinetic > 0, head.join());
  const reported = new Map(heard.messages.filter(({ kind }) => kind === "steps").flatMap(({ steps }) => steps).map((row) => [row.step, row]));
  for (const row of rows) {
    assert.equal(row.length, head.length);
    assert.ok(row.every((entry) => entry === "" || Number.isFinite(Number(entry))), row.join());
    if (Number(row[0]) > 0) assert.equal(Number(row[kinetic]), reported.get(Number(row[0])).kinetic);
  }
  const picture = await downloaded(page, () => panel.getByRole("button", { name: "PNG" }).click());
  assert.ok((await contrast(page, readFileSync(await picture.path()))) > 3);
  const log = panel.getByRole("checkbox", { name: "log" });
  await log.check();
  await frames(page);
  await keepPicture(page, "energy_log");
  await log.uncheck();
  await frames(page);
  await keepPicture(page, "energy");
  await close();
});

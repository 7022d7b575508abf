// Speeds of the page and of its engine, printed beside their targets and not judged: they depend on the machine and its
// load. NATIVE is the program of ./run.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { pageModule, root, temporaryFolder, theBrowser } from "../e2e/harness.mjs";
import { engineInNode, nativeRows, openSite, places } from "./site.mjs";

const kRepeats = 5;
const median = (numbers) => numbers.toSorted((x, y) => x - y)[Math.floor(numbers.length / 2)];

// A draw of the body, which has more corners of triangles than anything else.
function noteFirstPicture() {
  const { drawElements } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.drawElements = function (mode, count, ...more) {
    drawElements.call(this, mode, count, ...more);
    if (count > 1000) requestAnimationFrame(() => (window.firstPicture ??= performance.now()));
  };
}

test("first picture of the body", async () => {
  for (const [place, address] of Object.entries(places)) {
    const times = [];
    for (let i = 0; i < kRepeats; ++i) {
      const context = await (await theBrowser()).newContext();
      const page = await context.newPage();
      await page.addInitScript(noteFirstPicture);
      await page.goto(address);
      times.push(await (await page.waitForFunction(() => window.firstPicture, null, { timeout: 0 })).jsonValue());
      await context.close();
    }
    console.log(`${place}: ${(median(times) / 1000).toFixed(2)} s, best ${(Math.min(...times) / 1000).toFixed(2)} s (target: < 2 s)`);
  }
});

// Bodies with 1512 and 2983 vertices.
const kCells = "[41, 5, 5]";
const kBeam = readFileSync(join(root, "scenes/cantilever.toml"), "utf8").replace("[15, 3, 3]", kCells);

const kSteps = 60;

// CPU time of each step [ms].
function stepsOfEngine({ messages, handle }) {
  handle({ do: "reset" });
  return Array.from({ length: kSteps }, () => {
    messages.length = 0;
    const start = process.cpuUsage();
    handle({ do: "step" });
    return process.cpuUsage(start).user / 1000;
  });
}

// The shortest time of each step in the repeats, summed: other programs and the compiler of Node.js disturb a step, but
// not every time.
const undisturbed = (repeats) => repeats[0].reduce((sum, _, step) => sum + Math.min(...repeats.map((times) => times[step])), 0);

for (const name of ["beam", "bunny"]) test(`${name}: engine and native program with one thread`, async () => {
  const copy = join(temporaryFolder(), "beam.toml");
  writeFileSync(copy, kBeam);
  const opened = await engineInNode("/scenes/bunny.toml");
  opened.write("/scenes/beam.toml", kBeam);
  opened.handle({ do: "load", scene: `/scenes/${name}.toml` });
  const [engine, native] = [[], []];
  for (let i = 0; i < kRepeats; ++i) {
    engine.push(stepsOfEngine(opened));
    assert.equal(opened.messages.findLast(({ kind }) => kind === "state").a.step, kSteps);
    const rows = nativeRows(name === "beam" ? copy : "scenes/bunny.toml", kSteps, "timings.csv", process.env.NATIVE);
    native.push(rows.slice(-kSteps).map((row) => 1000 * row.cpu_seconds));
  }
  const [ours, theirs] = [undisturbed(engine) / kSteps, undisturbed(native) / kSteps];
  console.log(`${name}: ${ours.toFixed(1)} ms per step, native ${theirs.toFixed(1)} ms: ${(theirs / ours).toFixed(2)} of native speed (target: >= 0.5)`);
  console.log(`${name}: ${(1000 / ours).toFixed(0)} steps per second of CPU time (target at 1512 vertices: >= 60)`);
});

test("steps in Chromium", async () => {
  const { linkText } = await pageModule("share.ts");
  const link = await linkText({ aspic_workspace: 1, scene: "/scenes/cantilever.toml", overrides: [`body.0.shape.box.cells=${kCells}`, "time.step=0.005"], settings: {}, compare: null, page: {} });
  const opened = await openSite(places["a file"] + link, "cantilever");
  const { page, until, heard } = opened;
  await until("1512 vertices", () => heard.scenes.a.vertices === 1512);
  await page.keyboard.press(" ");
  await until("a run", ({ state }) => state.playing && state.a.step >= 20);
  const [first, start] = [heard.state.a.step, performance.now()];
  await until("more steps", ({ state }) => state.a.step >= first + 200);
  const rate = (1000 * (heard.state.a.step - first)) / (performance.now() - start);
  console.log(`beam in Chromium, drawn without a graphics card: ${rate.toFixed(0)} steps per second (target: >= 60)`);
  await opened.close();
});

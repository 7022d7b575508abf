// Bytes and milliseconds per picture of a fine surface, and the time to the first picture. Only the bytes are checked.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join, relative } from "node:path";
import { test } from "node:test";
import { openPage, openSession, root, setPlaying, startProgram, temporaryFolder } from "./harness.mjs";

const kRings = 114; // twice as many points on each ring: about 26 000 vertices
const kLargestPicture = 1.2e6; // [bytes]

// Scene with a sphere as a fine skin around a coarse cage.
function writeScene(folder) {
  const points = [[0, 0, 1], [0, 0, -1]];
  for (let i = 1; i < kRings; ++i)
    for (let j = 0; j < 2 * kRings; ++j) {
      const [theta, phi] = [(Math.PI * i) / kRings, (Math.PI * j) / kRings];
      points.push([Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)]);
    }
  const at = (i, j) => 3 + (i - 1) * 2 * kRings + (j % (2 * kRings)); // OBJ counts from 1
  const faces = [];
  for (let j = 0; j < 2 * kRings; ++j) {
    faces.push([1, at(1, j), at(1, j + 1)], [2, at(kRings - 1, j + 1), at(kRings - 1, j)]);
    for (let i = 1; i + 1 < kRings; ++i) faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
  }
  const lines = [...points.map((p) => `v ${p.join(" ")}`), ...faces.map((f) => `f ${f.join(" ")}`)];
  writeFileSync(join(folder, "sphere.obj"), `${lines.join("\n")}\n`);
  const scene = join(folder, "sphere.toml");
  writeFileSync(
    scene,
    `[[body]]
name = "sphere"
shape = { box = { lower = [-1.05, -1.05, -1.05], upper = [1.05, 1.05, 1.05], cells = [6, 6, 6] } }
skin = "sphere.obj"
material = { model = "neo_hookean", young = 1e5, poisson = 0.4, density = 1000 }
[[body.pin]]
name = "base"
where = { lowest = 0.1 }
`,
  );
  return { scene: relative(root, scene), vertices: points.length };
}

const milliseconds = (seconds) => `${(1000 * seconds).toFixed(1)} ms`;

test("pictures of 26 000 vertices are small", async (t) => {
  const { scene, vertices } = writeScene(temporaryFolder());
  const program = await startProgram(scene);
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  assert.equal(heard.geometries.a.rest.length, 3 * vertices);
  await page.locator("#toolbar select").first().selectOption("0.1"); // slow, so that the program leaves the processors to the page
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable");
  const metrics = async () => Object.fromEntries((await session.send("Performance.getMetrics")).metrics.map(({ name, value }) => [name, value]));
  for (const color of ["", "von_mises"]) {
    const choice = page.getByRole("combobox", { name: "Color by" }).or(page.locator("#right .lil-controller").filter({ hasText: "Color by" }).locator("select"));
    await choice.first().selectOption({ index: color === "" ? 0 : 1 });
    await until("pictures of this color", ({ scenes, pictures }) => (scenes.a.field !== "") === (pictures.a.values !== null));
    const [first, before] = [heard.counted, await metrics()];
    await setPlaying(opened, true);
    await until("ten pictures", () => heard.counted >= first + 10);
    await setPlaying(opened, false);
    const [count, after] = [heard.counted - first, await metrics()];
    const each = (name) => milliseconds((after[name] - before[name]) / count);
    assert.ok(heard.bytes < kLargestPicture, `${heard.bytes} bytes`);
    t.diagnostic(`${heard.scenes.a.field || "no field"}: ${vertices} vertices, ${heard.bytes} bytes per picture; main thread per picture ${each("TaskDuration")}, of it scripts ${each("ScriptDuration")}, layout ${each("LayoutDuration")}; its CPU time ${each("ThreadTime")}`);
  }
  await close();
});

test("measures the time to the first picture", async (t) => {
  const start = performance.now();
  const scene = "scenes/bunny.toml";
  const program = await startProgram(scene);
  const listening = performance.now();
  const opened = await openPage(program.address);
  await opened.until("a picture", ({ pictures }) => pictures.a);
  await opened.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const drawn = performance.now();
  t.diagnostic(`${scene}: server after ${milliseconds((listening - start) / 1000)}, first picture ${milliseconds((drawn - listening) / 1000)} later, with the start of the browser's page`);
  await opened.close();
});

// The states of scenes: native, under Node.js, with threads and in Chromium.
import assert from "node:assert/strict";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { test } from "node:test";
import { drop, root, temporaryFolder } from "../e2e/harness.mjs";
import { engineInNode, hashesIn, loadScene, nativeHashes, openSite, places, requested, takeSteps, testsAll, threads } from "./site.mjs";

const kSteps = 3;

// The states of a scene after each of kSteps steps.
function hashesOf({ messages, handle }, path) {
  handle({ do: "load", scene: path });
  messages.length = 0;
  for (let step = 0; step < kSteps; ++step) handle({ do: "step" });
  return hashesIn(messages);
}

// A bar that stretches and sags, for each material, and with other parts of bodies.
function bars({ messages, handle }) {
  handle({ do: "load", scene: "/scenes/cantilever.toml" });
  const { settings } = messages.findLast(({ kind }) => kind === "scene");
  const models = settings.find(({ key }) => key === "material.model").choices;
  assert.ok(models.length >= 15, models.join(" "));
  const bar = (model, more = "") => `
    [time]
    step = 0.02
    [[body]]
    shape = { box = { upper = [0.3, 0.1, 0.1], cells = [6, 2, 2] } }
    deform = { displacement = ["0.2 * X", 0, 0] }
    material = { model = "${model}", young = 2e4, poisson = 0.3 }
    ${more}
    [[body.pin]]
    where = "x < 1e-6"`;
  const parts = {
    fibre: '[[body.fibre]]\ndirection = [1, "X", 0]\nstiffness = 1e4\ndispersion = 0.1',
    muscle: '[[body.muscle]]\ndirection = [1, 0, 0]\nstrength = 1e4\nactivation = "sin(30 * t)^2"',
    quadratic: "order = 2",
  };
  return [...models.map((model) => [model, bar(model)]), ...Object.entries(parts).map(([name, text]) => [name, bar("neo_hookean", text)])].map(
    ([name, text]) => ({ path: `bars/${name}.toml`, text }));
}

// All scenes of the repository and the bars: their paths in the engine, and natively. Those that the page does not ship
// have a text, and need no other files; pillow.toml is coarser, because it has more tets than the page allows.
function everyScene(engine) {
  engine.handle({ ask: "gallery", id: 1 });
  const shipped = engine.messages.find(({ id }) => id === 1).reply.scenes.map(({ path }) => ({ path, native: path.slice(1) }));
  const found = ["scenes/capture", "tests/random_scenes"].flatMap((folder) =>
    readdirSync(join(root, folder)).filter((name) => name.endsWith(".toml")).map((name) => join(folder, name)));
  const others = found.map((path) => ({ path, text: readFileSync(join(root, path), "utf8").replace("height = 0.06, size = 0.004", "height = 0.06, size = 0.006") }));
  const copies = temporaryFolder();
  return shipped.concat([...others, ...bars(engine)].map(({ path, text }) => {
    const native = join(copies, basename(path));
    writeFileSync(native, text);
    engine.write(`/${path}`, text);
    return { path: `/${path}`, native, text };
  }));
}

test("every scene has the same states natively and under Node.js", async () => {
  const differing = [];
  const engine = await engineInNode("/scenes/bunny.toml");
  const scenes = everyScene(engine);
  for (const { path, native } of scenes) {
    const [expected, hashes] = [nativeHashes(native, kSteps), hashesOf(engine, path)];
    console.log(`${path}: ${expected.at(-1)} ${hashes.at(-1)}`);
    assert.equal(expected.length, kSteps);
    if (expected.join() !== hashes.join()) differing.push(path);
  }
  assert.deepEqual(differing, []);
  console.log(`${scenes.length} scenes`);
});

test("every scene has the same states with threads", async () => {
  const [single, threaded] = [await engineInNode("/scenes/bunny.toml"), await engineInNode("/scenes/bunny.toml", 3)];
  everyScene(threaded);
  for (const { path } of everyScene(single)) {
    const expected = hashesOf(single, path);
    assert.equal(expected.length, kSteps);
    assert.deepEqual(hashesOf(threaded, path), expected, path);
  }
  assert.equal(threaded.engine.PThread.runningWorkers.length, 3);
  threaded.engine.PThread.terminateAllThreads();
});

async function loadAny(opened, { path, text }) {
  const name = basename(path, ".toml");
  if (text === undefined) return loadScene(opened, name);
  await drop(opened.page, [[`${name}.toml`, Buffer.from(text)]]);
  await opened.until(`the scene ${name}`, ({ scenes, pictures, geometries }) => scenes.a.name === name && pictures.a.generation === geometries.a.generation);
}

const kSample = [["cantilever", 20], ["twist", 20], ["contact", 20], ["muscle", 3], ["ogden", 3], ["quadratic", 3]]; // names and steps

for (const place of ["a file", "an isolated server"]) test(`Chromium from ${place} and the native build compute the same states`, async () => {
  const prepare = (page) => page.addInitScript(() => Object.defineProperty(navigator, "hardwareConcurrency", { get: () => 3 })); // two threads
  const opened = await openSite(places[place], "bunny", { prepare });
  const hasThreads = requested.includes(new URL(places[place]).host + "/" + threads.name);
  assert.equal(hasThreads, place === "an isolated server");
  const scenes = everyScene(await engineInNode("/scenes/bunny.toml"));
  const nameOf = ({ path }) => basename(path, ".toml");
  const chosen = testsAll ? scenes.map((scene) => [scene, kSteps]) : kSample.map(([name, steps]) => [scenes.find((scene) => nameOf(scene) === name), steps]);
  const differing = [];
  for (const [scene, steps] of chosen) {
    await loadAny(opened, scene);
    opened.heard.messages.length = 0;
    await takeSteps(opened, steps);
    const [expected, hashes] = [nativeHashes(scene.native, steps), hashesIn(opened.heard.messages)];
    console.log(`${scene.path}: ${expected.at(-1)} ${hashes.at(-1)}`);
    if (expected.length !== steps || expected.join() !== hashes.join()) differing.push(scene.path);
  }
  assert.deepEqual(differing, []);
  console.log(`${chosen.length} scenes`);
  await opened.close();
});

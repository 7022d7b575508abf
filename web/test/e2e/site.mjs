// The page of ./run site in Chromium, from a file and from web servers, and its engine under Node.js, which computes what
// the native build of portable bits (ASPIC) computes. tools/site_test runs it.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { basename, dirname, join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { gzipSync } from "node:zlib";
import { aspic, atTheEnd, downloaded, drop, findBody, frames, isDrawn, keepPicture, openPage, pageModule, pressAndWait, root, settled, temporaryFolder } from "./harness.mjs";

const site = process.env.SITE;
const html = readFileSync(site, "utf8");
const [kMostEngine, kMostPage] = [1e6, 1.8e6]; // bytes, compressed: the engine as in the page, the page by gzip

const kFrame = `<!doctype html><link rel="icon" href="data:,"><iframe sandbox="allow-scripts" src="/" style="width: 1000px; height: 600px"></iframe>`;
const kIsolated = { "Cross-Origin-Opener-Policy": "same-origin", "Cross-Origin-Embedder-Policy": "require-corp" };

const element = (id) => JSON.parse(html.match(new RegExp(`id="${id}">(.*?)</script>`, "s"))[1]);
const { unpackXz } = await pageModule("xz.ts");

const threads = { name: element("engine-threads"), text: "" };
threads.text = readFileSync(join(dirname(site), threads.name), "utf8");

// Serves the page at /, a sandboxed frame with it at /frame, and the engine with threads.
const requested = [];
async function serve(headers = {}) {
  const texts = { "/": html, "/frame": kFrame, [`/${threads.name}`]: threads.text };
  const server = createServer((request, response) => {
    requested.push(request.headers.host + request.url);
    const text = texts[request.url];
    response.writeHead(text ? 200 : 404, { "Content-Type": "text/html", ...headers });
    response.end(text);
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  atTheEnd(() => server.close());
  return `http://127.0.0.1:${server.address().port}/`;
}

const places = { "a file": pathToFileURL(site).href, "a web server": await serve(), "an isolated server": await serve(kIsolated) };

async function openSite(address, scene = "bunny", options = {}) {
  const opened = await openPage(address, { engine: true, keepsPixels: true, ...options });
  await opened.until(`the scene ${scene}`, ({ state, pictures, scenes }) => state && pictures.a && scenes.a.name === scene);
  return opened;
}

const lastHash = ({ messages }) => messages.findLast(({ kind, steps }) => kind === "steps" && steps.length > 0).steps.at(-1).state_hash;

async function loadScene({ page, until }, name) {
  await page.keyboard.press("Shift+O");
  await page.getByRole("dialog").getByRole("button", { name: new RegExp(`^${name}`) }).click();
  await until(`the scene ${name}`, ({ scenes, pictures, geometries }) => scenes.a.name === name && pictures.a.generation === geometries.a.generation);
  await page.getByRole("dialog").waitFor({ state: "detached" }); // takes keys
}

async function takeSteps(opened, count) {
  for (let step = 1; step <= count; ++step)
    await pressAndWait(opened, "s", `step ${step}`, ({ state, pictures }) => state.a.step === step && pictures.a.step === step);
}

// The engine of the page under Node.js, before it has a task; with `workers` that with threads.
async function freshEngine(workers = 0) {
  const messages = [];
  const post = (message) => typeof message === "string" && messages.push(JSON.parse(message));
  const { module } = workers ? JSON.parse(threads.text) : element("engine-program");
  const engine = await createRequire(import.meta.url)(workers ? process.env.THREADS : process.env.ENGINE)({
    wasmBinary: await unpackXz(module), post, isStopRequested: () => false, workers });
  const files = JSON.parse(new TextDecoder().decode(await unpackXz(element("engine-files"))));
  for (const [path, text] of Object.entries(files)) {
    engine.FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
    engine.FS.writeFile(path, text);
  }
  return { engine, messages };
}

// Opens a scene.
async function engineInNode(scene, workers = 0) {
  const { engine, messages } = await freshEngine(workers);
  assert.ok(engine.ccall("engine_open", "boolean", ["string"], [scene]), JSON.stringify(messages.at(-1)));
  const bytes = () => engine.HEAPU8.length;
  const write = (path, text) => {
    engine.FS.mkdirTree(dirname(path));
    engine.FS.writeFile(path, text);
  };
  return { engine, messages, bytes, write, handle: (message) => engine.ccall("engine_handle", null, ["string"], [JSON.stringify(message)]) };
}

// Runs the native program with portable bits. Exit code 3: a step did not converge, or a check fails.
function runNative(...args) {
  const { status, stderr } = spawnSync(aspic, args, { cwd: root, encoding: "utf8" });
  assert.ok(status === 0 || status === 3, `${args.join(" ")}: ${stderr}`);
}

function nativeHashes(scene, steps) {
  const out = temporaryFolder();
  runNative("run", scene, "--steps", String(steps), "--out", out, "--force", "--quiet");
  const [header, ...rows] = readFileSync(join(out, "steps.csv"), "utf8").trim().split("\n").map((row) => row.split(","));
  return rows.slice(1).map((row) => row[header.indexOf("state_hash")]); // the first is that of the start
}

for (const [place, address] of Object.entries(places)) {
  test(`from ${place}, the body is dragged and the minimization is shown`, async () => {
    const opened = await openSite(address);
    const { page, heard, until, close } = opened;
    await pressAndWait(opened, "i", "an iteration", ({ state }) => state.a.iteration >= 0 || state.a.step === 1);
    while (heard.state.a.step === 0) await pressAndWait(opened, "i", "an iteration", () => true);
    await page.getByRole("tab", { name: "Landscape" }).click();
    const { slice } = await until("the slice", () => heard.messages.find(({ kind, reply }) => kind === "reply" && reply?.slice)?.reply);
    assert.equal(slice.value.length, slice.columns * slice.rows);
    const canvas = page.getByRole("tabpanel", { name: "Landscape" }).locator("canvas").first();
    await until("its surface", () => isDrawn(canvas));
    await settled(opened);
    const [x, y] = await findBody(opened);
    await page.mouse.down();
    await page.mouse.move(x + 60, y - 40, { steps: 4 });
    await until("a grab", ({ state }) => state.a.grab);
    await pressAndWait(opened, " ", "a run", ({ state }) => state.playing);
    const { step } = heard.state.a;
    await until("ten steps with a force", ({ state }) => state.a.step >= step + 10 && state.a.grab && Math.hypot(...state.a.grab.force) > 0);
    await keepPicture(page, `site_${place.split(" ").at(-1)}`);
    await page.mouse.up();
    await until("a release", ({ state }) => !state.a.grab);
    await pressAndWait(opened, " ", "a pause", ({ state }) => !state.playing);
    await frames(page);
    await close();
  });
}

test("the page works in a sandboxed frame", async () => {
  const opened = await openSite(`${places["a web server"]}frame`);
  const frame = opened.page.frameLocator("iframe");
  await frame.getByRole("button", { name: "1 iteration" }).waitFor();
  await frame.getByRole("button", { name: /^Step/ }).click();
  await opened.until("a step", ({ state, pictures }) => state.a.step === 1 && pictures.a.step === 1);
  await opened.close();
});

// Sends each command, then takes a step. Returns the refusals.
function refusals({ messages, handle }, commands) {
  return commands.flatMap((command) => {
    messages.length = 0;
    handle({ ...command, id: 1 });
    handle({ do: "step" });
    const { kind, why } = messages.find(({ id }) => id === 1);
    return kind === "refused" ? [`${JSON.stringify(command)}: ${why}`] : [];
  });
}

test("the engine runs every scene and every page of the lecture", async () => {
  const engine = await engineInNode("/scenes/bunny.toml");
  const { lessons } = engine.messages.find(({ kind }) => kind === "hello");
  engine.handle({ ask: "gallery", id: 2 });
  const { scenes } = engine.messages.find(({ id }) => id === 2).reply;
  assert.ok(scenes.length >= 20 && lessons.length >= 20, `${scenes.length} scenes, ${lessons.length} lessons`);
  assert.deepEqual(lessons.filter(({ missing }) => missing), []);
  const failed = refusals(engine, [
    ...scenes.map(({ path }) => ({ do: "load", scene: path })),
    ...lessons.map(({ id }) => ({ do: "lesson", lesson: id })),
  ]);
  assert.deepEqual(failed, []);
});

test("the sizes are within their limits", () => {
  const engine = element("engine-program").module.length * 0.75;
  const page = gzipSync(html, { level: 9 }).length;
  console.log(`engine: ${(engine / 1e6).toFixed(2)} MB, page: ${(page / 1e6).toFixed(2)} MB, both compressed`);
  assert.ok(engine <= kMostEngine && page <= kMostPage);
});

test("each page of the lecture has formulas, something to try, and a question with its answer", async () => {
  const { messages } = await engineInNode("/scenes/cantilever.toml");
  const { lessons } = messages.find(({ kind }) => kind === "hello");
  const { formulasOf } = await pageModule("formulas.ts");
  for (const { id, look, question, answer } of lessons) assert.ok(formulasOf(id).length > 0 && look && question && answer, id);
});

// Prints speeds without a limit: they depend on the machine and on its load.
test("a body of 1512 vertices moves", async () => {
  const { messages, write, handle } = await engineInNode("/scenes/bunny.toml");
  const scene = readFileSync(join(root, "scenes/cantilever.toml"), "utf8").replace("[15, 3, 3]", "[41, 5, 5]");
  write("/scenes/beam.toml", scene);
  handle({ do: "load", scene: "/scenes/beam.toml" });
  const start = process.cpuUsage();
  for (let step = 0; step < 100; ++step) handle({ do: "step" });
  console.log(`${(1e8 / process.cpuUsage(start).user).toFixed(0)} steps per second of CPU time under Node.js`);
  assert.equal(messages.findLast(({ kind }) => kind === "state").a.step, 100);
});

test("a thousand resets do not grow the memory", async () => {
  const { messages, bytes, handle } = await engineInNode("/scenes/cantilever.toml");
  const reset = (count) => {
    for (let i = 0; i < count; ++i) {
      handle({ do: "step" });
      handle({ do: "reset" });
      messages.length = 0;
    }
    return bytes();
  };
  const before = reset(100);
  assert.equal(reset(1000), before);
});

const hashesIn = (messages) => messages.flatMap(({ kind, side, steps }) => (kind === "steps" && side === "a" ? steps : [])).map((row) => row.state_hash);

const kSteps = 3;

// The states of a scene after each of kSteps steps.
function hashesOf({ messages, handle }, path) {
  handle({ do: "load", scene: path });
  messages.length = 0;
  for (let step = 0; step < kSteps; ++step) handle({ do: "step" });
  return hashesIn(messages);
}

// All scenes of the repository: their paths in the engine, and natively. Those that the page does not ship need no other
// files; pillow.toml is coarser, because it has more tets than the page allows.
function everyScene({ messages, handle, write }) {
  handle({ ask: "gallery", id: 1 });
  const shipped = messages.find(({ id }) => id === 1).reply.scenes.map(({ path }) => ({ path, native: path.slice(1) }));
  const others = ["scenes/capture", "tests/random_scenes"].flatMap((folder) =>
    readdirSync(join(root, folder)).filter((name) => name.endsWith(".toml")).map((name) => join(folder, name)));
  const copies = temporaryFolder();
  return shipped.concat(others.map((name) => {
    const text = readFileSync(join(root, name), "utf8").replace("height = 0.06, size = 0.004", "height = 0.06, size = 0.006");
    const native = join(copies, basename(name));
    writeFileSync(native, text);
    write(`/${name}`, text);
    return { path: `/${name}`, native };
  }));
}

test("every scene has the same states natively and under Node.js", async () => {
  const differing = [];
  const engine = await engineInNode("/scenes/bunny.toml");
  for (const { path, native } of everyScene(engine)) {
    const [expected, hashes] = [nativeHashes(native, kSteps), hashesOf(engine, path)];
    console.log(`${path}: ${expected.at(-1)} ${hashes.at(-1)}`);
    assert.equal(expected.length, kSteps);
    if (expected.join() !== hashes.join()) differing.push(path);
  }
  assert.deepEqual(differing, []);
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

for (const place of ["a file", "an isolated server"]) test(`Chromium from ${place}, Node.js and the native build compute the same state`, async () => {
  const prepare = (page) => page.addInitScript(() => Object.defineProperty(navigator, "hardwareConcurrency", { get: () => 3 })); // two threads
  const opened = await openSite(places[place], "bunny", { prepare });
  const hasThreads = requested.includes(new URL(places[place]).host + "/" + threads.name);
  assert.equal(hasThreads, place === "an isolated server");
  for (const name of ["cantilever", "twist", "contact"]) {
    const node = await engineInNode(`/scenes/${name}.toml`);
    for (let step = 0; step < 20; ++step) node.handle({ do: "step" });
    await loadScene(opened, name);
    await takeSteps(opened, 20);
    assert.equal(lastHash(opened.heard), lastHash(node), name);
    assert.equal(lastHash(opened.heard), nativeHashes(`scenes/${name}.toml`, 20).at(-1), name);
    console.log(`${name}: state ${lastHash(opened.heard)} after 20 steps`);
  }
  await opened.close();
});

// Wall times differ.
const judged = ({ measures, passes }) => ({ passes, measures: measures.filter(({ unit }) => unit !== "s") });

// Pages that take seconds. ASPIC_LECTURE=all: all pages, many minutes.
const kQuickPages = ["03_tissue", "05-09_equation_of_motion", "53+62_pure_newton", "54-59_overshoot", "60-61_backtracking"];

test("the page judges the lecture by the numbers of the native build", async () => {
  const out = temporaryFolder();
  const { messages } = await engineInNode("/scenes/cantilever.toml");
  const { lessons } = messages.find(({ kind }) => kind === "hello");
  for (const key of process.env.ASPIC_LECTURE === "all" ? lessons.map(({ id }) => id) : kQuickPages) {
    const { engine, messages: posted } = await freshEngine();
    engine.ccall("engine_judge", "boolean", ["string"], [key]);
    const { kind, result, why } = posted.at(-1);
    assert.equal(kind, "judged", `${key}: ${why}`);
    runNative("lecture", String(result.pages[0]), "--out", out);
    const native = JSON.parse(readFileSync(join(out, result.key, "result.json"), "utf8"));
    assert.deepEqual(judged(result), judged(native), key);
    assert.ok(result.passes, key);
    console.log(`${key}: ${result.measures.length} numbers in ${result.seconds.toFixed(1)} s`);
  }
});

test("the address opens a page of the lecture", async () => {
  const opened = await openSite(`${places["a file"]}#lecture/33`, "33_mouse");
  await opened.page.getByRole("heading", { name: /^Pages 33-34/ }).waitFor();
  await opened.until("the recorded mouse", ({ state }) => state.replaying && state.b);
  await opened.close();
});

test("no formula is cut off on a phone", async () => {
  const opened = await openSite(`${places["a file"]}#lecture/33`, "33_mouse", { size: [390, 844] });
  const formulas = opened.page.locator(".lesson .formula");
  await formulas.first().waitFor();
  await frames(opened.page);
  const hidden = await formulas.evaluateAll((all) => all.map(({ scrollWidth, clientWidth }) => scrollWidth - clientWidth));
  assert.deepEqual(hidden, hidden.map(() => 0));
  await keepPicture(opened.page, "site_phone");
  await opened.close();
});

test("a link and a saved page open the workspace", async () => {
  const opened = await openSite(places["a file"]);
  await loadScene(opened, "twist");
  await opened.page.keyboard.press("Shift+C");
  await opened.page.waitForFunction(() => location.hash.startsWith("#s="));
  const link = opened.page.url();
  const saved = await downloaded(opened.page, () => opened.page.keyboard.press("Shift+H"));
  assert.equal(saved.suggestedFilename(), "twist.html");
  const copy = join(temporaryFolder(), "twist.html");
  writeFileSync(copy, readFileSync(await saved.path()));
  await opened.close();
  for (const address of [link, pathToFileURL(copy).href]) await (await openSite(address, "twist")).close();
});

test("an exhausted memory is reported in words", async () => {
  const { engine, messages, handle } = await engineInNode("/scenes/cantilever.toml");
  const taken = [];
  for (const bytes of [256, 16, 1].map((mebibytes) => mebibytes << 20))
    for (let place; (place = engine._malloc(bytes)) !== 0; ) taken.push(place);
  handle({ do: "load", scene: "/scenes/bunny.toml", id: 1 });
  assert.match(messages.find(({ id }) => id === 1).why, /not enough memory/);
  taken.forEach((place) => engine._free(place));
  handle({ do: "step" });
  assert.equal(messages.findLast(({ kind }) => kind === "state").a.step, 1, "the scene before it continues");
});

test("a damaged link is reported", async () => {
  const opened = await openSite(`${places["a file"]}#s=damaged`);
  await opened.page.locator(".notice.error").filter({ hasText: "The link is damaged" }).waitFor();
  await opened.close();
});

const kTooMuch = [
  ["a scene that is too large", "body.0.shape.box.cells=[400, 400, 400]", "tets"],
  ["a formula that is too long", `body.0.material.young="1e5${" + 1".repeat(600)}"`, "characters; at most"],
];

for (const [what, override, why] of kTooMuch)
  test(`a link with ${what} is refused`, async () => {
    const { linkText } = await pageModule("share.ts");
    const link = await linkText({ aspic_workspace: 1, scene: "/scenes/cantilever.toml", overrides: [override], settings: {}, compare: null, page: {} });
    const opened = await openSite(places["a file"] + link);
    await opened.page.locator(".notice.error").filter({ hasText: why }).waitFor();
    await pressAndWait(opened, "s", "a step of the old scene", ({ state }) => state.a.step === 1);
    await opened.close();
  });

// Gradient descent that needs minutes for a step.
const kEndless = ["body.0.shape.box.cells=[41, 5, 5]", "solver.method=gradient_descent", "solver.tolerance=1e-12", "solver.max_iterations=1000000"];

test("a long step is stopped, from a file and from web servers", async () => {
  const { linkText } = await pageModule("share.ts");
  const link = await linkText({ aspic_workspace: 1, scene: "/scenes/cantilever.toml", overrides: kEndless, settings: {}, compare: null, page: {} });
  for (const [place, address] of Object.entries(places)) {
    const opened = await openSite(address + link, "cantilever");
    await opened.page.keyboard.press("s"); // runs until it is stopped
    await frames(opened.page);
    await opened.page.waitForTimeout(1000);
    const start = performance.now();
    await pressAndWait(opened, "r", "a reset", () => true);
    assert.deepEqual(hashesIn(opened.heard.messages), [], "the step did not end by itself");
    console.log(`${place}: stopped after ${(performance.now() - start).toFixed(0)} ms`);
    await opened.close();
  }
});

// A closed surface without tets.
const kOctahedron = `v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1
f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n`;

test("a dropped surface moves with a cage", async () => {
  const opened = await openSite(places["a file"]);
  await drop(opened.page, [["octahedron.obj", Buffer.from(kOctahedron)]]);
  await opened.until("the body", ({ scenes, pictures, geometries }) => scenes.a.name === "octahedron" && pictures.a.generation === geometries.a.generation);
  assert.ok(opened.heard.scenes.a.notes.some((note) => note.includes("cubes around the surface")), opened.heard.scenes.a.notes.join("; "));
  await takeSteps(opened, 3);
  await opened.close();
});

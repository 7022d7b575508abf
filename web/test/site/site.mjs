// What the tests of the page of ./run site share: its servers, pages in Chromium, its engine under Node.js, and the native
// build with the same bits (ASPIC). run.mjs starts them.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { pathToFileURL } from "node:url";
import { aspic, atTheEnd, openPage, pageModule, pressAndWait, root, sceneButton, temporaryFolder } from "../e2e/harness.mjs";

export const testsAll = process.env.ASPIC_ALL === "1"; // instead of samples

export const site = process.env.SITE;
export const html = readFileSync(site, "utf8");

const kFrame = `<!doctype html><link rel="icon" href="data:,"><iframe sandbox="allow-scripts" src="/" style="width: 1000px; height: 600px"></iframe>`;
const kIsolated = { "Cross-Origin-Opener-Policy": "same-origin", "Cross-Origin-Embedder-Policy": "require-corp" };

export const element = (id) => JSON.parse(html.match(new RegExp(`id="${id}">(.*?)</script>`, "s"))[1]);
const { unpackXz } = await pageModule("xz.ts");

export const threads = { name: element("engine-threads"), text: "" };
threads.text = readFileSync(join(dirname(site), threads.name), "utf8");

// Serves the page at /, a sandboxed frame with it at /frame, and the engine with threads.
export const requested = [];
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

export const places = { "a file": pathToFileURL(site).href, "a web server": await serve(), "an isolated server": await serve(kIsolated) };

export async function openSite(address, scene = "bunny", options = {}) {
  const opened = await openPage(address, { engine: true, keepsPixels: true, ...options });
  await opened.until(`the scene ${scene}`, ({ state, pictures, scenes }) => state && pictures.a && scenes.a.name === scene);
  return opened;
}

export const hashesIn = (messages) => messages.flatMap(({ kind, side, steps }) => (kind === "steps" && side === "a" ? steps : [])).map((row) => row.state_hash);

export async function loadScene({ page, until }, name) {
  await page.keyboard.press("Shift+O");
  await sceneButton(page, name).click();
  await until(`the scene ${name}`, ({ scenes, pictures, geometries }) => scenes.a.name === name && pictures.a.generation === geometries.a.generation);
  await page.getByRole("dialog").waitFor({ state: "detached" }); // takes keys
}

export async function takeSteps(opened, count) {
  for (let step = 1; step <= count; ++step)
    await pressAndWait(opened, "s", `step ${step}`, ({ state, pictures }) => state.a.step === step && pictures.a.step === step);
}

// The engine of the page under Node.js, before it has a task; with `workers` that with threads.
export async function freshEngine(workers = 0) {
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
export async function engineInNode(scene, workers = 0) {
  const { engine, messages } = await freshEngine(workers);
  assert.ok(engine.ccall("engine_open", "boolean", ["string"], [scene]), JSON.stringify(messages.at(-1)));
  const bytes = () => engine.HEAPU8.length;
  const write = (path, text) => {
    engine.FS.mkdirTree(dirname(path));
    engine.FS.writeFile(path, text);
  };
  return { engine, messages, bytes, write, handle: (message) => engine.ccall("engine_handle", null, ["string"], [JSON.stringify(message)]) };
}

// Runs the native program. Exit code 3: a step did not converge, or a check fails.
export function runNative(args, program = aspic) {
  const { status, stderr } = spawnSync(program, args, { cwd: root, encoding: "utf8" });
  assert.ok(status === 0 || status === 3, `${args.join(" ")}: ${stderr}`);
}

// Quoted cells may contain commas.
const cells = (row) => [...row.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^,]*))/g)].map(([, quoted, plain]) => quoted ?? plain);

// Rows of a table of `aspic run`, by their columns; the first is that of the start.
export function nativeRows(scene, steps, table, program = aspic) {
  const out = temporaryFolder();
  runNative(["run", scene, "--steps", String(steps), "--threads", "1", "--out", out, "--force", "--quiet"], program);
  const [header, ...rows] = readFileSync(join(out, table), "utf8").trim().split("\n").map(cells);
  return rows.map((row) => Object.fromEntries(row.map((value, i) => [header[i], value])));
}

export const nativeHashes = (scene, steps) => nativeRows(scene, steps, "steps.csv").slice(1).map((row) => row.state_hash);

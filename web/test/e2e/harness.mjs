// Programs, browsers and pages for the tests. Tests wait for events, not for times.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { after, afterEach } from "node:test";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { launchChromium } from "./chromium.mjs";

export const aspic = process.env.ASPIC;
export const root = join(dirname(fileURLToPath(import.meta.url)), "../../..");
export const kPatience = 180_000; // [ms]; two weak cores that render without a graphics card are slow, not broken

// Imports a module of the page.
export async function pageModule(name) {
  const entry = join(root, "web/src", name);
  const { outputFiles } = await build({ entryPoints: [entry], bundle: true, format: "esm", loader: { ".css": "empty" }, write: false });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}
const { decode } = await pageModule("protocol.ts");
const kSize = [1024, 640]; // [px]

// Runs at the end of the test file, latest first.
const endings = [];
after(async () => {
  for (const end of endings.reverse()) await end();
});
export const atTheEnd = (end) => endings.push(end);

export function temporaryFolder() {
  const folder = mkdtempSync(join(tmpdir(), "aspic-page-"));
  atTheEnd(() => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

export async function until(what, condition, reported = () => "") {
  const end = Date.now() + kPatience;
  for (;;) {
    const found = await condition();
    if (found) return found;
    if (Date.now() > end) throw new Error(`never: ${what}; ${reported()}`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

let stateFolder = "";
const stateHome = () => (stateFolder ||= temporaryFolder());

// Starts `aspic view`; returns its address and output.
export async function startProgram(scene, more = []) {
  const env = { ...process.env, XDG_STATE_HOME: stateHome() }; // isolated from this user's list of recent scenes
  const child = spawn(aspic, ["view", resolve(root, scene), "--no-browser", ...more], { env });
  const program = { child, address: "", said: "", complained: "", ended: null };
  child.stdout.on("data", (chunk) => (program.said += chunk));
  child.stderr.on("data", (chunk) => (program.complained += chunk));
  child.on("exit", (code, signal) => (program.ended = signal ?? code));
  program.end = async () => {
    if (program.ended === null) child.kill("SIGINT");
    await until("the program's end", () => program.ended !== null).catch(() => child.kill("SIGKILL"));
    return program.ended;
  };
  atTheEnd(program.end);
  const heard = () => `${program.said}${program.complained}${program.ended ?? ""}`;
  await until("an address", () => program.ended !== null || /http:\S+\s/.test(program.said), heard);
  assert.equal(program.ended, null, heard());
  program.address = program.said.match(/http:\S+/)[0];
  return program;
}

const contexts = new Set(); // contexts of the test under way
afterEach(async () => {
  for (const context of contexts) await context.close();
  contexts.clear();
});

let browser = null;
export async function theBrowser() {
  if (browser) return browser;
  browser = await launchChromium(["--disable-gpu-compositing"]); // saves a third of the work without a graphics card
  atTheEnd(() => browser.close());
  return browser;
}

// Messages from the program to the page, as far as the tests use them.
function listener() {
  const heard = { messages: [], sent: [], state: null, states: 0, scenes: {}, geometries: {}, pictures: {}, counted: 0, bytes: 0 };
  const forget = { end_compare: () => ["scenes", "geometries", "pictures"].forEach((kind) => delete heard[kind].b) };
  heard.take = (payload) => {
    if (typeof payload === "string") {
      const message = JSON.parse(payload);
      heard.messages.push(message);
      if (message.kind === "state") [heard.state, heard.states] = [message, heard.states + 1];
      if (message.kind === "scene") heard.scenes[message.side] = message;
      forget[message.kind]?.();
      return;
    }
    const bytes = payload.buffer.slice(payload.byteOffset, payload.byteOffset + payload.byteLength);
    const { geometry, picture } = decode(bytes);
    if (geometry) heard.geometries[geometry.side] = geometry;
    if (!picture) return;
    heard.pictures[picture.side] = picture;
    heard.counted += 1;
    heard.bytes = bytes.byteLength;
  };
  return heard;
}

// Statistics of an image: the standard deviation of its brightness (0: a single color), and a checksum that differs
// where images do.
function lookAtImages() {
  window.lookAt = (image) => {
    if (!(image.width > 0 && image.height > 0)) return { contrast: 0, print: 0 };
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    let [sum, squares, print] = [0, 0, 2166136261];
    for (let i = 0; i < data.length; i += 4) {
      const y = 0.3 * data[i] + 0.6 * data[i + 1] + 0.1 * data[i + 2];
      sum += y;
      squares += y * y;
      print = Math.imul(print ^ (data[i] | (data[i + 1] << 8) | (data[i + 2] << 16)), 16777619);
    }
    const n = data.length / 4;
    return { contrast: Math.sqrt(Math.max(0, squares / n - (sum / n) ** 2)), print };
  };
}

// Without antialiasing, which saves a third of the work; optionally with canvases that stay readable.
function drawSimply(preserveDrawingBuffer) {
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (kind, attributes) {
    const simple = { ...attributes, antialias: false, preserveDrawingBuffer };
    return getContext.call(this, kind, /webgl/.test(kind) ? simple : attributes);
  };
}

// Records the texts that canvases draw, since no element holds them.
function noteDrawnTexts() {
  window.drawnTexts = [];
  const { fillText } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) {
    window.drawnTexts.push(text);
    if (window.drawnTexts.length > 5000) window.drawnTexts.splice(0, 2500);
    return fillText.call(this, text, ...rest);
  };
}

// The latest messages, for a failed test.
function story({ state, sent, messages, pictures }) {
  const reported = messages.slice(-8).map(({ kind, why, a }) => [kind, why ?? a?.step].join(" "));
  return `${JSON.stringify(state)}; sent: ${sent.slice(-5).join(" ").slice(-800)}; reported: ${reported.join(", ")}; picture of step ${pictures.a?.step}`;
}

// The same for the engine in a worker of the page, at the page's end of the port between them: web/src/host.ts.
async function listenToWorker(page, heard) {
  await page.exposeFunction("sentToWorker", (text) => heard.sent.push(text));
  await page.exposeFunction("heardFromWorker", (text, isBinary) => heard.take(isBinary ? Buffer.from(text, "base64") : text));
  await page.addInitScript(() => {
    const base64 = (bytes) => btoa(Array.from(new Uint8Array(bytes), (byte) => String.fromCharCode(byte)).join(""));
    const hear = ({ data }) => {
      if (typeof data === "string") void window.heardFromWorker(data, false);
      else if (data instanceof ArrayBuffer) void window.heardFromWorker(base64(data), true);
    };
    const { prototype } = MessagePort;
    const { set } = Object.getOwnPropertyDescriptor(prototype, "onmessage");
    const take = function (handler) {
      this.addEventListener("message", hear);
      set.call(this, handler);
    };
    Object.defineProperty(prototype, "onmessage", { set: take });
    const { postMessage } = prototype;
    prototype.postMessage = function (data, ...more) {
      if (typeof data?.message === "string" && data.message !== "ready") void window.sentToWorker(data.message);
      postMessage.call(this, data, ...more);
    };
  });
}

// Opens a new page. `close` fails on errors of its scripts, violations of its content policy and foreign requests,
// except `expected` errors.
export async function openPage(address, { size = kSize, watchRequests = true, keepsPixels = false, engine = false, expected = /^$/, prepare, ...context } = {}) {
  const inside = await (await theBrowser()).newContext({ viewport: { width: size[0], height: size[1] }, ...context });
  contexts.add(inside);
  const page = await inside.newPage();
  page.setDefaultTimeout(kPatience);
  const errors = [];
  const heard = listener();
  const choosers = [];
  page.on("filechooser", (chooser) => choosers.push(chooser));
  page.on("pageerror", (error) => errors.push(error.stack ?? error.message));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  const origin = new URL(address).origin;
  page.on("request", (request) => {
    const own = request.url() === address.replace(/#.*/, "") || request.url().startsWith(`${origin}/`) || /^(data|blob):/.test(request.url());
    if (watchRequests && !own) errors.push(`requested ${request.url()}`);
  });
  page.on("websocket", (socket) => {
    socket.on("framereceived", ({ payload }) => heard.take(payload));
    socket.on("framesent", ({ payload }) => typeof payload === "string" && payload !== "ready" && heard.sent.push(payload));
  });
  if (engine) await listenToWorker(page, heard);
  for (const script of [lookAtImages, noteDrawnTexts]) await page.addInitScript(script);
  await page.addInitScript(drawSimply, keepsPixels);
  await prepare?.(page);
  await page.goto(address);
  const opened = {
    page,
    heard,
    errors,
    choosers, // file choosers that the page opened
    until: (what, condition) => until(what, () => condition(heard), () => story(heard)),
    close: async () => {
      assert.deepEqual(errors.filter((error) => !expected.test(error)), []);
      contexts.delete(inside);
      await inside.close();
    },
  };
  return opened;
}

// Settings and plots, which are closed at first.
async function openPanels(page) {
  const settings = page.locator('#toolbar [aria-keyshortcuts="G"]');
  if ((await settings.getAttribute("aria-expanded")) === "false") await settings.click();
  if (await page.locator("#dock.closed").count()) await page.keyboard.press("d");
}

// Opens a page that steers, at the start; or one that only `watches`. `closed`: with the panels as they are at first.
export async function openSession(program, { watches = false, closed = false, ...options } = {}) {
  const opened = await openPage(program.address, options);
  await opened.until("a picture", ({ state, pictures }) => state && pictures.a);
  await opened.page.locator("#views canvas").first().waitFor();
  if (!closed && (options.size ?? kSize)[0] > 768) await openPanels(opened.page);
  if (watches) return opened;
  await steering(opened);
  await tidy(opened);
  return opened;
}

// The program may not have noticed yet that the previous page has closed.
export const steering = ({ until }) =>
  until("the steering", ({ messages }) => messages.findLast(({ kind }) => kind === "hello" || kind === "role")?.steers);

// Removes what an earlier test left: a comparison, a running simulation, steps.
async function tidy(opened) {
  await setPlaying(opened, false);
  if (opened.heard.state.b) await pressAndWait(opened, "c", "one side", ({ state, scenes }) => !state.b && !scenes.b);
  await toTheStart(opened);
}

export const toTheStart = (opened) =>
  pressAndWait(opened, "r", "the start", ({ state, pictures, geometries }) => isAtStart(state) && pictures.a.step === 0 && pictures.a.generation === geometries.a.generation);
const isAtStart = ({ playing, replaying, a }) => !playing && !replaying && a.step === 0 && a.iteration < 0;

export const settingOf = (heard, key, side = "a") => heard.scenes[side].settings.find((setting) => setting.key === key);

// Acts, then waits for the answer to the first message that satisfies `isIt`.
export async function answered({ heard, until }, what, isIt, act) {
  const [asked, reported] = [heard.sent.length, heard.messages.length];
  await act();
  const sent = () => heard.sent.slice(asked).map((text) => JSON.parse(text)).find(isIt);
  const { id } = await until(`${what} is sent`, sent);
  return until(`an answer about ${what}`, () => heard.messages.slice(reported).find((message) => message.id === id));
}

// Resolves when the program has answered all requests of the page and the page has drawn the result.
export async function settled({ page, heard, until }) {
  const answers = () => new Set(heard.messages.filter(({ kind }) => kind === "reply" || kind === "refused").map(({ id }) => id));
  for (let asked = -1; asked !== heard.sent.length; await frames(page)) {
    asked = heard.sent.length;
    await frames(page); // panels send requests once per frame
    const ids = heard.sent.map((text) => JSON.parse(text).id).filter((id) => id !== undefined);
    await until("all answers", () => ids.every((id) => answers().has(id)));
  }
}

// Presses a key and waits for a state of the program with the expected property.
export async function pressAndWait({ page, heard, until }, key, what, condition) {
  const reported = heard.states;
  await page.keyboard.press(key);
  await until(what, () => heard.states > reported && condition(heard));
}

// A scene in the dialog that loads one, by its whole name.
export const sceneButton = (page, name) => page.getByRole("dialog").locator("button.scene").filter({ has: page.getByText(name, { exact: true }) });

// Presses the play key until the expected state is reached: a run may end by itself before the key is pressed.
export const setPlaying = (opened, wanted) =>
  opened.until(wanted ? "play" : "a pause", async () => {
    const { page, heard } = opened;
    const reported = heard.messages.length;
    if (heard.state.playing === wanted) return true;
    await answered(opened, "play or pause", ({ do: what }) => ["play", "pause"].includes(what), () => page.keyboard.press(" "));
    return heard.messages.slice(reported).some(({ kind, playing }) => kind === "state" && playing === wanted);
  });

// Waits for the work of one frame and of the next one that it may request.
export const frames = (page, count = 2) =>
  page.evaluate(async (n) => {
    for (let i = 0; i < n; ++i) await new Promise((done) => requestAnimationFrame(done));
  }, count);

// Position of an element once it is stable: during a redraw it has none.
export async function boxOf(locator) {
  let last = null;
  return until(`a place of ${locator}`, async () => {
    const before = last;
    last = await locator.boundingBox();
    if (last && before && ["x", "y", "width", "height"].every((name) => last[name] === before[name])) return last;
    await frames(locator.page());
  });
}

// Middle of the part of the body that the mouse can hold.
export async function findBody({ page }, view = 0) {
  const host = page.locator("#views .view").nth(view);
  return until("a body under the mouse", async () => {
    const box = await boxOf(host);
    for (const [u, v] of [[0.5, 0.5], [0.5, 0.6], [0.5, 0.4], [0.6, 0.5], [0.4, 0.5], [0.5, 0.7], [0.5, 0.3], [0.7, 0.6]]) {
      const [x, y] = [box.x + u * box.width, box.y + v * box.height];
      await page.mouse.move(x, y);
      await frames(page); // the first frame determines what is under the mouse
      if (await host.evaluate((element) => ["grab", "crosshair", "help"].includes(element.style.cursor))) return [x, y];
    }
  });
}

// Image of a canvas, read by the page itself, because a screenshot would wait for a still screen. WebGL canvases
// require a page that `keepsPixels`.
export const shownBy = (canvas) => canvas.evaluate((element) => (element.checkVisibility() ? window.lookAt(element) : { contrast: 0, print: 0 }));

// Whether the canvas has more than one color.
export const isDrawn = async (canvas) => (await shownBy(canvas)).contrast > 3;

// Screenshot of an element of a page that is still.
export const screenOf = (locator) => locator.screenshot({ animations: "disabled", caret: "initial" });

// For developers; no test depends on it.
export async function keepPicture(page, name) {
  if (process.env.ASPIC_PICTURES) await page.screenshot({ path: join(process.env.ASPIC_PICTURES, `${name}.png`) });
}

// Standard deviation of a PNG's brightness; 0 for a single color.
export const contrast = (page, png) =>
  page.evaluate(async (base64) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))]));
    return window.lookAt(image).contrast;
  }, png.toString("base64"));

// Files that a reader drags from a folder.
export async function drop(page, files) {
  const transfer = await page.evaluateHandle((list) => {
    const made = new DataTransfer();
    for (const [name, base64] of list) made.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
    return made;
  }, files.map(([name, bytes]) => [name, Buffer.from(bytes).toString("base64")]));
  await page.dispatchEvent("body", "drop", { dataTransfer: transfer });
}

export const downloaded = async (page, act) => (await Promise.all([page.waitForEvent("download"), act()]))[0];

// Shortens positions and pictures in the output of a failed comparison.
export const sameBits = (a, b) => Buffer.compare(Buffer.from(a.buffer, a.byteOffset, a.byteLength), Buffer.from(b.buffer, b.byteOffset, b.byteLength)) === 0;
export const assertSameBits = (a, b, what = "the same bits") => assert.ok(sameBits(a, b), what);

// node test/viewer.mjs ASPIC: the page with its program, in Chromium, as a reader uses it.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { after, afterEach, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const aspic = process.argv[2] ?? process.env.ASPIC;
const scene = join(dirname(fileURLToPath(import.meta.url)), "../../scenes/cantilever.toml");
const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
if (!executablePath) {
  console.log("no Chromium: skipped");
  process.exit(77);
}
const kPatience = 60_000; // [ms]

let program, browser, address;
const contexts = []; // of the test under way

before(async () => {
  program = spawn(aspic, ["view", scene, "--no-browser"], { stdio: ["ignore", "pipe", "inherit"] });
  address = await new Promise((resolve, reject) => {
    let said = "";
    program.stdout.on("data", (chunk) => {
      said += chunk;
      const found = said.match(/http:\S+/);
      if (found) resolve(found[0]);
    });
    program.on("exit", (code) => reject(new Error(`aspic view ended with ${code}: ${said}`)));
  });
  browser = await chromium.launch({
    executablePath,
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
});

after(async () => {
  await browser?.close();
  program?.kill("SIGINT");
});

afterEach(async () => {
  for (const context of contexts.splice(0)) await context.close();
});

// A page of its own, with what it was told and every error of its scripts.
async function open() {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
  contexts.push(context);
  const page = await context.newPage();
  const seen = { messages: [], errors: [], sockets: [], state: null, scenes: {} };
  page.on("pageerror", (error) => seen.errors.push(error.message));
  page.on("console", (message) => message.type() === "error" && seen.errors.push(message.text()));
  await page.routeWebSocket(/\/session/, (socket) => {
    const server = socket.connectToServer();
    seen.sockets.push({ socket, server });
    server.onMessage((data) => {
      if (typeof data === "string") note(seen, JSON.parse(data));
      socket.send(data);
    });
  });
  await page.goto(address);
  const until = async (what, condition) => {
    const end = Date.now() + kPatience;
    while (!condition(seen)) {
      if (Date.now() > end) throw new Error(`never: ${what}; ${JSON.stringify(seen.state)}`);
      await page.waitForTimeout(20);
    }
  };
  await page.waitForFunction(() => document.title.includes("·"));
  // A lost connection is an error of the browser, not of the page.
  const checkErrors = () => assert.deepEqual(seen.errors.filter((text) => !text.includes("WebSocket")), []);
  return { page, seen, until, checkErrors };
}

function note(seen, message) {
  seen.messages.push(message);
  if (message.kind === "state") seen.state = message;
  if (message.kind === "scene") seen.scenes[message.side] = message;
  if (message.kind === "end_compare") delete seen.scenes.b;
}

const valueOf = (seen, key, side = "a") => seen.scenes[side].settings.find((setting) => setting.key === key).value;

test("Space plays and pauses, R goes back, S takes one step", async () => {
  const { page, seen, until, checkErrors } = await open();
  assert.ok(!page.url().includes("token"));
  await page.keyboard.press(" ");
  await until("five steps", () => seen.state.a.step >= 5);
  await page.keyboard.press(" ");
  await until("a pause", () => !seen.state.playing);
  await page.keyboard.press("r");
  await until("the start", () => seen.state.a.step === 0);
  await page.keyboard.press("s");
  await until("one step", () => seen.state.a.step === 1);
  assert.match(await page.title(), /^cantilever · paused, step 1/);
  checkErrors();
});

test("the timeline rewinds by arrow keys", async () => {
  const { page, seen, until, checkErrors } = await open();
  for (let i = 0; i < 3; ++i) await page.keyboard.press("s");
  await until("three more steps", () => seen.state.a.step >= 3);
  const step = seen.state.a.step;
  await page.getByLabel("Timeline: rewinds to a step").press("ArrowLeft");
  await until("the step before", () => seen.state.a.step === step - 1);
  checkErrors();
});

test("the body follows the mouse, and the force is told", async () => {
  const { page, seen, until, checkErrors } = await open();
  const box = await page.locator("#views").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.waitForTimeout(500); // pictures are drawn
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 40, y - 60, { steps: 5 });
  await until("a grab", () => seen.state.a.grab);
  await page.keyboard.press("s");
  await until("a force", () => seen.state.a.grab && Math.hypot(...seen.state.a.grab.force) > 0);
  await page.mouse.up();
  await until("a release", () => seen.state.a.grab === null);
  checkErrors();
});

test("a typed value is taken, an impossible one told and put back", async () => {
  const { page, seen, until, checkErrors } = await open();
  const young = page.getByLabel("E [Pa]", { exact: true });
  await young.fill("2e6");
  await young.press("Enter");
  await until("E", () => valueOf(seen, "material.young") === 2e6);
  await young.fill("-1");
  await young.press("Enter");
  await page.locator(".notice.error").waitFor();
  await page.waitForFunction(() => document.querySelector('[aria-label="E [Pa]"]').value === "2e6");
  checkErrors();
});

test("every choice of every setting is taken or refused in words", async () => {
  const { page, seen, until, checkErrors } = await open();
  for (const { key, label, choices, value: first } of seen.scenes.a.settings.filter(({ kind }) => kind === "choice")) {
    for (const value of [...choices, first]) {
      const before = seen.messages.length;
      await page.locator("#right").getByLabel(label, { exact: true }).first().selectOption(value);
      const answered = ({ kind }) => kind === "refused" || kind === "reply";
      await until(`${key} = ${value}`, () => seen.messages.slice(before).some(answered) || valueOf(seen, key) === value);
    }
  }
  checkErrors();
});

test("iterations are taken one by one, and listed in the microscope", async () => {
  const { page, seen, until, checkErrors } = await open();
  await page.keyboard.press("m");
  await page.keyboard.press("i");
  await until("an iteration", () => seen.state.a.iteration >= 0);
  const step = seen.state.a.step;
  for (let i = 0; i < 100 && seen.state.a.iteration >= 0; ++i) {
    const before = JSON.stringify(seen.state.a);
    await page.keyboard.press("i");
    await until("the next one", () => JSON.stringify(seen.state.a) !== before);
  }
  assert.equal(seen.state.a.step, step + 1);
  await page.locator('#dock [role=gridcell]').first().waitFor();
  checkErrors();
});

test("two simulations are compared, and their settings are set apart", async () => {
  const { page, seen, until, checkErrors } = await open();
  await page.keyboard.press("c");
  await page.getByRole("button", { name: "Half the time step" }).click();
  await page.getByRole("button", { name: "Compare", exact: true }).click();
  await until("side b", () => seen.scenes.b && seen.state.b);
  assert.equal(valueOf(seen, "time.step", "b"), valueOf(seen, "time.step") / 2);
  await page.getByText("B: h / 2").waitFor();
  await page.locator(".sides").getByLabel("B", { exact: true }).check();
  const poisson = page.getByLabel("nu", { exact: true });
  await poisson.fill("0.3");
  await poisson.press("Enter");
  await until("nu of side b", () => valueOf(seen, "material.poisson", "b") === 0.3);
  assert.equal(valueOf(seen, "material.poisson"), 0.4);
  await page.keyboard.press("c");
  await until("the end of the comparison", () => !seen.scenes.b);
  assert.equal(await page.locator(".side").count(), 1);
  checkErrors();
});

test("a workspace brings back settings and panels", async () => {
  const { page, seen, until, checkErrors } = await open();
  const nu = page.getByLabel("nu", { exact: true });
  await nu.fill("0.2");
  await nu.press("Enter");
  await until("nu", () => valueOf(seen, "material.poisson") === 0.2);
  await page.keyboard.press("m");
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Shift+S")]);
  const file = await download.path();
  assert.equal(JSON.parse(readFileSync(file, "utf8")).aspic_workspace, 1);
  await nu.fill("0.35");
  await nu.press("Enter");
  await until("another nu", () => valueOf(seen, "material.poisson") === 0.35);
  await page.keyboard.press("e");
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.keyboard.press("Shift+L")]);
  await chooser.setFiles({ name: "workspace.json", mimeType: "application/json", buffer: readFileSync(file) });
  await until("nu as it was", () => valueOf(seen, "material.poisson") === 0.2);
  await page.locator('[role=tab][aria-selected="true"]', { hasText: "Microscope" }).waitFor();
  checkErrors();
});

test("a recorded session is repeated", async () => {
  const { page, seen, until, checkErrors } = await open();
  await page.keyboard.press("r");
  await until("the start", () => seen.state.a.step === 0);
  for (let i = 0; i < 3; ++i) await page.keyboard.press("s");
  await until("three steps", () => seen.state.a.step === 3);
  const energy = seen.messages.filter(({ kind }) => kind === "steps").at(-1).steps.at(-1).kinetic;
  await page.keyboard.press("Shift+P");
  await until("the repetition", () => seen.state.replaying);
  await until("its end", () => !seen.state.replaying && seen.state.a.step === 3);
  assert.equal(seen.messages.filter(({ kind }) => kind === "steps").at(-1).steps.at(-1).kinetic, energy);
  checkErrors();
});

test("a dropped connection is made anew, and the page goes on", async () => {
  const { page, seen, until, checkErrors } = await open();
  const { socket, server } = seen.sockets[0];
  await server.close();
  await socket.close();
  await page.getByText("Connection lost").waitFor();
  await until("another connection", () => seen.sockets.length > 1);
  await page.locator(".lasting").waitFor({ state: "hidden" });
  const step = seen.state.a.step;
  await page.keyboard.press("s");
  await until("a step", () => seen.state.a.step === step + 1);
  checkErrors();
});

test("a second page watches until it takes the steering", async () => {
  const one = await open();
  const two = await open();
  await two.page.getByText("Watching", { exact: true }).waitFor();
  assert.ok(await two.page.getByRole("button", { name: "Play", exact: true }).isDisabled());
  await two.page.getByRole("button", { name: "Steer", exact: true }).click();
  await one.page.getByText("Watching", { exact: true }).waitFor();
  const step = two.seen.state.a.step;
  await two.page.keyboard.press("s");
  await one.until("a step in the watching page", () => one.seen.state.a.step === step + 1);
  two.checkErrors();
  one.checkErrors();
});

test("without the token there is no page", async () => {
  const page = await browser.newPage();
  const response = await page.goto(address.replace(/token=.*/, "token=wrong"));
  assert.equal(response.status(), 403);
  await page.close();
});

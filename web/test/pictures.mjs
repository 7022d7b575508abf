// node test/pictures.mjs ASPIC OUT: the pictures of the page in README.md and docs, in Chromium.
import { execFileSync, spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { findChromium, launchChromium } from "./e2e/chromium.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const [aspic, out] = process.argv.slice(2).map((path) => resolve(path));
if (!aspic || !out) throw new Error("node test/pictures.mjs ASPIC OUT");
if (!findChromium()) throw new Error("there is no Chromium (Debian: apt-get install chromium)");

// Address of `aspic view`, which ends with this program at the latest.
let program = null;
async function startProgram(scene, more = []) {
  program?.kill("SIGINT");
  const env = { ...process.env, XDG_STATE_HOME: folder }; // isolated from this user's list of recent scenes
  const child = spawn(aspic, ["view", join(root, scene), "--no-browser", ...more], { env });
  program = child;
  return new Promise((found, failed) => {
    let output = "";
    child.stdout.on("data", (chunk) => {
      output += chunk;
      const line = output.match(/http:\S+(?=\s)/);
      if (line) found(line[0]);
    });
    child.on("exit", (code) => failed(new Error(`aspic view ended with ${code}: ${output}`)));
  });
}

async function openPage(browser, address, height) {
  const page = await browser.newPage({ viewport: { width: 1280, height } });
  page.setDefaultTimeout(60_000);
  page.on("pageerror", (error) => {
    throw error;
  });
  await page.goto(address);
  await page.locator("#views canvas").first().waitFor();
  return page;
}

// Settings and plots, which are closed at first.
async function openPanels(page) {
  const settings = page.locator('#toolbar [aria-keyshortcuts="G"]');
  if ((await settings.getAttribute("aria-expanded")) === "false") await settings.click();
  if (await page.locator("#dock.closed").count()) await page.keyboard.press("d");
}

// Waits for that step or a later one.
const reached = (page, step) =>
  page.waitForFunction((wanted) => Number(document.querySelector(".place")?.textContent.match(/^step (\d+)/)?.[1]) >= wanted, step);

// Waits until the page looks the same for a second.
async function settled(page) {
  for (let last = ""; ; ) {
    const now = (await page.screenshot()).toString("base64");
    if (now === last) return;
    last = now;
    await page.waitForTimeout(1000);
  }
}

// Topmost point of the body: the tip of an ear.
async function highestPoint(page) {
  const view = page.locator("#views .view");
  const box = await view.boundingBox();
  for (let y = 20; y < box.height; y += 10) {
    for (let x = 0.3 * box.width; x < 0.7 * box.width; x += 12) {
      await page.mouse.move(box.x + x, box.y + y);
      await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
      if (await view.evaluate((element) => element.style.cursor === "grab")) return [box.x + x, box.y + y + 6];
    }
  }
  throw new Error("no body under the mouse");
}

// The bunny, colored by displacement and dragged by an ear, with the minimization of each step.
async function drawViewer(browser) {
  const address = await startProgram("scenes/bunny.toml", ["--set", "body.0.deform.displacement=[0, 0, 0]"]);
  const page = await openPage(browser, address, 800);
  await openPanels(page);
  await page.getByRole("tab", { name: "Microscope" }).click();
  await page.locator("#right .lil-controller").filter({ hasText: "Color by" }).locator("select").first().selectOption("displacement");
  const [x, y] = await highestPoint(page);
  await page.keyboard.press(" ");
  await page.mouse.down();
  for (const share of [0.2, 0.4, 0.6, 0.8]) {
    await page.mouse.move(x + 200 * share, y - 40 * share, { steps: 4 });
    await reached(page, 50 * share);
  }
  await page.locator("#toolbar select").first().evaluate((speeds) => { // slow, so that all panels show one step
    speeds.add(new Option("0.01x", "0.01", true, true));
    speeds.dispatchEvent(new Event("change"));
  });
  await page.waitForTimeout(5000);
  await page.getByText(/^of step/).waitFor({ state: "hidden" });
  await page.screenshot({ path: join(out, "viewer.png") });
}

// E over a plane through Newton's direction, in a step that needs the line search.
async function drawLandscape(browser) {
  const address = await startProgram("scenes/lecture/53_hard_step.toml", ["--set", `mesh=${join(root, "scenes/bunny.mesh")}`, "--set", "scale=0.1"]);
  const page = await openPage(browser, address, 1200);
  await openPanels(page);
  await page.getByRole("tab", { name: "Landscape" }).click();
  await page.keyboard.press("s");
  await reached(page, 1);
  const panel = page.getByRole("tabpanel", { name: "Landscape" });
  await panel.getByText("This is E over the plane").waitFor();
  await panel.getByRole("checkbox", { name: "log height" }).check();
  await settled(page);
  await panel.screenshot({ path: join(out, "landscape.png") });
}

// The chamber of a heart with its fibres, at rest and contracted.
async function drawHeart(browser) {
  const page = await openPage(browser, await startProgram("scenes/tissue/heart.toml"), 800);
  const box = await page.locator("#views .view").boundingBox();
  const clip = { x: box.x + box.width / 2 - 240, y: box.y, width: 480, height: box.height - 60 }; // above the hint
  await settled(page);
  await page.screenshot({ path: join(out, "heart0.png"), clip });
  for (let step = 1; step <= 13; ++step) {
    await page.keyboard.press("s");
    await reached(page, step);
  }
  await settled(page);
  await page.screenshot({ path: join(out, "heart13.png"), clip });
}

// Report of a run: its certificate.
async function drawReport(browser, folder) {
  const run = join(folder, "run");
  execFileSync(aspic, ["run", join(root, "scenes/bunny.toml"), "--out", run, "--quiet"], { stdio: "inherit" });
  const page = await openPage(browser, pathToFileURL(join(run, "report.html")).href, 800);
  await page.getByRole("tab", { name: "Certificate" }).click();
  const rows = page.getByRole("tabpanel", { name: "Certificate" }).locator("tbody tr");
  await rows.nth(39).getByRole("button").click();
  await reached(page, 40);
  await page.screenshot({ path: join(out, "report.png") });
}

mkdirSync(out, { recursive: true });
const folder = mkdtempSync(join(tmpdir(), "aspic-pictures-"));
const browser = await launchChromium();
try {
  await drawViewer(browser);
  await drawLandscape(browser);
  await drawHeart(browser);
  await drawReport(browser, folder);
} finally {
  await browser.close();
  program?.kill("SIGINT");
  rmSync(folder, { recursive: true });
}

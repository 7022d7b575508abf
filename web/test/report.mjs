// node test/report.mjs ASPIC: a run's report.html, opened from the disk without a network, plays and certifies; needs
// Chromium.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const aspic = resolve(process.argv[2]);
const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
if (!executablePath) {
  console.log("no Chromium: skipped");
  process.exit(77);
}

// With one iteration per step some do not converge: the certificate has something to find.
const kScene = `
[time]
step = 0.01
duration = 0.2
[solver]
max_iterations = 1
[[body]]
name = "beam"
shape = { box = { upper = [1, 0.2, 0.2], cells = [6, 2, 2] } }
material = { model = "neo_hookean", young = 1e5, poisson = 0.3, density = 1000 }
[[body.pin]]
name = "clamp"
where = "x < 1e-6"
`;

async function readReport(page, file) {
  await page.goto(pathToFileURL(file).href);
  const shows = (text) => page.waitForFunction((wanted) => document.querySelector("#toolbar").textContent.includes(wanted), text);
  await shows("step 0,");
  await page.keyboard.press(" "); // plays
  await shows("step 20,");
  await page.keyboard.press("q");
  const rows = page.locator(".report tbody tr");
  await rows.first().waitFor();
  assert.equal(await rows.count(), 20);
  await page.getByLabel("only steps that did not converge").check();
  const failed = await rows.count();
  assert.ok(failed > 0 && failed <= 20, `${failed} rows`);
  assert.match(await page.locator(".report .totals").textContent(), new RegExp(`${20 - failed} of 20`));
  await rows.first().getByRole("button").click(); // shows that step
  const step = await rows.first().locator("td").first().textContent();
  await shows(`step ${step},`);
  await page.getByText("Scene, with every default").click();
  await page.waitForFunction(() => document.querySelector(".report pre").textContent.includes("[[body.pin]]"));
}

const folder = mkdtempSync(join(tmpdir(), "aspic-report-"));
const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
try {
  writeFileSync(join(folder, "beam.toml"), kScene);
  execFileSync(aspic, ["run", "beam.toml", "--out", "run", "--quiet", "--allow-unconverged"], { cwd: folder, stdio: "ignore" });
  const page = await (await browser.newContext({ offline: true })).newPage();
  const wrong = [];
  page.on("pageerror", (error) => wrong.push(error.message));
  page.on("request", (request) => /^(file|data|blob):/.test(request.url()) || wrong.push(request.url()));
  await readReport(page, join(folder, "run/report.html"));
  assert.deepEqual(wrong, []);
} finally {
  await browser.close();
  rmSync(folder, { recursive: true });
}

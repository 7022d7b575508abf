// A run as one file, opened from disk without a network: it plays and contains the numbers of the run.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { aspic, boxOf, downloaded, frames, isDrawn, keepPicture, openPage, root, shownBy, temporaryFolder } from "./harness.mjs";

const folder = temporaryFolder();
const run = join(folder, "run");
const kSteps = 20;
const make = (...words) => {
  const made = spawnSync(aspic, words, { encoding: "utf8" });
  assert.equal(made.status, 0, made.stdout + made.stderr);
};
// With one iteration per step some steps do not converge, which the certificate reports.
const kOverrides = [`time.duration=${kSteps / 100}`, "solver.max_iterations=1"].flatMap((override) => ["--set", override]);
make("run", join(root, "scenes/cantilever.toml"), "--out", run, "--allow-unconverged", ...kOverrides);
const report = join(run, "report.html");

const placeOf = (page) => page.locator(".place").innerText();

async function open() {
  const opened = await openPage(pathToFileURL(report).href, { offline: true, keepsPixels: true });
  await opened.page.locator(".place").filter({ hasText: /^step \d+/ }).waitFor();
  await opened.page.locator("#views canvas").first().waitFor();
  return opened;
}

test("`aspic report` rewrites the report of a run", () => {
  assert.ok(statSync(report).size < 10e6);
  const again = join(folder, "again.html");
  make("report", run, "-o", again);
  assert.ok(statSync(again).size < 10e6);
  assert.doesNotMatch(readFileSync(again, "utf8").replace(/http:\/\/www\.w3\.org\/\S*/g, ""), /(src|href)="https?:/);
});

// Counts the points of each call that draws points without an index: dots of contact.
function countPoints() {
  window.points = [];
  const { drawArrays } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.drawArrays = function (mode, first, count) {
    if (mode === this.POINTS) window.points.push(count);
    return drawArrays.call(this, mode, first, count);
  };
}

test("a report of a mesh draws a dot per contact of its table", async () => {
  const ofMesh = join(folder, "mesh");
  make("run", join(root, "scenes/bunny.mesh"), "--steps", "25", "--out", ofMesh, "--allow-unconverged");
  const [head, ...rows] = readFileSync(join(ofMesh, "steps.csv"), "utf8").trim().split("\n").map((line) => line.split(","));
  const [step, contacts] = ["step", "contacts"].map((name) => head.indexOf(name));
  const { page, until, close } = await openPage(pathToFileURL(join(ofMesh, "report.html")).href, { offline: true, prepare: (page) => page.addInitScript(countPoints) });
  await page.locator(".place").filter({ hasText: /^step \d+/ }).waitFor();
  for (const row of rows.filter((row) => [1, 24, 25].includes(Number(row[step])))) {
    await page.getByLabel("Timeline: rewind to a step").fill(row[step]);
    await page.locator(".place").filter({ hasText: new RegExp(`^step ${row[step]},`) }).waitFor();
    const expected = Number(row[contacts]);
    await until(`${expected} dots at step ${row[step]}`, async () => {
      await page.evaluate(() => (window.points.length = 0));
      await page.keyboard.press("h"); // draws the picture again
      await frames(page, 3);
      const drawn = await page.evaluate(() => window.points);
      return (expected === 0 || drawn.length > 0) && drawn.every((count) => count === expected);
    });
  }
  assert.ok(rows.some((row) => Number(row[contacts]) > 0), "some step has contacts");
  const view = await boxOf(page.locator("#views"));
  assert.ok(view.width === 1024 && view.height > 480, `${view.width} x ${view.height}`);
  await page.keyboard.press("g");
  const shows = (label) => page.locator("#right .lil-controller").filter({ hasText: new RegExp(`^${label}$`) }).evaluateAll((rows) => rows.filter((row) => row.style.display !== "none").length);
  const labels = ["Obstacles", "Contact points", "Thickness of sheets", "Pins", "Fibres", "Link cameras"];
  assert.deepEqual(await Promise.all(labels.map(shows)), [1, 1, 0, 0, 0, 0], "rows of what the run has");
  await close();
});

test("a report plays and rewinds without requests", async () => {
  const { page, until, close } = await open();
  const view = page.locator("#views canvas").first();
  await until("a picture", () => isDrawn(view));
  const start = await placeOf(page);
  await page.keyboard.press("r");
  await page.locator(".place").filter({ hasText: /^step 0,/ }).waitFor();
  await frames(page);
  const first = await shownBy(view);
  await page.keyboard.press(" ");
  await page.waitForFunction(() => !document.querySelector(".place").textContent.startsWith("step 0,"));
  await page.getByLabel("Timeline: rewind to a step").press("End");
  await page.locator(".place").filter({ hasText: new RegExp(`^step ${kSteps},`) }).waitFor();
  await until("another picture", async () => (await shownBy(view)).print !== first.print);
  await page.locator(".chip.bad").filter({ hasText: "iteration limit" }).waitFor();
  assert.notEqual(start, "");
  await keepPicture(page, "report");
  await close();
});

test("a report has certificate, energies and scene", async () => {
  const { page, close } = await open();
  await page.getByRole("tab", { name: "Certificate" }).click();
  const panel = page.getByRole("tabpanel", { name: "Certificate" });
  await panel.locator("tbody tr").nth(kSteps - 1).waitFor();
  assert.equal(await panel.locator("tbody tr").count(), kSteps);
  assert.match(await panel.locator(".formula").first().textContent(), /ψ/);
  await keepPicture(page, "report_certificate");
  await page.getByLabel("only steps that did not converge").check();
  const failed = await panel.locator("tbody tr").count();
  assert.ok(failed > 0 && failed <= kSteps, `${failed} rows`);
  await panel.getByText(`${kSteps - failed} of ${kSteps}`, { exact: true }).waitFor();
  await page.getByLabel("only steps that did not converge").uncheck();
  await panel.locator("summary").filter({ hasText: "Complete scene with all defaults" }).click();
  await panel.locator("pre").filter({ hasText: /\[solver\]/ }).waitFor();
  await panel.locator("tbody tr").nth(4).getByRole("button").click();
  await page.locator(".place").filter({ hasText: /^step 5,/ }).waitFor();
  await page.getByRole("tab", { name: "Energy" }).click();
  const file = await downloaded(page, () => page.getByRole("tabpanel").getByRole("button", { name: "CSV" }).click());
  const rows = readFileSync(await file.path(), "utf8").trim().split("\n").slice(1);
  assert.equal(rows.filter((row) => Number(row.split(",")[0]) > 0).length, kSteps);
  await page.getByRole("tab", { name: "Microscope" }).click();
  await page.getByRole("grid", { name: "Steps" }).locator("tr[aria-selected]").first().waitFor();
  await keepPicture(page, "report_microscope");
  await close();
});

test("a report shows the error of its mesh", async () => {
  const estimated = join(folder, "estimated");
  make("run", join(root, "scenes/cantilever.toml"), "--set", "time.duration=0.2", "--out", estimated);
  const { page, until, close } = await openPage(pathToFileURL(join(estimated, "report.html")).href, { offline: true, keepsPixels: true });
  const line = page.locator(".mesh-error").filter({ hasText: /^mesh: makes 'beam' about \d+\s% too stiff.* \(step\s20\)/ });
  await line.waitFor();
  const view = page.locator("#views canvas").first();
  await until("a picture", () => isDrawn(view));
  await line.getByRole("button", { name: "Show as color", exact: true }).click();
  await page.locator(".place").filter({ hasText: /^step 20,/ }).waitFor();
  await line.getByRole("button", { name: "Show as color", pressed: true }).waitFor();
  await keepPicture(page, "report_mesh_error");
  await close();
});

test("a report explains that bodies are fixed", async () => {
  const { page, until, close } = await open();
  await until("a picture", () => isDrawn(page.locator("#views canvas").first()));
  const box = await boxOf(page.locator("#views"));
  // The notice disappears after a while.
  await until("a notice", async () => {
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 60, box.y + box.height / 2, { steps: 5 });
    await page.mouse.up();
    const notice = page.locator(".notice").filter({ hasText: "This run is recorded" });
    if (await notice.isVisible()) {
      const [view, shown] = [await boxOf(page.locator("#views")), await boxOf(notice)];
      assert.equal(view.height, box.height, "a notice does not shrink the view");
      assert.ok(shown.y > view.y + 0.7 * view.height, "a notice lies below the body");
      await notice.waitFor({ state: "detached" });
      return true;
    }
    await page.keyboard.press("0"); // undoes the rotation by the drag
    await frames(page);
  });
  await close();
});

// The report of a fit, opened from disk without a network: its numbers, its curves, and the body cut open.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { aspic, frames, isDrawn, keepPicture, openPage, root, shownBy, temporaryFolder } from "../../../../web/test/e2e/harness.mjs";

const folder = temporaryFolder();
const data = join(folder, "layers");
const material = join(folder, "layers.vtu");
const make = (...words) => {
  const made = spawnSync(aspic, words, { encoding: "utf8" });
  assert.equal(made.status, 0, made.stdout + made.stderr);
  return made.stdout;
};
const scene = join(root, "scenes/capture/two_layers.toml");
make("capture", scene, "-o", data, "--pokes", "2", "--depths", "3", "--markers", "40", "--set", "shape.box.cells=[6, 6, 4]", "-q");
const output = make("fit", data, "-o", material, "--unknown", "young=handles:8", "--known", "poisson=0.4", "--allow-unconverged");

async function open() {
  const opened = await openPage(pathToFileURL(join(folder, "layers.fit", "report.html")).href, { offline: true, keepsPixels: true });
  await opened.page.getByRole("heading", { level: 1, name: "Fit of two_layers" }).waitFor();
  return opened;
}

test("the report repeats the terminal's summary", async () => {
  const { page, close } = await open();
  const found = page.getByRole("region", { name: "Result" });
  await found.locator(".verdict").waitFor();
  const interval = output.match(/softest tet +[\d.]+ kPa +95 %: ([\d.]+) kPa to/);
  assert.ok(interval, output);
  await found.getByRole("row").filter({ hasText: "softest tet" }).waitFor();
  for (const check of ["|r|² per reading (expected: 1)", "held-out positions", "held-out forces"]) await found.getByRole("row", { name: check }).first().waitFor();
  const first = await found.locator(".about").first().innerText();
  assert.match(first, /% of the largest motion and [\d.]+ % of the largest force/);
  await keepPicture(page, "fit_report");
  await close();
});

test("every group has measured, fitted, held-out curves", async () => {
  const { page, until, close } = await open();
  const charts = page.getByRole("region", { name: "Measured and fitted" }).locator("figure");
  assert.equal(await charts.count(), 2);
  for (const name of ["measured", "fitted", "held out"]) assert.equal(await charts.getByRole("button", { name }).count(), 2);
  const canvas = charts.first().locator("canvas").first();
  await canvas.scrollIntoViewIfNeeded();
  await until("a curve", () => isDrawn(canvas));
  for (const title of ["All coordinates", "Convergence"]) await page.locator("figcaption", { hasText: title }).waitFor();
  await close();
});

test("the verdict agrees with all rows", async () => {
  const { page, close } = await open();
  const { verdict, held_out: heldOut } = JSON.parse(readFileSync(join(folder, "layers.fit", "figures.json"), "utf8"));
  const text = await page.getByRole("region", { name: "Result" }).locator(".verdict").innerText();
  for (const reason of verdict.reasons) assert.ok(text.includes(reason.text), reason.text);
  const bad = await page.getByRole("region", { name: "Predictions of unseen groups" }).locator("tr.bad").count();
  assert.equal(bad, heldOut.groups.filter((g) => g.poor || !g.ok).length + (heldOut.poor ? 1 : 0));
  if (verdict.good) assert.equal(bad, 0);
  const table = page.getByRole("region", { name: "Measured and fitted" }).getByRole("table");
  for (const row of await table.locator("tbody tr").all()) assert.match(await row.innerText(), /depth [\d.]+ mm.*[\d.]+ m?N ± [\d.]+ [mµ]?N.* k?N\/m/s);
  await page.getByText("Colors span").first().waitFor();
  await close();
});

test("maps show whole and cut bodies", async () => {
  const { page, until, close } = await open();
  const view = page.locator(".maps .fit-view").first();
  const canvas = view.locator("canvas").first();
  await view.scrollIntoViewIfNeeded();
  await until("the body", () => isDrawn(canvas));
  let last = await shownBy(canvas);
  const changes = async (what, act) => {
    await act();
    await frames(page);
    last = await until(what, async () => {
      const now = await shownBy(canvas);
      return now.print !== last.print && now;
    });
  };
  await changes("the whole body", () => page.locator("[data-control=cut]").selectOption("off"));
  await changes("a cut across x", () => page.locator("[data-control=cut]").selectOption("0"));
  await changes("the other half", () => page.getByLabel("other half").click());
  await changes("the cut moved", () => page.getByLabel("Position of the cut").fill("0.8"));
  await changes("the markers", () => page.getByLabel("markers", { exact: true }).click());
  await changes("no edges", () => page.getByLabel("edges", { exact: true }).click());
  await changes("another quantity", () => page.locator(".map select").first().selectOption("poisson"));
  await changes("dark", () => page.getByRole("button", { name: "Light or dark" }).click());
  await close();
});

test("the worst markers belong to the chosen case", async () => {
  const { page, close } = await open();
  const part = page.getByRole("region", { name: "Residuals" });
  const cases = part.locator("select");
  const names = await cases.locator("option").allTextContents();
  assert.equal(names.length, 1 + 6);
  await cases.selectOption({ index: 2 });
  const rows = part.locator("tbody tr");
  await rows.first().waitFor();
  for (const row of await rows.all()) assert.equal(await row.locator("td").nth(1).innerText(), names[2]);
  await close();
});

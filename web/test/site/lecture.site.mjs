// The pages of the lecture: their texts, and their numbers judged in the page.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { pageModule, temporaryFolder } from "../e2e/harness.mjs";
import { engineInNode, openSite, places, runNative, testsAll } from "./site.mjs";

test("each page of the lecture has formulas, something to try, and a question with its answer", async () => {
  const { messages } = await engineInNode("/scenes/cantilever.toml");
  const { lessons } = messages.find(({ kind }) => kind === "hello");
  const { formulasOf } = await pageModule("formulas.ts");
  for (const { id, exercise, question, answer } of lessons) assert.ok(formulasOf(id).length > 0 && exercise && question && answer, id);
});

const kLongest = 3600e3; // a judgment [ms]

// Opens the page of the lecture, and lets it judge itself.
async function judgedByPage({ page, heard, until }, { pages, title }, address) {
  await page.evaluate((hash) => void (location.hash = hash), address);
  await page.getByRole("heading", { name: `${pages}: ${title}` }).waitFor();
  assert.equal(await page.evaluate(() => location.hash), address);
  heard.messages.length = 0;
  await page.getByRole("button", { name: "Check this page's claim" }).click();
  const verdict = page.locator(".judgment b, .judgment .error");
  await verdict.waitFor({ timeout: kLongest });
  assert.equal(await verdict.textContent(), "pass", `page ${pages}`);
  return until("the numbers", () => heard.messages.find(({ kind }) => kind === "judged")?.result);
}

// Wall times differ.
const judged = ({ measures, passes }) => ({ passes, measures: measures.filter(({ unit }) => unit !== "s") });

// Pages that take seconds.
const kQuickPages = ["03_tissue", "05-09_equation_of_motion", "53+62_pure_newton", "54-59_overshoot", "60-61_backtracking"];

test("the page judges the lecture by the numbers of the native build", async () => {
  const out = temporaryFolder();
  const opened = await openSite(places["a file"]);
  const { lessons } = opened.heard.messages.find(({ kind }) => kind === "hello");
  const { addressOf } = await pageModule("lecture.ts");
  const chosen = testsAll ? lessons : lessons.filter(({ id }) => kQuickPages.includes(id));
  assert.ok(chosen.length >= kQuickPages.length);
  for (const lesson of chosen) {
    const result = await judgedByPage(opened, lesson, addressOf(lessons, lesson));
    runNative(["lecture", String(result.pages[0]), "--out", out]);
    const native = JSON.parse(readFileSync(join(out, result.key, "result.json"), "utf8"));
    assert.deepEqual(judged(result), judged(native), lesson.id);
    assert.ok(result.passes, lesson.id);
    console.log(`${lesson.id}: ${result.measures.length} numbers in ${result.seconds.toFixed(1)} s`);
  }
  console.log(`${chosen.length} of ${lessons.length} pages`);
  await opened.close();
});

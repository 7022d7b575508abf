// Exercises beside the pages of the lecture, and the slide view.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { answered, downloaded, keepPicture, openSession, pageModule, startProgram, steering } from "./harness.mjs";

const program = await startProgram("scenes/cantilever.toml");
const { exercises } = await pageModule("exercises/exercises.ts");

const isLesson = ({ do: what }) => what === "lesson";

async function openExercise(opened, { lesson, title }) {
  const { page, heard } = opened;
  await page.getByRole("button", { name: "Lecture", exact: true }).waitFor(); // it needs the list of pages
  if (await page.locator("#left").isHidden()) await page.keyboard.press("l");
  const { lessons } = heard.messages.find(({ kind }) => kind === "hello");
  const at = lessons.findIndex(({ id }) => id.startsWith(lesson));
  await answered(opened, lesson, isLesson, () => page.locator("#left ol.lessons li button").nth(at).click());
  await page.locator(".exercise summary", { hasText: title }).click();
}

async function verdict({ page }, code) {
  await page.getByLabel("Code of the exercise").fill(code);
  const shown = page.locator(".exercise [role=status]");
  await page.getByRole("button", { name: "Check", exact: true }).click();
  await page.waitForFunction(() => !document.querySelector(".exercise button.primary").disabled);
  return shown.innerText();
}

test("the solution of each exercise agrees with the engine", async () => {
  const opened = await openSession(program, { expected: /403/ }); // after a reload the address has no token
  for (const exercise of exercises) {
    await openExercise(opened, exercise);
    assert.match(await verdict(opened, exercise.code), /is .*, expected: /, exercise.id);
    assert.match(await verdict(opened, exercise.solution), /^Correct: \d+ results agree with the engine/, exercise.id);
    await opened.page.locator(".exercise summary", { hasText: "✓" }).waitFor();
    await keepPicture(opened.page, `exercise_${exercise.id}`);
  }
  opened.heard.messages.length = 0;
  await opened.page.reload();
  await steering(opened);
  await openExercise(opened, exercises[0]);
  assert.equal(await opened.page.getByLabel("Code of the exercise").inputValue(), exercises[0].solution);
  assert.match(await opened.page.locator(".exercise summary").innerText(), /✓/);
  await opened.close();
});

// As in a sandboxed frame.
function refuseStorage() {
  Object.defineProperty(window, "localStorage", { get: () => { throw new DOMException("refused", "SecurityError"); } });
}

test("wrong code is explained, and hints and a solution help", async () => {
  const opened = await openSession(program, { prepare: (page) => page.addInitScript(refuseStorage) });
  const { page } = opened;
  const exercise = exercises.find(({ id }) => id === "line_search");
  await openExercise(opened, exercise);
  const solve = page.getByRole("button", { name: "Show a solution" });
  assert.match(await verdict(opened, "function lineSearch() {\n  for (;;) {}\n}"), /^Stopped after 5 s: does a loop never end\?$/);
  assert.match(await verdict(opened, "function lineSearch() {\n  return 1 +;\n}"), /^Line 2: SyntaxError: Unexpected token/);
  assert.match(await verdict(opened, "return 1;"), /^Line 1: A return outside a function/);
  assert.ok(await solve.isHidden());
  assert.match(await verdict(opened, "function lineSearch(f) {\n  return f.nothing();\n}"), /^Line 2: f\.nothing is not a function/);
  assert.match(await verdict(opened, "function lineSearch() {\n  throw { message: 5, stack: 7 };\n}"), /^5$/);
  assert.match(await verdict(opened, "function lineSearch() {\n"), /Is a bracket, a text or a comment not closed\?/);
  assert.match(await verdict(opened, ""), /There is no function lineSearch/);
  const wrong = await verdict(opened, exercise.code);
  assert.match(wrong, /^rosenbrock, x = \(−1\.2, 1\), c = 0\.0001, p = 0\.5: your result is 1, expected: 9\.765625e−4 \(the engine\)\.\nThe call: lineSearch\(rosenbrock, \[-1\.2, 1\], .* tol: 1e-10 \}\)$/);
  await page.getByRole("button", { name: "Hint (2 left)" }).click();
  assert.equal(await page.locator(".exercise ol li").count(), 1);
  await solve.click();
  assert.equal(await page.locator(".exercise .solution").innerText(), exercise.solution);
  await page.getByLabel("Your name").fill("Ada Lovelace");
  const file = await downloaded(page, () => page.getByRole("button", { name: "Save my results" }).click());
  assert.equal(file.suggestedFilename(), "exercises_Ada_Lovelace.json");
  const saved = JSON.parse(readFileSync(await file.path(), "utf8")).exercises;
  assert.deepEqual(saved, [{ name: "Ada Lovelace", exercise: "line_search", tries: 4, hints: 1, solution: true, passed: false, code: exercise.code }]);
  await opened.close();
});

test("slides fill the screen and are turned by keys", async () => {
  const opened = await openSession(program);
  const { page } = opened;
  const title = page.locator("#left .lesson h2");
  await answered(opened, "a page", isLesson, () => page.keyboard.press("Shift+F"));
  await title.waitFor();
  const first = await title.innerText();
  await page.locator("#toolbar .timeline").waitFor({ state: "hidden" });
  await page.getByRole("button", { name: "Step", exact: true }).waitFor();
  for (const [key, changes] of [["ArrowRight", true], ["PageUp", false]]) {
    await answered(opened, key, isLesson, () => page.keyboard.press(key));
    await page.waitForFunction(([text, other]) => (document.querySelector("#left .lesson h2").textContent !== text) === other, [first, changes]);
  }
  await keepPicture(page, "slides");
  await answered(opened, "a page about a function", isLesson, () =>
    page.evaluate(() => {
      addEventListener("hashchange", () => setTimeout(() => (window.shownAtOnce = document.querySelector("#left .lesson h2").textContent)), { once: true });
      location.hash = "#lecture/38/2";
    }));
  assert.match(await page.evaluate(() => window.shownAtOnce), /38-42/); // before its scene is loaded
  await page.locator("#views").waitFor({ state: "hidden" });
  await page.waitForFunction(() => document.querySelector(".functions-form ~ .functions-side .chart") && document.querySelector(".surface canvas").clientHeight > innerHeight / 3);
  await answered(opened, "a page about the minimization", isLesson, () => page.evaluate(() => void (location.hash = "#lecture/53")));
  await page.keyboard.press("s");
  await page.waitForFunction(() => {
    const charts = [...document.querySelectorAll(".microscope .u-over")];
    return charts.length === 2 && charts.every(({ clientHeight }) => clientHeight > 100);
  });
  await keepPicture(page, "slides_microscope");
  await page.keyboard.press("Escape");
  await page.locator("#views").waitFor();
  await page.locator("#toolbar .timeline").waitFor();
  await opened.close();
});

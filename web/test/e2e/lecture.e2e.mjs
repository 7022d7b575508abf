// Lecture pages: each opens its demonstration, the recorded mouse plays, and the reader takes over.
import assert from "node:assert/strict";
import { test } from "node:test";
import { answered, findBody, frames, keepPicture, openSession, setPlaying, startProgram, until as eventually } from "./harness.mjs";

const program = await startProgram("scenes/cantilever.toml");

const isLesson = ({ do: what }) => what === "lesson";

async function openList(opened) {
  await opened.page.keyboard.press("l");
  await opened.page.locator("#left ol.lessons li").first().waitFor();
}

test("each lecture page opens scene and panel", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  await openList(opened);
  const { lessons } = heard.messages.find(({ kind }) => kind === "hello");
  assert.ok(lessons.length > 10, `${lessons.length} pages`);
  assert.equal(await page.locator("#left ol.lessons li").count(), lessons.length);
  for (const [i, lesson] of lessons.entries()) {
    const context = `page ${lesson.pages}, ${lesson.title}`;
    const entry = page.locator("#left ol.lessons li button").nth(i);
    if (lesson.missing) {
      assert.ok(lesson.missing.length > 10, context);
      continue;
    }
    const reported = heard.messages.length;
    const answer = await answered(opened, context, isLesson, () => entry.click());
    assert.equal(answer.kind, "reply", `${context}: ${answer.why}`);
    await page.locator("#left .lesson h2").filter({ hasText: lesson.title }).waitFor();
    assert.ok(lesson.exercise.length > 20 && lesson.claim.length > 5, context);
    await page.locator(`[role=tab][aria-selected="true"]`, { hasText: { energy: "Energy", microscope: "Microscope", landscape: "Landscape", functions: "Functions" }[lesson.panel] }).waitFor();
    if (lesson.panel === "energy") assert.equal(await page.getByRole("tabpanel", { name: "Energy" }).getByLabel("log", { exact: true }).isChecked(), lesson.log === true, context);
    if (lesson.function) await until(`the function of ${context}`, () => heard.messages.slice(reported).some(({ reply }) => reply?.formula !== undefined));
    await until(`a picture of ${context}`, ({ pictures, geometries }) => pictures.a && pictures.a.generation === geometries.a.generation);
    if (i % 6 === 1) await keepPicture(page, `lecture_${lesson.id}`);
  }
  assert.ok(lessons.some(({ log }) => log), "pages about explosions");
  assert.equal(await page.evaluate(async () => (await document.fonts.load("16px 'STIX Two Math'", "\u{1d44e}")).length), 1, "the font of formulas");
  await close();
});

test("the recorded mouse plays until a grab", async (t) => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  await openList(opened);
  await page.locator("#toolbar select").first().selectOption({ index: 0 }); // slow, so that the replay lasts
  const { lessons } = heard.messages.find(({ kind }) => kind === "hello");
  let found = null;
  for (const [i, lesson] of lessons.entries()) {
    if (lesson.missing) continue;
    const reported = heard.messages.length;
    await answered(opened, lesson.title, isLesson, () => page.locator("#left ol.lessons li button").nth(i).click());
    if (heard.messages.slice(reported).some(({ kind, replaying }) => kind === "state" && replaying)) found = lesson;
    if (found) break;
  }
  assert.ok(found, "a page with a recorded mouse");
  t.diagnostic(`page ${found.pages}: ${found.title}`);
  await page.getByText("Replaying a recorded drag").waitFor();
  await until("steps of the recorded mouse", ({ state, pictures }) => state.replaying && state.a.step > 1 && pictures.a.step > 1);
  await setPlaying(opened, false);
  assert.ok(heard.state.replaying, "a pause does not end the recorded mouse");
  // The body is found while it pauses, and grabbed while it plays; a grab may miss.
  await eventually("the reader's grab", async () => {
    const [x, y] = await findBody(opened);
    await setPlaying(opened, true);
    await page.mouse.down();
    await frames(page);
    await page.mouse.move(x + 4, y - 4);
    await setPlaying(opened, false);
    if (!heard.state.replaying && heard.state.a.grab) return true;
    await page.mouse.up();
  });
  await page.mouse.up();
  await until("a release", ({ state }) => !state.a.grab);
  await page.getByText("Drag the body yourself").waitFor();
  await close();
});

test("the lecture is searched and paged", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  await openList(opened);
  assert.ok(!(await page.getByLabel("Search the lecture").evaluate((field) => field === document.activeElement)), "keys stay shortcuts");
  await page.getByLabel("Search the lecture").fill("newton");
  const all = heard.messages.find(({ kind }) => kind === "hello").lessons.length;
  await until("fewer pages", async () => {
    const count = await page.locator("#left ol.lessons li button").count();
    return count > 0 && count < all;
  });
  await page.getByLabel("Search the lecture").fill("");
  await until("all pages", async () => (await page.locator("#left ol.lessons li button").count()) === all);
  await answered(opened, "the first page", isLesson, () => page.locator('#left ol.lessons li button:not([aria-disabled="true"])').first().click());
  const first = await page.locator("#left .lesson h2").innerText();
  await page.getByRole("button", { name: "Next", exact: true }).click();
  await page.waitForFunction((title) => document.querySelector("#left .lesson h2").textContent !== title, first);
  await page.getByRole("button", { name: "Previous", exact: true }).click();
  await page.waitForFunction((title) => document.querySelector("#left .lesson h2").textContent === title, first);
  await close();
});

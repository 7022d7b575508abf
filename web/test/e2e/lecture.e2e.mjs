// The lecture's pages: each opens what it shows, the recorded mouse plays, and the reader takes over.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { findBody, kPatience, openSession, out, startProgram } from "./harness.mjs";

const program = await startProgram("scenes/cantilever.toml");

async function openList(opened) {
  await opened.page.keyboard.press("l");
  await opened.page.locator("#left ol.lessons li").first().waitFor();
}

test("each page of the lecture opens its scene and its panel, and says what to look at", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  await openList(opened);
  const { lessons } = heard.messages.find(({ kind }) => kind === "hello");
  assert.ok(lessons.length > 10, `${lessons.length} pages`);
  assert.equal(await page.locator("#left ol.lessons li").count(), lessons.length);
  for (const [i, lesson] of lessons.entries()) {
    const tell = `page ${lesson.pages}, ${lesson.title}`;
    const entry = page.locator("#left ol.lessons li button").nth(i);
    if (lesson.missing) {
      assert.ok(lesson.missing.length > 10, tell);
      continue;
    }
    const asked = heard.sent.length;
    const told = heard.messages.length;
    await entry.click();
    await until(`${tell} is sent`, () => heard.sent.length > asked);
    const { id } = JSON.parse(heard.sent.find((text, k) => k >= asked && text.includes('"lesson"')));
    const answer = await until(`an answer to ${tell}`, () => heard.messages.slice(told).find((message) => message.id === id));
    assert.equal(answer.kind, "reply", `${tell}: ${answer.why}`);
    await page.locator("#left .lesson h2").filter({ hasText: lesson.title }).waitFor();
    assert.ok(lesson.look.length > 20 && lesson.claim.length > 5, tell);
    await page.locator(`[role=tab][aria-selected="true"]`, { hasText: { energy: "Energy", microscope: "Microscope", landscape: "Landscape", functions: "Functions" }[lesson.panel] }).waitFor();
    if (lesson.function) await until(`the function of ${tell}`, () => heard.messages.slice(told).some(({ reply }) => reply?.formula !== undefined));
    await until(`a picture of ${tell}`, ({ pictures, geometries }) => pictures.a && pictures.a.generation === geometries.a.generation);
    if (i % 6 === 1) await page.screenshot({ path: join(out, `lecture_${lesson.id}.png`) });
  }
  await close();
});

test("the recorded mouse plays until the reader takes over", async (t) => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  await openList(opened);
  await page.locator("#toolbar select").first().selectOption({ index: 0 }); // slow: it must not be over before the reader comes
  const { lessons } = heard.messages.find(({ kind }) => kind === "hello");
  let found = null;
  for (const [i, lesson] of lessons.entries()) {
    if (lesson.missing) continue;
    const told = heard.messages.length;
    await page.locator("#left ol.lessons li button").nth(i).click();
    await until("its answer", () => heard.messages.slice(told).some(({ kind }) => kind === "reply" || kind === "refused"));
    await until("a state", () => heard.messages.slice(told).some(({ kind }) => kind === "state"));
    if (heard.messages.slice(told).some(({ kind, replaying }) => kind === "state" && replaying)) found = lesson;
    if (found) break;
  }
  assert.ok(found, "a page with a recorded mouse");
  t.diagnostic(`page ${found.pages}: ${found.title}`);
  await page.getByText("A recorded mouse plays").waitFor();
  const end = Date.now() + kPatience;
  const hasTakenOver = () => !heard.state.replaying && heard.state.a.grab;
  while (!hasTakenOver() && Date.now() < end) {
    const [x, y] = await findBody(opened); // a moving body may be missed
    await page.mouse.down();
    for (let k = 1; k <= 10 && !hasTakenOver(); ++k) {
      await page.mouse.move(x + 2 * k, y - 2 * k);
      await page.waitForTimeout(200);
    }
    if (!hasTakenOver()) await page.mouse.up();
  }
  assert.ok(hasTakenOver(), "the reader's grab");
  await page.mouse.up();
  await page.getByText("the body is yours").waitFor();
  await close();
});

test("the list is searched, and turned page by page", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  await openList(opened);
  await page.getByLabel("Search the lecture").fill("newton");
  const all = heard.messages.find(({ kind }) => kind === "hello").lessons.length;
  await until("fewer pages", async () => {
    const count = await page.locator("#left ol.lessons li button").count();
    return count > 0 && count < all;
  });
  await page.getByLabel("Search the lecture").fill("");
  const told = heard.messages.length;
  await page.locator('#left ol.lessons li button:not([aria-disabled="true"])').first().click();
  await until("its scene", () => heard.messages.slice(told).some(({ kind }) => kind === "reply"));
  const first = await page.locator("#left .lesson h2").innerText();
  await page.getByRole("button", { name: "Next", exact: true }).click();
  await page.waitForFunction((title) => document.querySelector("#left .lesson h2").textContent !== title, first);
  await page.getByRole("button", { name: "Previous", exact: true }).click();
  await page.waitForFunction((title) => document.querySelector("#left .lesson h2").textContent === title, first);
  await close();
});

// Steps and iterations have the same numbers in the toolbar, the picture, the microscope and the landscape.
import assert from "node:assert/strict";
import { test } from "node:test";
import { keepPicture, openSession, pressAndWait, startProgram } from "./harness.mjs";

const program = await startProgram("scenes/cantilever.toml");

test("the step under way has one number", async () => {
  const opened = await openSession(program);
  const { page, heard, close } = opened;
  const place = page.locator(".place");
  await place.filter({ hasText: /^step 0, 0\.000 s$/ }).waitFor();
  await pressAndWait(opened, "i", "an iteration", ({ state, pictures }) => state.a.iteration === 0 && pictures.a.iteration === 0);
  await place.filter({ hasText: /^step 1, iteration 0, 0\.000 s$/ }).waitFor();
  assert.equal(heard.pictures.a.step, 1);
  await page.keyboard.press("m");
  await page.getByText(/^Step 1 is under way/).waitFor();
  await keepPicture(page, "counting");
  await page.keyboard.press("a");
  await page.getByText(/step 1, iteration 0 of 0 to 0/).waitFor();
  await pressAndWait(opened, "s", "the step", ({ state }) => state.a.step === 1 && state.a.iteration < 0);
  await place.filter({ hasText: /^step 1, 0\.010 s$/ }).waitFor();
  await page.locator(".ends").filter({ hasText: /^steps 0 to 1$/ }).waitFor();
  const last = heard.messages.findLast(({ kind }) => kind === "steps").steps.at(-1).iterations.length - 1;
  await page.keyboard.press("m");
  await page.getByText(`end ${last}`, { exact: true }).first().waitFor();
  await close();
});

// Comparison of two simulations side by side under one mouse.
import assert from "node:assert/strict";
import { test } from "node:test";
import { boxOf, findBody, keepPicture, openSession, pageModule, pressAndWait, settingOf, settled, shownBy, startProgram, toTheStart } from "./harness.mjs";

const { presets } = await pageModule("presets.ts");
const program = await startProgram("scenes/cantilever.toml");

async function compare({ page, until }, title) {
  await page.keyboard.press("c");
  const dialog = page.getByRole("dialog");
  await dialog.getByRole("button", { name: title, exact: true }).click();
  await dialog.getByRole("button", { name: "Compare", exact: true }).click();
  await until(`side b of '${title}'`, ({ scenes, state, pictures }) => scenes.b && state.b && pictures.b);
  await dialog.waitFor({ state: "detached" });
}

async function endCompare({ page, until }) {
  await page.getByRole("button", { name: "End the comparison" }).click();
  await until("the end of the comparison", ({ scenes, state }) => !scenes.b && !state.b);
  await page.waitForFunction(() => document.querySelectorAll(".side").length === 1);
}

test("each preset comparison advances two sides together", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  const all = presets(heard.scenes.a);
  assert.ok(all.length >= 6);
  for (const { title, label } of all) {
    await toTheStart(opened);
    await compare(opened, title);
    await until("two sides", async () => (await page.locator(".side").count()) === 2);
    await page.locator(".view-label").getByText(`B: ${label}`, { exact: true }).waitFor();
    assert.equal(heard.scenes.b.label, label);
    const reported = heard.messages.length;
    for (let i = 0; i < 3; ++i) {
      const { a, b } = heard.state;
      await page.keyboard.press("s");
      // An explicit side that blows up ends and reports it.
      const ended = () => [heard.state.a, heard.state.b].find(({ status }) => status === "undefined");
      await until(`both sides of '${title}' step`, () => ended() || (heard.state.a.step > a.step && heard.state.b.step > b.step));
      if (ended()) {
        assert.match(ended().words.cause, /blew up/);
        break;
      }
      const h = Math.max(heard.scenes.a.h, heard.scenes.b.h);
      assert.ok(Math.abs(heard.state.a.time - heard.state.b.time) < 0.51 * h, `${heard.state.a.time} and ${heard.state.b.time} s`);
    }
    for (const side of ["a", "b"]) assert.ok(heard.messages.slice(reported).some((m) => m.kind === "steps" && m.side === side));
    await until("both pictures", ({ pictures }) => pictures.a.step > 0 && pictures.b.step > 0);
    await endCompare(opened);
  }
  await close();
});

test("both sides share camera, mouse and legend", async () => {
  const opened = await openSession(program, { keepsPixels: true });
  const { page, heard, until, close } = opened;
  await compare(opened, "Ten times as stiff");
  assert.equal(settingOf(heard, "material.young", "b").value, 10 * settingOf(heard, "material.young").value);
  await page.getByRole("tab", { name: "Energy" }).click();
  const canvases = [0, 1].map((i) => page.locator(".side").nth(i).locator("canvas").first());
  const shown = async () => (await Promise.all(canvases.map(shownBy))).map(({ print }) => print);
  const box = await boxOf(page.locator(".side").first());
  await settled(opened);
  const before = await shown();
  await page.mouse.move(box.x + 30, box.y + 60); // beside the body
  await page.mouse.down();
  await page.mouse.move(box.x + 130, box.y + 80, { steps: 5 });
  await page.mouse.up();
  await until("both cameras turn", async () => (await shown()).every((print, i) => print !== before[i]));
  const [x, y] = await findBody(opened);
  await page.mouse.down();
  await page.mouse.move(x + 10, y - 60, { steps: 5 });
  await until("a grab of both", ({ state }) => state.a.grab && state.b.grab);
  for (let i = 0; i < 3; ++i) {
    const { step } = heard.state.a;
    await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step > step);
  }
  await page.mouse.up();
  await until("a release of both", ({ state }) => !state.a.grab && !state.b.grab);
  const panel = page.getByRole("tabpanel", { name: "Energy" });
  await panel.getByText(/10 E is dashed/).waitFor();
  const legend = await panel.innerText();
  assert.ok(/10 E/.test(legend), legend);
  await keepPicture(page, "compare");
  await page.keyboard.press("m");
  await page.getByLabel("Which side of the comparison").or(page.getByTitle("Which side of the comparison")).first().waitFor();
  await keepPicture(page, "compare_microscope");
  await endCompare(opened);
  await close();
});

test("both sides have names, and colors of their distance", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  await compare(opened, "With or without line search");
  for (const label of ["A: with line search", "B: without line search"]) await page.locator(".view-label").getByText(label, { exact: true }).waitFor();
  await endCompare(opened);
  await compare(opened, "Ten times as stiff");
  const { step } = heard.state.a;
  await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step > step && state.b.step > step);
  await until("the title of the color bar", () => page.evaluate(() => window.drawnTexts.includes("between A")));
  const choice = page.locator("#right .lil-controller").filter({ hasText: "Color by" }).locator("select").first();
  await until("its choice", async () => (await choice.inputValue()) === "distance between A and B");
  await choice.selectOption("none");
  await page.evaluate(() => (window.drawnTexts.length = 0));
  await choice.selectOption("distance between A and B");
  await until("the color bar again", () => page.evaluate(() => window.drawnTexts.includes("between A")));
  await keepPicture(page, "compare_difference");
  await endCompare(opened);
  await close();
});

test("settings change per side or for both", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  await compare(opened, "Half the time step");
  assert.equal(settingOf(heard, "time.step", "b").value, settingOf(heard, "time.step").value / 2);
  const poisson = page.getByLabel(/^Poisson's ratio.ν$/);
  for (const [side, value, a, b] of [["B", 0.3, 0.4, 0.3], ["A", 0.2, 0.2, 0.3], ["both", 0.1, 0.1, 0.1]]) {
    await page.locator(".sides").getByLabel(side, { exact: true }).check();
    await poisson.fill(String(value));
    await poisson.press("Enter");
    await until(`nu of ${side}`, () => settingOf(heard, "material.poisson").value === a && settingOf(heard, "material.poisson", "b").value === b);
  }
  await endCompare(opened);
  await close();
});

test("impossible comparisons are reported in the dialog", async () => {
  const opened = await openSession(program);
  const { page, heard, close } = opened;
  await page.keyboard.press("c");
  const dialog = page.getByRole("dialog");
  await dialog.getByLabel("Name of side B").fill("wrong");
  for (const typed of ["nonsense", "material.yuong=1e5", "material.young=-3", ""]) {
    await dialog.getByRole("textbox", { name: /Overrides of side B/ }).fill(typed);
    await dialog.getByRole("button", { name: "Compare", exact: true }).click();
    await dialog.getByRole("alert").filter({ hasText: /\w{4}/ }).waitFor();
  }
  await page.keyboard.press("Escape");
  await dialog.waitFor({ state: "detached" });
  assert.equal(heard.scenes.b, undefined);
  await close();
});

// First impression: bodies in their own colors, meaningful numbers, names instead of keys, and a page that fits its
// window.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join, relative } from "node:path";
import { test } from "node:test";
import { answered, boxOf, frames, keepPicture, openPage, openSession, pressAndWait, root, settingOf, settled, startProgram, temporaryFolder } from "./harness.mjs";

const body = (name, x) => `[[body]]
name = "${name}"
shape = { box = { lower = [${x}, 0, 0], upper = [${x + 0.2}, 0.2, 0.2], cells = [2, 2, 2] } }
material = { young = ${name === "left" ? 1e5 : 3e4}, poisson = 0.4, density = 1000 }
[[body.pin]]
where = { lowest = 0.01 }
`;
const folder = temporaryFolder();
writeFileSync(join(folder, "two.toml"), `time = { step = 0.01, duration = 1 }\n${body("left", 0)}${body("right", 0.4)}`);
const two = await startProgram(relative(root, join(folder, "two.toml")));

const isSet = ({ do: what }) => what === "set";
const young = (heard) => settingOf(heard, "material.young").value;
const fieldOf = (page, key) => page.locator("#right .lil-controller").filter({ has: page.locator(`.lil-name[title$="\\a ${key}"]`) });
const selectOf = (page, words) => page.locator("#right .lil-controller").filter({ hasText: words }).locator("select").first();

// Number of mostly blue and of mostly green pixels in the 3-D picture.
const hues = (page) =>
  page.locator("#views canvas").first().evaluate((canvas) => {
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
    copy.drawImage(canvas, 0, 0);
    const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
    let [blue, green] = [0, 0];
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = data.subarray(i, i + 3);
      if (b > 1.5 * r && b > 1.2 * g) ++blue;
      if (g > 1.3 * r && g > 1.3 * b) ++green;
    }
    return { blue, green };
  });

test("a session opens with the body, a hint and its name", async () => {
  const { page, until, close } = await openPage(two.address);
  await until("a picture", ({ state, pictures }) => state && pictures.a);
  assert.equal(await page.locator(".scene-name").innerText(), "two");
  await page.locator(".invitation").waitFor();
  for (const closed of ["#right", "#left", ".dock-body"]) assert.ok(!(await page.locator(closed).isVisible()), closed);
  const view = await boxOf(page.locator("#views"));
  assert.ok(view.width === 1024 && view.height > 480, `${view.width} x ${view.height}`);
  await page.mouse.click(view.x + 20, view.y + 20);
  await page.locator(".invitation").waitFor({ state: "detached" }); // with the first touch
  await close();
});

// Number of pixels in the color of the pins.
const pinPixels = (page) =>
  page.locator("#views canvas").first().evaluate((canvas) => {
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
    copy.drawImage(canvas, 0, 0);
    const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i] > 180 && data[i + 1] < 130 && data[i + 2] < 60) ++count;
    return count;
  });

test("pins have one size on screens of any density", async () => {
  const counts = [];
  for (const deviceScaleFactor of [1, 2]) {
    const opened = await openSession(two, { closed: true, keepsPixels: true, colorScheme: "light", deviceScaleFactor });
    await settled(opened);
    counts.push(await opened.until("pins", async () => {
      const before = await pinPixels(opened.page);
      await frames(opened.page, 4);
      return before > 50 && before === (await pinPixels(opened.page)) && before;
    }));
    await opened.close();
  }
  const ratio = counts[1] / counts[0];
  assert.ok(ratio > 2.5 && ratio < 7, `${counts.join(" and ")} pixels; twice the density has four times as many`);
});

test("two bodies have two colors", async () => {
  const opened = await openSession(two, { keepsPixels: true });
  const { page, until, close } = opened;
  const { blue, green } = await until("two colors", async () => {
    const found = await hues(page);
    return found.blue > 500 && found.green > 500 && found;
  });
  assert.ok(blue < 20 * green && green < 20 * blue, `${blue} blue, ${green} green`);
  await until("their names", () => page.evaluate(() => ["left", "right"].every((name) => window.drawnTexts.includes(name))));
  await keepPicture(page, "two_bodies");
  await close();
});

test("the color bar is beside the view", async () => {
  const opened = await openSession(two);
  const { page, until, close } = opened;
  const canvas = page.locator("#views canvas").first();
  const whole = (await boxOf(canvas)).width;
  await selectOf(page, "Color by").selectOption("von Mises stress");
  await until("a narrower picture", async () => (await boxOf(canvas)).width < whole - 80);
  await until("its title", () => page.evaluate(() => window.drawnTexts.includes("von Mises")));
  await keepPicture(page, "color_bar");
  await selectOf(page, "Color by").selectOption("body");
  await until("the whole width", async () => (await boxOf(canvas)).width === whole);
  await close();
});

test("the legend hides zeros, colors are distinct", async () => {
  const opened = await openSession(two);
  const { page, close } = opened;
  await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step === 1);
  await settled(opened);
  const entries = page.locator("#dock .chart-entry");
  await entries.filter({ hasText: "V: gravity" }).waitFor();
  const labels = await entries.locator(".chart-label").allInnerTexts();
  for (const absent of ["work of the mouse", "work of the tool", "V: probe"]) assert.ok(!labels.includes(absent), labels.join());
  const colors = await entries.locator(".chart-sample").evaluateAll((samples) => samples.map((sample) => getComputedStyle(sample).borderTopColor));
  assert.equal(new Set(colors).size, colors.length, colors.join());
  await close();
});

test("settings have display names, tooltips their keys", async () => {
  const opened = await openSession(two);
  const { page, heard, close } = opened;
  for (const { key, choices } of heard.scenes.a.settings) {
    const row = fieldOf(page, key);
    assert.equal(await row.count(), 1, key);
    const [name, title] = [await row.locator(".lil-name").textContent(), await row.locator(".lil-name").getAttribute("title")];
    assert.match(name, /^[A-Z]/, key);
    assert.ok(!/[`*]|\]\(/.test(title), title);
    const texts = await row.locator("option").allTextContents();
    assert.equal(texts.length, choices.length, key);
    for (const text of texts) assert.ok(!text.includes("_"), `${key}: ${text}`);
  }
  const titles = await page.locator("#right .lil-gui.lil-closed > .lil-title").allTextContents();
  for (const closed of ["Solver", "Line search"]) assert.ok(titles.includes(closed), titles.join());
  const first = await page.locator("#right .lil-title").first().textContent();
  assert.equal(first, "View", "display options come first");
  await close();
});

test("changes are undone singly or by reset", async () => {
  const opened = await openSession(two);
  const { page, heard, until, close } = opened;
  const before = young(heard);
  const steps = heard.state.a.step;
  for (const [key, typed] of [["material.young", "2e5"], ["material.poisson", "0.3"]]) {
    const field = fieldOf(page, key).locator("input[type=text]");
    await answered(opened, key, isSet, async () => {
      await field.fill(typed);
      await field.press("Enter");
    });
  }
  await answered(opened, "an undo", isSet, () => page.keyboard.press("z"));
  await until("the value before", () => settingOf(heard, "material.poisson").value === 0.4 && young(heard) === 2e5);
  await answered(opened, "another undo", isSet, () => page.getByRole("button", { name: "Undo", exact: true }).click());
  await until("the first value", () => young(heard) === before);
  assert.deepEqual(heard.scenes.a.overrides, heard.scenes.a.loaded_overrides, "each body has its own value again");
  await answered(opened, "a material", isSet, () => selectOf(page, "Typical values").selectOption("Fat"));
  await until("its values", () => young(heard) === 3000 && settingOf(heard, "material.density").value === 920);
  await answered(opened, "a reset", isSet, () => page.getByRole("button", { name: "Reset settings", exact: true }).click());
  await until("what was loaded", () => heard.scenes.a.overrides.length === 0 && young(heard) === before);
  await answered(opened, "the reset's undo", isSet, () => page.keyboard.press("z"));
  await until("the material again", () => young(heard) === 3000 && settingOf(heard, "material.density").value === 920);
  await answered(opened, "the material's undo", isSet, () => page.keyboard.press("z"));
  await until("its end", () => heard.scenes.a.overrides.length === 0);
  assert.equal(heard.state.a.step, steps, "the motion continues from where it was");
  await close();
});

test("the lecture fills a phone", async () => {
  const { page, until, close } = await openSession(two, { size: [390, 844] });
  const lecture = page.getByRole("button", { name: "Lecture", exact: true });
  if (await lecture.isVisible()) {
    await lecture.click();
    await until("no empty band", async () => {
      const dock = await boxOf(page.locator("#dock"));
      return dock.y + dock.height >= 843;
    });
  }
  await close();
});

test("a phone shows the view above drawers", async () => {
  const opened = await openSession(two, { size: [360, 640] });
  const { page, close } = opened;
  await frames(page);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(overflow <= 0, `${overflow} px too wide`);
  const view = await boxOf(page.locator("#views"));
  assert.ok(view.width === 360 && view.height > 320, `${view.width} x ${view.height}`);
  await keepPicture(page, "phone");
  for (const [name, place] of [["Settings", "#right"], ["Lecture", "#left"]]) {
    const button = page.getByRole("button", { name, exact: true });
    if (!(await button.isVisible())) continue;
    await button.click();
    const drawer = await boxOf(page.locator(place));
    const end = name === "Lecture" ? drawer.y + 100 : drawer.y + drawer.height; // with the lecture the page scrolls
    assert.ok(drawer.width === 360 && end <= 640, `${name}: ${JSON.stringify(drawer)}`);
    assert.ok((await boxOf(page.locator("#views"))).height > 120, `${name} leaves the view`);
    await keepPicture(page, `phone_${name.toLowerCase()}`);
    await button.click();
  }
  await page.getByRole("tab", { name: "Energy" }).click();
  assert.ok((await boxOf(page.locator("#views"))).height > 120, "the plots leave the view");
  await keepPicture(page, "phone_energy");
  await close();
});

// Accessibility: keys, names for screen readers, light and dark, large fonts on a small screen.
import assert from "node:assert/strict";
import { test } from "node:test";
import { findBody, frames, keepPicture, openSession, pressAndWait, setPlaying, settled, startProgram } from "./harness.mjs";

const program = await startProgram("scenes/cantilever.toml");
// Text of each panel that is complete after kSteps steps.
const kSteps = 4;
const kPanels = {
  Energy: /\w/,
  Microscope: new RegExp(`Step ${kSteps}\\.`),
  Landscape: new RegExp(`step ${kSteps}, iteration \\d+ of .*This is E over the plane`, "s"),
  Functions: /iteration \d+ of/,
  Certificate: new RegExp(`1 to ${kSteps} of ${kSteps}`),
};

async function openPanel(opened, name) {
  await opened.page.getByRole("tab", { name }).click();
  await opened.page.getByRole("tabpanel", { name }).filter({ hasText: kPanels[name] }).waitFor();
  await settled(opened);
}
const openFolders = (page) =>
  page.locator("#right .lil-closed > .lil-title").evaluateAll((titles) => titles.forEach((title) => title.click()));

async function withSteps(options) {
  const opened = await openSession(program, options);
  for (let step = 1; step <= kSteps; ++step) await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step === step);
  await settled(opened);
  return opened;
}

test("every listed shortcut works without errors", async () => {
  const opened = await withSteps();
  const { page, errors, until, close } = opened;
  await page.keyboard.press("?");
  const dialog = page.getByRole("dialog", { name: "Keyboard shortcuts" });
  await dialog.waitFor();
  const keys = await dialog.locator("kbd").allInnerTexts();
  assert.ok(keys.length > 30, `${keys.length} shortcuts`);
  assert.equal(new Set(keys).size, keys.length, "no key twice");
  await keepPicture(page, "shortcuts");
  await page.keyboard.press("Escape");
  await dialog.waitFor({ state: "detached" });
  const pressed = (key) => (key === "Space" ? " " : key.length === 1 ? key.toLowerCase() : key.replace(/^Shift\+(Left|Right|Up|Down)$/, "Shift+Arrow$1"));
  for (const key of keys.filter((key) => !["Shift+L"].includes(key))) {
    await page.keyboard.press(pressed(key));
    await frames(page, 2);
    if (key === "Shift+V") await page.keyboard.press(key); // a video would slow down the rest
    await page.keyboard.press("Escape"); // closes a dialog that it opened
    await page.waitForFunction(() => !document.querySelector("dialog[open]"));
    assert.deepEqual(errors, [], `after ${key}`);
  }
  await until("an end of what was begun", ({ state }) => !state.replaying);
  if (opened.heard.state.b) await pressAndWait(opened, "c", "no comparison", ({ state }) => !state.b);
  await setPlaying(opened, false);
  await close();
});

// Controls without a name, by the browser's own rules.
async function nameless(page, context) {
  const session = await page.context().newCDPSession(page);
  await session.send("Accessibility.enable");
  const { nodes } = await session.send("Accessibility.getFullAXTree");
  const roles = /^(button|textbox|searchbox|combobox|checkbox|radio|slider|spinbutton|tab|switch|menuitem|separator|grid|ColorWell|DisclosureTriangle|application|dialog)$/;
  const wrong = nodes.filter((node) => !node.ignored && roles.test(node.role?.value) && !node.name?.value?.trim());
  const reported = [];
  for (const node of wrong) {
    const { node: found } = await session.send("DOM.describeNode", { backendNodeId: node.backendDOMNodeId });
    reported.push(`${context}: ${node.role.value} <${found.localName} ${found.attributes.join(" ")}>`);
  }
  await session.detach();
  return reported;
}

test("every control has an accessible name", async () => {
  const opened = await withSteps();
  const { page, close } = opened;
  await openFolders(page);
  const found = [];
  for (const panel of Object.keys(kPanels)) {
    await openPanel(opened, panel);
    found.push(...(await nameless(page, panel)));
  }
  for (const key of ["?", "c", "Shift+O", "Shift+M"]) {
    await page.keyboard.press(key);
    await page.locator("dialog[open]").waitFor();
    await settled(opened); // with the list of scenes
    found.push(...(await nameless(page, `dialog of ${key}`)));
    await page.keyboard.press("Escape");
    await page.locator("dialog").waitFor({ state: "detached" });
  }
  assert.deepEqual([...new Set(found)], []);
  await close();
});

test("Tab reaches every visible control", async () => {
  const opened = await withSteps();
  const { page, close } = opened;
  await page.evaluate(() => document.body.focus());
  const expected = await page.evaluate(() => {
    const controls = [...document.querySelectorAll("button, input, select, textarea, [tabindex]")];
    const shown = controls.filter((c) => c.checkVisibility({ visibilityProperty: true }) && !c.disabled && c.tabIndex >= 0);
    shown.forEach((control, i) => (control.dataset.nth = String(i)));
    return shown.length;
  });
  const reached = new Set();
  for (let i = 0; i < expected + 20; ++i) {
    await page.keyboard.press("Tab");
    const nth = await page.evaluate(() => document.activeElement?.dataset.nth);
    if (nth !== undefined && reached.has(nth) && reached.size > 5 && nth === [...reached][0]) break;
    if (nth !== undefined) reached.add(nth);
  }
  const missed = await page.evaluate((nths) => [...document.querySelectorAll("[data-nth]")].filter((c) => !nths.includes(c.dataset.nth) && c.type !== "radio").map((c) => c.outerHTML.slice(0, 160)), [...reached]);
  assert.deepEqual(missed, []);
  await close();
});

test("every display control works without errors", async () => {
  const opened = await withSteps();
  const { page, errors, until, close } = opened;
  await openFolders(page);
  const view = page.locator("#right .lil-gui.lil-root").first();
  for (const select of await view.locator("select").all()) {
    const values = await select.locator("option").evaluateAll((options) => options.map((option) => option.value));
    const first = await select.inputValue();
    for (const value of [...values, first]) {
      await select.selectOption(value);
      await frames(page, 2);
    }
  }
  for (const box of await view.locator("input[type=checkbox]").all()) {
    if (!(await box.isVisible()) || (await box.isDisabled())) continue;
    await box.click();
    await frames(page, 2);
    await box.click();
  }
  for (const field of await view.locator("input[type=text], input[type=number]").all()) {
    if (!(await field.isVisible()) || (await field.isDisabled())) continue;
    const before = await field.inputValue();
    for (const typed of ["nan", "1e400", "-1", "", "text", before]) {
      if ((await field.getAttribute("type")) === "number" && !/^-?[\d.]*$/.test(typed)) continue;
      await field.fill(typed);
      await field.press("Enter");
      await frames(page, 1);
    }
  }
  for (const button of await view.locator(".lil-controller button").all()) if (await button.isVisible()) await button.click();
  assert.deepEqual(errors, []);
  await page.getByRole("button", { name: "Reset display", exact: true }).click();
  await page.keyboard.press("0");
  await findBody(opened);
  const { step } = opened.heard.state.a;
  await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step === step + 1);
  await until("its picture", ({ pictures }) => pictures.a.step === step + 1);
  await close();
});

// Parts of the page that overlap, and panels that scroll sideways.
async function layoutFaults(page) {
  return page.evaluate(() => {
    const faults = [];
    const parts = ["toolbar", "left", "views", "right", "dock"].map((id) => document.getElementById(id)).filter((part) => part.checkVisibility());
    const boxes = parts.map((part) => part.getBoundingClientRect());
    boxes.forEach((a, i) => {
      if (a.left < -1 || a.top < -1 || a.right > innerWidth + 1 || a.bottom > innerHeight + 1) faults.push(`${parts[i].id} leaves the window`);
      boxes.slice(i + 1).forEach((b, j) => {
        const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        if (wide > 1 && high > 1) faults.push(`${parts[i].id} covers ${parts[i + 1 + j].id}`);
      });
    });
    const view = document.getElementById("views").getBoundingClientRect();
    if (view.width < 200 || view.height < 120) faults.push(`the view is only ${view.width} by ${view.height}`);
    for (const element of document.querySelectorAll("#toolbar, #right *, #left *, #dock *, #right, #left, #dock")) {
      if (!element.checkVisibility() || element.closest("svg")) continue;
      const { overflowX } = getComputedStyle(element);
      if (element.closest(".report")) continue; // a table of nine columns may scroll
      if (/auto|scroll/.test(overflowX) && element.scrollWidth > element.clientWidth + 1 && element.tagName !== "PRE" && element.tagName !== "TEXTAREA")
        faults.push(`scrolls sideways: ${element.tagName} ${element.className} in ${element.closest("[id]")?.id} (${element.scrollWidth} > ${element.clientWidth})`);
      const box = element.getBoundingClientRect();
      const inside = element.closest("#toolbar, #right, #left, #dock").getBoundingClientRect();
      if (element.matches("button, input, select") && box.width > 0 && box.right > inside.right + 1) faults.push(`cut off: ${element.outerHTML.slice(0, 100)}`);
    }
    return [...new Set(faults)];
  });
}

for (const [name, scheme, size, larger] of [
  ["light", "light", [1280, 720], 0],
  ["dark", "dark", [1280, 720], 0],
  ["large", "light", [1024, 768], 4], // 22 px: 1.5 times and more
]) {
  test(`nothing is covered: ${name}, ${size.join("x")}`, async () => {
    const opened = await withSteps({ size, colorScheme: scheme });
    const { page, close } = opened;
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), scheme);
    for (let i = 0; i < larger; ++i) await page.keyboard.press(">");
    const found = [];
    for (const panel of Object.keys(kPanels)) {
      await openPanel(opened, panel);
      found.push(...(await layoutFaults(page)).map((fault) => `${panel}: ${fault}`));
      await keepPicture(page, `${name}_${panel.toLowerCase()}`);
    }
    assert.deepEqual(found, []);
    await close();
  });
}

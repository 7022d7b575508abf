// The page in Chromium, from a file and from web servers.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { downloaded, drop, findBody, frames, isDrawn, keepPicture, pageModule, pressAndWait, sceneButton, settled, temporaryFolder } from "../e2e/harness.mjs";
import { hashesIn, loadScene, openSite, places, takeSteps } from "./site.mjs";

for (const [place, address] of Object.entries(places)) {
  test(`from ${place}, the body is dragged and the minimization is shown`, async () => {
    const opened = await openSite(address);
    const { page, heard, until, close } = opened;
    await pressAndWait(opened, "i", "an iteration", ({ state }) => state.a.iteration >= 0 || state.a.step === 1);
    while (heard.state.a.step === 0) await pressAndWait(opened, "i", "an iteration", () => true);
    await page.getByRole("tab", { name: "Landscape" }).click();
    const { slice } = await until("the slice", () => heard.messages.find(({ kind, reply }) => kind === "reply" && reply?.slice)?.reply);
    assert.equal(slice.value.length, slice.columns * slice.rows);
    const canvas = page.getByRole("tabpanel", { name: "Landscape" }).locator("canvas").first();
    await until("its surface", () => isDrawn(canvas));
    await settled(opened);
    const [x, y] = await findBody(opened);
    await page.mouse.down();
    await page.mouse.move(x + 60, y - 40, { steps: 4 });
    await until("a grab", ({ state }) => state.a.grab);
    await pressAndWait(opened, " ", "a run", ({ state }) => state.playing);
    const { step } = heard.state.a;
    await until("ten steps with a force", ({ state }) => state.a.step >= step + 10 && state.a.grab && Math.hypot(...state.a.grab.force) > 0);
    await keepPicture(page, `site_${place.split(" ").at(-1)}`);
    await page.mouse.up();
    await until("a release", ({ state }) => !state.a.grab);
    await pressAndWait(opened, " ", "a pause", ({ state }) => !state.playing);
    await frames(page);
    await close();
  });
}

test("the page works in a sandboxed frame", async () => {
  const opened = await openSite(`${places["a web server"]}frame`);
  const frame = opened.page.frameLocator("iframe");
  await frame.getByRole("button", { name: "1 iteration", exact: true }).waitFor();
  await frame.getByRole("button", { name: "Step", exact: true }).click();
  await opened.until("a step", ({ state, pictures }) => state.a.step === 1 && pictures.a.step === 1);
  await opened.close();
});

test("the address opens a page of the lecture", async () => {
  const opened = await openSite(`${places["a file"]}#lecture/33`, "33_mouse");
  await opened.page.getByRole("heading", { name: /^Pages 33-34/ }).waitFor();
  await opened.until("the recorded mouse", ({ state }) => state.replaying && state.b);
  await opened.close();
});

test("scenes have pictures, two beside each other on a phone", async () => {
  const opened = await openSite(places["a file"], "bunny", { size: [390, 844] });
  await opened.page.keyboard.press("Shift+O");
  const pictures = opened.page.locator(".gallery .scene img");
  await pictures.first().waitFor();
  const shown = await pictures.evaluateAll((all) => Promise.all(all.map((image) => image.decode().then(() => image.naturalWidth))));
  assert.ok(shown.length >= 20 && shown.every((width) => width === 280), shown.join());
  assert.equal((await pictures.nth(0).boundingBox()).y, (await pictures.nth(1).boundingBox()).y);
  await keepPicture(opened.page, "site_gallery");
  await opened.close();
});

test("no formula is cut off on a phone", async () => {
  const opened = await openSite(`${places["a file"]}#lecture/33`, "33_mouse", { size: [390, 844] });
  const formulas = opened.page.locator(".lesson .formula");
  await formulas.first().waitFor();
  await frames(opened.page);
  const hidden = await formulas.evaluateAll((all) => all.map(({ scrollWidth, clientWidth }) => scrollWidth - clientWidth));
  assert.deepEqual(hidden, hidden.map(() => 0));
  await keepPicture(opened.page, "site_phone");
  await opened.close();
});

// Drops pictures, but no geometry, once `window.dropsPictures` is set.
const dropPictures = (page) =>
  page.addInitScript(() => {
    const { set } = Object.getOwnPropertyDescriptor(MessagePort.prototype, "onmessage");
    const isPicture = (data) => data instanceof ArrayBuffer && new Uint32Array(data, 0, 1)[0] === 2;
    const withoutPictures = (handler) => (event) => (window.dropsPictures && isPicture(event.data) ? undefined : handler(event));
    Object.defineProperty(MessagePort.prototype, "onmessage", { set: function (handler) { set.call(this, withoutPictures(handler)); } });
  });

test("a body is hidden until its first picture", async () => {
  const opened = await openSite(places["a file"], "bunny", { prepare: dropPictures });
  const canvas = opened.page.locator("#views canvas").first();
  await opened.until("the bunny", () => isDrawn(canvas));
  await opened.page.evaluate(() => void (window.dropsPictures = true));
  await opened.page.keyboard.press("Shift+O");
  await sceneButton(opened.page, "cantilever").click();
  await opened.until("the geometry", ({ scenes, geometries }) => scenes.a.name === "cantilever" && geometries.a.generation === scenes.a.generation);
  await frames(opened.page, 4);
  assert.equal(await isDrawn(canvas), false);
  await opened.close();
});

test("a link and a saved page open the workspace", async () => {
  const opened = await openSite(places["a file"]);
  await loadScene(opened, "twist");
  await opened.page.keyboard.press("Shift+C");
  await opened.page.waitForFunction(() => location.hash.startsWith("#s="));
  const link = opened.page.url();
  const saved = await downloaded(opened.page, () => opened.page.keyboard.press("Shift+H"));
  assert.equal(saved.suggestedFilename(), "twist.html");
  const copy = join(temporaryFolder(), "twist.html");
  writeFileSync(copy, readFileSync(await saved.path()));
  await opened.close();
  for (const address of [link, pathToFileURL(copy).href]) await (await openSite(address, "twist")).close();
  const pasted = await openSite(places["a file"]);
  await pasted.page.evaluate((hash) => void (location.hash = hash), new URL(link).hash);
  await pasted.until("the scene of a link in an open page", ({ scenes }) => scenes.a.name === "twist");
  await pasted.close();
});

// Gradient descent that needs minutes for a step.
const kEndless = ["body.0.shape.box.cells=[41, 5, 5]", "solver.method=gradient_descent", "solver.tolerance=1e-12", "solver.max_iterations=1000000"];

test("a long step is stopped, from a file and from web servers", async () => {
  const { linkText } = await pageModule("share.ts");
  const link = await linkText({ aspic_workspace: 1, scene: "/scenes/cantilever.toml", overrides: kEndless, settings: {}, compare: null, page: {} });
  for (const [place, address] of Object.entries(places)) {
    const opened = await openSite(address + link, "cantilever");
    await opened.page.keyboard.press("s"); // runs until it is stopped
    await frames(opened.page);
    await opened.page.waitForTimeout(1000);
    const start = performance.now();
    await pressAndWait(opened, "r", "a reset", () => true);
    assert.deepEqual(hashesIn(opened.heard.messages), [], "the step did not end by itself");
    console.log(`${place}: stopped after ${(performance.now() - start).toFixed(0)} ms`);
    await opened.close();
  }
});

// A closed surface without tets.
const kOctahedron = `v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1
f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n`;

test("a dropped surface moves with a cage", async () => {
  const opened = await openSite(places["a file"]);
  await drop(opened.page, [["octahedron.obj", Buffer.from(kOctahedron)]]);
  await opened.until("the body", ({ scenes, pictures, geometries }) => scenes.a.name === "octahedron" && pictures.a.generation === geometries.a.generation);
  assert.ok(opened.heard.scenes.a.notes.some((note) => note.includes("cubes around the surface")), opened.heard.scenes.a.notes.join("; "));
  await takeSteps(opened, 3);
  await opened.close();
});

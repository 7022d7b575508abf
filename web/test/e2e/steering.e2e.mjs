// Time and touch: play, step, rewind, drag, pin.
import assert from "node:assert/strict";
import { test } from "node:test";
import { assertSameBits, boxOf, contrast, findBody, frames, openSession, pageModule, pressAndWait, sameBits, screenOf, setPlaying, shownBy, startProgram, toTheStart } from "./harness.mjs";

const { valueText } = await pageModule("view/values.ts");
const program = await startProgram("scenes/cantilever.toml");
const length = (v) => Math.hypot(...v);
const minus = (a, b) => a.map((x, i) => x - b[i]);

test("the first picture appears without a token", async () => {
  // A reload requests the page without the token, which the tab has kept.
  const opened = await openSession(program, { expected: /status of 403/ });
  const { page, heard, until, close } = opened;
  await findBody(opened);
  await until("the body on the screen", async () => (await contrast(page, await screenOf(page.locator("#views")))) > 5);
  assert.ok(!page.url().includes("token"));
  assert.match(await page.title(), /cantilever/);
  assert.equal(heard.geometries.a.rest.length, heard.pictures.a.positions.length);
  await page.reload();
  await findBody(opened);
  await close();
});

test("plays, pauses, steps and resets", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await until("five steps", () => heard.state.a.step >= 5 && heard.pictures.a.step >= 1);
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  await until("a pause", () => !heard.state.playing);
  await toTheStart(opened);
  const start = heard.pictures.a.positions;
  await pressAndWait(opened, "s", "one step", () => heard.state.a.step === 1 && heard.pictures.a.step === 1);
  assert.ok(!sameBits(heard.pictures.a.positions, start));
  await setPlaying(opened, true);
  await setPlaying(opened, false);
  await close();
});

test("the timeline rewinds by mouse and keys", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  const seen = [];
  for (let step = 1; step <= 6; ++step) {
    await pressAndWait(opened, "s", `step ${step}`, () => heard.state.a.step === step && heard.pictures.a.step === step);
    seen[step] = heard.pictures.a.positions;
  }
  const timeline = page.getByLabel("Timeline: rewind to a step");
  await until("the last step under its handle", async () => (await timeline.inputValue()) === "6");
  await timeline.press("ArrowLeft");
  await until("step 5", () => heard.state.a.step === 5 && heard.pictures.a.step === 5);
  assertSameBits(heard.pictures.a.positions, seen[5]);
  const box = await boxOf(timeline);
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await until("a step halfway", () => [2, 3].includes(heard.state.a.step) && heard.pictures.a.step === heard.state.a.step);
  assertSameBits(heard.pictures.a.positions, seen[heard.state.a.step]);
  await close();
});

test("a dragged body follows the mouse with force", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  const [x, y] = await findBody(opened);
  await page.mouse.down();
  await page.mouse.move(x + 30, y - 80, { steps: 6 });
  await frames(page);
  const isSent = (target) => target && heard.sent.findLast((text) => JSON.parse(text).do === "move") === JSON.stringify({ do: "move", target });
  await until("the spring's end", ({ state }) => isSent(state.a.grab?.target));
  assert.ok(length(minus(heard.state.a.grab.target, heard.state.a.grab.point)) > 0.01);
  const held = heard.state.a.grab;
  const pull = minus(held.target, held.point);
  for (let step = 1; step <= 8; ++step)
    await pressAndWait(opened, "s", `step ${step}`, () => heard.state.a.step === step && heard.pictures.a.step === step);
  const { grab } = heard.state.a;
  assert.ok(length(minus(grab.target, grab.point)) < length(pull), "the point comes closer to the mouse");
  const { rest } = heard.geometries.a;
  const moved = heard.pictures.a.positions.map((value, i) => value - rest[i]);
  let farthest = 0;
  for (let i = 0; i < moved.length; i += 3) {
    const along = (moved[i] * pull[0] + moved[i + 1] * pull[1] + moved[i + 2] * pull[2]) / length(pull);
    farthest = Math.max(farthest, along);
  }
  assert.ok(farthest > 0.005, `vertices move towards the mouse: ${farthest} m`);
  const newtons = valueText(length(grab.force), "N", 3);
  await page.waitForFunction((text) => window.drawnTexts.includes(text), newtons);
  await page.mouse.up();
  await until("a release", () => heard.state.a.grab === null);
  await page.evaluate(() => (window.drawnTexts = []));
  await pressAndWait(opened, "s", "a step", () => heard.state.a.step === 9 && heard.pictures.a.step === 9);
  await page.waitForFunction(() => window.drawnTexts.length > 0);
  assert.deepEqual(await page.evaluate(() => window.drawnTexts.filter((text) => / [munkM]?N$/.test(text))), []);
  await close();
});

test("Escape and leaving the window release bodies", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  for (const leave of [() => page.keyboard.press("Escape"), () => page.evaluate(() => dispatchEvent(new Event("blur")))]) {
    const [x, y] = await findBody(opened);
    await page.mouse.down();
    await page.mouse.move(x + 30, y - 30, { steps: 3 });
    await until("a grab", () => heard.state.a.grab);
    await leave();
    await until("a release", () => heard.state.a.grab === null);
    await page.mouse.up();
  }
  await close();
});

test("a watching page only turns the camera", async () => {
  const one = await openSession(program);
  const two = await openSession(program, { watches: true, keepsPixels: true });
  await two.page.getByText("Watching", { exact: true }).waitFor();
  const box = await boxOf(two.page.locator("#views"));
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const canvas = two.page.locator("#views canvas").first();
  const before = await shownBy(canvas);
  await two.page.mouse.move(x, y);
  await two.page.mouse.down();
  await two.page.mouse.move(x + 120, y - 40, { steps: 5 });
  await two.page.mouse.up();
  await two.until("another camera", async () => (await shownBy(canvas)).print !== before.print);
  assert.deepEqual(two.heard.sent, []);
  assert.equal(one.heard.state.a.grab, null);
  await two.close();
  await one.close();
});

test("the brush pins and unpins what it covers", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  const pins = () => heard.messages.findLast(({ kind, side }) => kind === "pins" && side === "a")?.vertices ?? [];
  const clamped = pins().length;
  await page.keyboard.press("b");
  const [x, y] = await findBody(opened);
  const stroke = async () => {
    const [sent, reported] = [heard.sent.length, heard.messages.length];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 12, y, { steps: 3 });
    await page.mouse.up();
    await frames(page);
    const asked = heard.sent.slice(sent).filter((text) => JSON.parse(text).do === "pin").length;
    await until("the pins of the stroke", () => heard.messages.slice(reported).filter(({ kind }) => kind === "pins").length >= asked);
  };
  await stroke();
  await until("pins", () => pins().length > clamped);
  await page.keyboard.down("Alt");
  await stroke();
  await page.keyboard.up("Alt");
  await until("no pins but the clamp's", () => pins().length === clamped);
  await stroke();
  await until("pins again", () => pins().length > clamped);
  const pinned = pins();
  const places = (picture) => pinned.map((v) => [...picture.positions.subarray(3 * v, 3 * v + 3)]);
  const start = places(heard.pictures.a);
  await pressAndWait(opened, "s", "a step", () => heard.pictures.a.step === 1);
  assert.deepEqual(places(heard.pictures.a), start, "pinned vertices stay");
  await close();
});

test("the reading tool shows vertex and tet", async () => {
  const opened = await openSession(program);
  const { page, close } = opened;
  const [x, y] = await findBody(opened);
  await page.keyboard.down("Shift");
  await page.mouse.click(x, y);
  await page.keyboard.up("Shift");
  const card = page.getByLabel("Values at the point");
  await card.getByText(/^Vertex \d+/).waitFor();
  await card.getByText(/^Tet \d+/).waitFor();
  assert.match(await card.innerText(), /von Mises/);
  await card.getByLabel("Close").click();
  await card.waitFor({ state: "hidden" });
  await close();
});

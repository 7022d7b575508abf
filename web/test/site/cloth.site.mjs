// Cloth in the page: it is dragged by mouse and finger, and drawn with its thickness.
import assert from "node:assert/strict";
import { test } from "node:test";
import { findBody, frames, isDrawn, keepPicture, setPlaying, shownBy } from "../e2e/harness.mjs";
import { loadScene, openSite, places } from "./site.mjs";

const distance = (a, b) => Math.hypot(...a.map((x, c) => x - b[c]));

const mouse = async ({ mouse }) => ({ down: (x, y) => mouse.move(x, y).then(() => mouse.down()), move: (x, y) => mouse.move(x, y, { steps: 4 }), up: () => mouse.up() });

async function finger(page) {
  const devtools = await page.context().newCDPSession(page);
  const touch = (type, ...touchPoints) => devtools.send("Input.dispatchTouchEvent", { type, touchPoints });
  return { down: (x, y) => touch("touchStart", { x, y }), move: (x, y) => touch("touchMove", { x, y }), up: () => touch("touchEnd") };
}

for (const [name, pointer, options] of [["mouse", mouse, {}], ["finger", finger, { size: [390, 844], hasTouch: true, isMobile: true }]])
  test(`cloth follows the ${name}, lets go, and every step converges`, async () => {
    const opened = await openSite(places["a web server"], "bunny", options);
    const { page, heard, until, close } = opened;
    await loadScene(opened, "cloth");
    heard.messages.length = 0;
    const [x, y] = await findBody(opened);
    const { down, move, up } = await pointer(page);
    await down(x, y);
    await until("a grab", ({ state }) => state.a.grab);
    const start = heard.state.a.grab.point;
    await move(x + 50, y - 80);
    const { target } = await until("a pull", ({ state }) => distance(state.a.grab.target, start) > 0.1 && state.a.grab);
    await setPlaying(opened, true);
    const isNear = ({ grab, step }) => step >= 20 && distance(grab.point, target) < 0.3 * distance(start, target);
    await until("the cloth at the pointer", ({ state, pictures }) => isNear(state.a) && pictures.a.step >= 20);
    await keepPicture(page, `site_cloth_${name}`);
    await up();
    await until("a release", ({ state }) => state.a.grab === null);
    const { step } = heard.state.a;
    await until("ten steps without a force", ({ state }) => state.a.step >= step + 10);
    await setPlaying(opened, false);
    const rows = heard.messages.flatMap(({ kind, steps }) => (kind === "steps" ? steps : []));
    assert.ok(rows.length >= 10);
    assert.deepEqual(rows.filter(({ converged }) => !converged).map(({ step, status }) => `${step}: ${status}`), []);
    await close();
  });

test("sheets are drawn with their thickness", async () => {
  const opened = await openSite(places["a file"], "bunny", { keepsPixels: true });
  await loadScene(opened, "cloth");
  const canvas = opened.page.locator("#views canvas").first();
  const box = opened.page.locator("#right .lil-controller").filter({ hasText: /^Thickness of sheets$/ }).locator("input");
  await opened.page.locator(".scene-name", { hasText: "cloth" }).waitFor();
  const shown = async () => (await shownBy(canvas)).print;
  const thin = await opened.until("a still picture", async () => {
    const before = await shown();
    await frames(opened.page, 4);
    return (await isDrawn(canvas)) && before === (await shown()) && before;
  });
  await box.evaluate((input) => input.click());
  await opened.until("thick sheets", async () => (await shown()) !== thin);
  await box.evaluate((input) => input.click());
  await opened.until("thin sheets again", async () => (await shown()) === thin);
  await opened.close();
});

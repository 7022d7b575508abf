// Opening scenes: from the gallery, by drag and drop, saved with their meshes, exported as animations.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { aspic, downloaded, drop, findBody, frames, keepPicture, openSession, pressAndWait, sceneButton, startProgram, temporaryFolder } from "./harness.mjs";

const program = await startProgram("scenes/cantilever.toml");
const read = async (file) => readFileSync(await file.path());
const atStep = (opened, step) =>
  pressAndWait(opened, "s", `step ${step}`, ({ state, pictures }) => state.a.step === step && pictures.a.step === step);
const lastHash = ({ heard }) => heard.messages.findLast(({ kind, steps }) => kind === "steps" && steps.length > 0).steps.at(-1).state_hash;

// State after `steps` of a run on the command line.
function hashOfRun(scene, steps) {
  const out = join(temporaryFolder(), "out");
  const output = execFileSync(aspic, ["run", scene, "--steps", String(steps), "--out", out], { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
  return output.match(/state +(\w+) after/)[1];
}

async function savedMesh(page, format) {
  await page.keyboard.press("Shift+M");
  const dialog = page.getByRole("dialog");
  await dialog.getByRole("combobox").first().selectOption(format);
  const file = await downloaded(page, () => dialog.getByRole("button", { name: "Save", exact: true }).click());
  await dialog.waitFor({ state: "detached" });
  return read(file);
}

test("a paused drag is saved with the scene", async () => {
  const opened = await openSession(program);
  const { page, until, close } = opened;
  await atStep(opened, 1);
  const [x, y] = await findBody(opened);
  await page.mouse.down();
  await page.mouse.move(x + 20, y - 60, { steps: 4 });
  await until("a grab", ({ state }) => state.a.grab);
  await page.waitForFunction(() => window.drawnTexts.includes("Paused: press Space to play"));
  await keepPicture(page, "paused_drag");
  await atStep(opened, 2);
  await page.mouse.move(x - 20, y - 30, { steps: 4 });
  await atStep(opened, 3);
  await page.mouse.up();
  await until("a release", ({ state }) => !state.a.grab);
  await atStep(opened, 4);
  const known = lastHash(opened);
  const file = await downloaded(page, () => page.keyboard.press("Shift+T"));
  assert.equal(file.suggestedFilename(), "cantilever.toml");
  const scene = join(temporaryFolder(), "cantilever.toml");
  writeFileSync(scene, await read(file));
  assert.match(readFileSync(scene, "utf8"), /\[\[body\.grab\]\]/);
  assert.equal(hashOfRun(scene, 4), known);
  await close();
});

test("the motion is exported for other programs", async () => {
  const opened = await openSession(program);
  const { page, close } = opened;
  for (const step of [1, 2, 3]) await atStep(opened, step);
  const exported = async (format) => {
    await page.keyboard.press("Shift+E");
    const dialog = page.getByRole("dialog");
    await dialog.getByRole("combobox").first().selectOption(format);
    const file = await downloaded(page, () => dialog.getByRole("button", { name: "Export", exact: true }).click());
    await dialog.waitFor({ state: "detached" });
    return [file.suggestedFilename(), await read(file)];
  };
  const [usdName, usd] = await exported("usd");
  assert.equal(usdName, "cantilever.usda");
  assert.ok(/^#usda 1\.0[^]*endTimeCode = 3[^]*def Camera "view"/.test(String(usd)), String(usd).slice(0, 300));
  const [glbName, glb] = await exported("glb");
  assert.equal(glbName, "cantilever.glb");
  const { meshes, cameras } = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)));
  assert.equal(meshes[0].primitives[0].targets.length, 3);
  assert.ok(Math.abs(cameras[0].perspective.yfov - Math.PI / 6) < 1e-6, JSON.stringify(cameras));
  assert.equal((await exported("pc2"))[0], "cantilever_pc2.zip");
  const [videoName, video] = await exported("video");
  assert.match(videoName, /^cantilever\.(mp4|webm)$/);
  assert.ok(video.length > 100);
  for (const step of [4, 5, 6, 7, 8]) await atStep(opened, step);
  const [gifName, gif] = await exported("gif");
  assert.equal(gifName, "cantilever.gif");
  if (process.env.ASPIC_PICTURES)
    for (const [name, file] of [["gif", gif], ["glb", glb], ["usda", usd]]) writeFileSync(join(process.env.ASPIC_PICTURES, `exported.${name}`), file);
  // The browser reads it.
  const seen = await page.evaluate(async (base64) => {
    const data = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const decoder = new ImageDecoder({ data, type: "image/gif" });
    await Promise.all([decoder.tracks.ready, decoder.completed]);
    const { frameCount } = decoder.tracks.selectedTrack;
    const { image } = await decoder.decode({ frameIndex: frameCount - 1 });
    const canvas = new OffscreenCanvas(image.displayWidth, image.displayHeight);
    canvas.getContext("2d").drawImage(image, 0, 0);
    return { frameCount, contrast: window.lookAt(canvas).contrast };
  }, gif.toString("base64"));
  assert.ok(seen.frameCount >= 2 && seen.contrast > 5, JSON.stringify(seen));
  await close();
});

test("the gallery opens and remembers a scene", async () => {
  const opened = await openSession(program);
  const { page, until, close } = opened;
  await page.keyboard.press("Shift+O");
  const dialog = page.getByRole("dialog");
  await sceneButton(page, "twist").waitFor();
  await keepPicture(page, "gallery");
  await sceneButton(page, "twist").click();
  await until("the scene", ({ scenes }) => scenes.a.name === "twist");
  await dialog.waitFor({ state: "detached" });
  await page.keyboard.press("Shift+O");
  await dialog.locator("section").filter({ hasText: "Opened before" }).getByText("twist.toml", { exact: true }).waitFor();
  await dialog.getByRole("textbox").fill(fileURLToPath(new URL("../../../scenes/cantilever.toml", import.meta.url)));
  await page.keyboard.press("Enter");
  await until("the first scene", ({ scenes }) => scenes.a.name === "cantilever");
  await close();
});

test("a dropped mesh is simulated and saved", async () => {
  const opened = await openSession(program);
  const { page, until, heard, close } = opened;
  await drop(page, [["notes.txt", "hello"]]);
  await page.locator(".notice.error").filter({ hasText: "notes.txt" }).waitFor();
  const mesh = await savedMesh(page, "msh");
  await drop(page, [["dropped.msh", mesh]]);
  await until("the mesh", ({ scenes, pictures, geometries }) => scenes.a.name === "dropped" && pictures.a.generation === geometries.a.generation);
  await keepPicture(page, "dropped");
  await atStep(opened, 1);
  await atStep(opened, 2);
  const known = lastHash(opened);
  const archive = await downloaded(page, () => page.keyboard.press("Shift+T"));
  assert.equal(archive.suggestedFilename(), "dropped.zip");
  const folder = temporaryFolder();
  writeFileSync(join(folder, "dropped.zip"), await read(archive));
  execFileSync("python3", ["-m", "zipfile", "-e", join(folder, "dropped.zip"), folder]);
  assert.equal(hashOfRun(join(folder, "dropped", "dropped.toml"), 2), known);
  const workspace = await read(await downloaded(page, () => page.keyboard.press("Shift+S")));
  const { scene, files, ...rest } = JSON.parse(workspace);
  assert.deepEqual([scene, files.map(({ name }) => name)], ["dropped.toml", ["dropped.toml", "inputs/dropped.msh"]]);
  assert.deepEqual(JSON.stringify(rest).match(/.{0,80}\/tmp\/.{0,80}/), null, "no path of this machine");
  // Simulates another machine that has only these files.
  const fresh = async (what, files) => {
    const { generation } = heard.geometries.a;
    await drop(page, files);
    await until(what, ({ scenes, state, geometries }) => scenes.a.name === "dropped" && geometries.a.generation > generation && state.a.step === 0);
    await frames(page);
    await atStep(opened, 1);
    await atStep(opened, 2);
    assert.equal(lastHash(opened), known, what);
  };
  await fresh("the archive", [["dropped.zip", readFileSync(join(folder, "dropped.zip"))]]);
  await fresh("the workspace", [["dropped.json", workspace]]);
  await close();
});

test("a falling body leaves without a blow-up", async () => {
  const falling = await startProgram("scenes/free_fall.toml", ["--set", "time.step=0.05"]);
  const opened = await openSession(falling);
  const { page, until, heard, close } = opened;
  await pressAndWait(opened, " ", "play", ({ state }) => state.playing);
  await page.getByLabel("Speed", { exact: true }).selectOption("10");
  await page.waitForFunction(() => window.drawnTexts.some((text) => /^The body has left the view/.test(text)));
  await until("a long fall", () => heard.state.a.step > 120);
  await pressAndWait(opened, " ", "a pause", ({ state }) => !state.playing);
  await page.evaluate(() => (window.drawnTexts = []));
  await atStep(opened, heard.state.a.step + 1);
  await page.waitForFunction(() => window.drawnTexts.some((text) => /left the view/.test(text)));
  await keepPicture(page, "fallen");
  assert.deepEqual(await page.evaluate(() => window.drawnTexts.filter((text) => /blown up/.test(text))), []);
  await close();
  await falling.end();
});

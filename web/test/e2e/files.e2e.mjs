// Saving and loading: workspaces, meshes, pictures, videos, recordings.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { assertSameBits, contrast, downloaded, findBody, openSession, pressAndWait, settingOf, startProgram, toTheStart } from "./harness.mjs";

const program = await startProgram("scenes/cantilever.toml");
const read = async (file) => readFileSync(await file.path());

async function loadFile({ page, until, choosers }, name, buffer) {
  const known = choosers.length;
  await page.keyboard.press("Shift+L");
  await until("a question for a file", () => choosers.length > known);
  await choosers.at(-1).setFiles({ name, mimeType: "application/json", buffer });
}

test("a workspace restores settings, comparison, camera, panels", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  const nu = page.getByLabel(/^Poisson's ratio.ν$/);
  await nu.fill("0.2");
  await nu.press("Enter");
  await until("nu", () => settingOf(heard, "material.poisson").value === 0.2);
  await page.keyboard.press("c");
  await page.getByRole("dialog").getByRole("button", { name: "Half the time step", exact: true }).click();
  await page.getByRole("dialog").getByRole("button", { name: "Compare", exact: true }).click();
  await until("side b", ({ scenes }) => scenes.b);
  await page.getByRole("dialog").waitFor({ state: "detached" });
  await page.keyboard.press("m");
  await page.keyboard.press("5"); // view from the top
  const file = await downloaded(page, () => page.keyboard.press("Shift+S"));
  assert.match(file.suggestedFilename(), /\.json$/);
  const saved = await read(file);
  const workspace = JSON.parse(saved);
  assert.equal(workspace.aspic_workspace, 1);
  assert.equal(workspace.settings["material.poisson"], 0.2);
  await pressAndWait(opened, "c", "no side b", ({ state, scenes }) => !state.b && !scenes.b);
  await nu.fill("0.35");
  await nu.press("Enter");
  await until("another nu", () => settingOf(heard, "material.poisson").value === 0.35);
  await page.keyboard.press("e");
  await page.keyboard.press("1");
  await loadFile(opened, "workspace.json", saved);
  await until("nu and side b as they were", ({ scenes }) => scenes.b && settingOf(heard, "material.poisson").value === 0.2);
  await page.locator('[role=tab][aria-selected="true"]', { hasText: "Microscope" }).waitFor();
  const again = JSON.parse(await read(await downloaded(page, () => page.keyboard.press("Shift+S"))));
  assert.deepEqual(again.page, workspace.page);
  assert.deepEqual(again.settings, workspace.settings);
  await pressAndWait(opened, "c", "no side b", ({ state, scenes }) => !state.b && !scenes.b);
  await close();
});

test("foreign files are refused", async () => {
  const opened = await openSession(program);
  const { page, heard, close } = opened;
  const files = ["not json", "[]", "{}", '{"aspic_workspace": 7}', '{"aspic_workspace": 1}', '{"aspic_workspace": 1, "scene": "/none.toml"}', '{"scene": "x", "events": [], "steps": 3}'];
  for (const [i, text] of files.entries()) {
    await loadFile(opened, `file${i}.json`, Buffer.from(text));
    await page.locator(".notice.error").filter({ hasText: `file${i}.json: ` }).waitFor();
  }
  const { step } = heard.state.a;
  await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step === step + 1);
  await close();
});

test("the deformed mesh is saved in each format", async () => {
  const opened = await openSession(program);
  const { page, heard, close } = opened;
  for (let step = 1; step <= 3; ++step) await pressAndWait(opened, "s", "a step", ({ state, pictures }) => state.a.step === step && pictures.a.step === step);
  const { vertices, tets } = heard.scenes.a;
  const save = async (format) => {
    await page.keyboard.press("Shift+M");
    const dialog = page.getByRole("dialog");
    await dialog.getByRole("combobox").first().selectOption(format);
    const file = await downloaded(page, () => dialog.getByRole("button", { name: "Save", exact: true }).click());
    await dialog.waitFor({ state: "detached" }); // takes keys
    return String(await read(file));
  };
  const points = (await save("obj")).split("\n").filter((line) => line.startsWith("v ")).map((line) => line.split(/\s+/).slice(1, 4).map(Number));
  assert.ok(points.length > 0 && points.flat().every(Number.isFinite));
  assert.ok(Math.min(...points.map(([, y, z]) => Math.min(y, z))) < -1e-4, "it sags");
  assert.match(await save("ply"), /^ply\n[^]*element vertex \d+/);
  const vtu = await save("vtu");
  assert.match(vtu, new RegExp(`NumberOfPoints="${vertices}"`));
  assert.match(vtu, new RegExp(`NumberOfCells="${tets}"`));
  assert.match(await save("msh"), /\$MeshFormat/);
  assert.match(await save("mesh"), new RegExp(`Tetrahedra\\s+${tets}`));
  await close();
});

test("the saved scene has all values", async () => {
  const { page, close } = await openSession(program);
  const text = String(await read(await downloaded(page, () => page.keyboard.press("Shift+T"))));
  assert.match(text, /poisson = /);
  assert.match(text, /\[solver\]/);
  await close();
});

test("a screenshot is a PNG of the body", async () => {
  const opened = await openSession(program);
  const { page, close } = opened;
  await findBody(opened);
  const picture = await read(await downloaded(page, () => page.keyboard.press("p")));
  assert.deepEqual([...picture.subarray(1, 4)], [..."PNG"].map((letter) => letter.charCodeAt(0)));
  assert.ok((await contrast(page, picture)) > 5);
  await close();
});

// Bytes that the encoder has delivered.
function countVideo() {
  window.videoBytes = 0;
  const { start } = MediaRecorder.prototype;
  MediaRecorder.prototype.start = function (...period) {
    this.addEventListener("dataavailable", ({ data }) => (window.videoBytes += data.size));
    return start.apply(this, period);
  };
}

test("a video of the view is recorded", async () => {
  const opened = await openSession(program, { size: [720, 560], prepare: (page) => page.addInitScript(countVideo) });
  const { page, close } = opened;
  await page.keyboard.press("Shift+V");
  await page.locator("button.recording").waitFor();
  for (let i = 0; i < 5; ++i) {
    const { step } = opened.heard.state.a;
    await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step === step + 1);
  }
  await page.locator("button.recording").filter({ hasText: /0:0[1-9]|0:[1-5]|[1-9]:/ }).waitFor();
  await page.waitForFunction(() => window.videoBytes > 2000); // an encoder may be slow
  const file = await downloaded(page, () => page.keyboard.press("Shift+V"));
  assert.match(file.suggestedFilename(), /\.(webm|mp4)$/);
  const bytes = await read(file);
  assert.ok(bytes.length > 2000, `${bytes.length} bytes`);
  if (file.suggestedFilename().endsWith("webm")) assert.deepEqual([...bytes.subarray(0, 4)], [0x1a, 0x45, 0xdf, 0xa3]);
  await close();
});

test("a recorded session repeats bit by bit", async () => {
  const opened = await openSession(program);
  const { page, heard, until, close } = opened;
  const atStep = async (step) => pressAndWait(opened, "s", `step ${step}`, ({ state, pictures }) => state.a.step === step && pictures.a.step === step);
  await atStep(1);
  const [x, y] = await findBody(opened);
  await page.mouse.down();
  await page.mouse.move(x + 20, y - 60, { steps: 4 });
  await until("a grab", ({ state }) => state.a.grab);
  await atStep(2);
  await page.mouse.move(x - 20, y - 30, { steps: 4 });
  await atStep(3);
  await page.mouse.up();
  await until("a release", ({ state }) => !state.a.grab);
  const nu = page.getByLabel(/^Poisson's ratio.ν$/);
  const before = await nu.inputValue();
  await nu.fill("0.3");
  await nu.press("Enter");
  await until("nu", () => settingOf(heard, "material.poisson").value === 0.3);
  await atStep(4);
  await atStep(5);
  const known = heard.pictures.a.positions;
  const recording = await read(await downloaded(page, () => page.keyboard.press("Shift+R")));
  assert.ok(JSON.parse(recording).events.length >= 4);
  const repeat = async (start) => {
    const reported = heard.messages.length;
    await start();
    await until("the repetition", () => heard.messages.slice(reported).some(({ kind, replaying }) => kind === "state" && replaying));
    const isNewest = ({ pictures, geometries }) => pictures.a.generation === geometries.a.generation && pictures.a.step === 5;
    await until("its end", ({ state }) => !state.replaying && state.a.step === 5 && isNewest(heard));
    assertSameBits(heard.pictures.a.positions, known);
  };
  await repeat(() => page.keyboard.press("Shift+P"));
  await toTheStart(opened);
  await pressAndWait(opened, "s", "another step", ({ state }) => state.a.step === 1);
  await repeat(() => loadFile(opened, "recording.json", recording));
  await nu.fill(before);
  await nu.press("Enter");
  await until("nu", () => String(settingOf(heard, "material.poisson").value) === before);
  await close();
});

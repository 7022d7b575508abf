// Every control of the settings: a valid value is accepted, any other is refused with a message and restored.
import assert from "node:assert/strict";
import { test } from "node:test";
import { answered, keepPicture, openSession, pressAndWait, setPlaying, settingOf, startProgram, toTheStart } from "./harness.mjs";

const program = await startProgram("scenes/cantilever.toml");
const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

// Row of a setting. Labels may repeat, keys do not.
const rowOf = (page, key) => page.locator("#right .lil-controller").filter({ has: page.locator(`.lil-name[title$="\\a ${key}"]`) });

async function backToTheScene({ page, heard, until }) {
  const from = heard.messages.length;
  await page.keyboard.press("Shift+O");
  await page.getByRole("dialog").getByRole("button", { name: "Load", exact: true }).click();
  await page.getByRole("dialog").waitFor({ state: "detached" });
  await until("the scene", () => heard.messages.slice(from).some(({ kind }) => kind === "scene"));
}

// Opens every folder.
async function openSettings() {
  const opened = await openSession(program);
  const closed = opened.page.locator("#right .lil-closed > .lil-title");
  await closed.evaluateAll((titles) => titles.forEach((title) => title.click()));
  await opened.until("open folders", async () => (await closed.count()) === 0);
  return opened;
}

const isAbout = (key) => (message) => message.do === "set" && message.key === key;
const set = (opened, key, act) => answered(opened, key, isAbout(key), act);

// Another value from the middle of the slider's range.
function otherNumber({ kind, value, min, max, log }) {
  const between = (t) => (log && min > 0 ? min * (max / min) ** t : min + t * (max - min));
  const shown = (t) => (kind === "integer" ? Math.round(between(t)) : Number(between(t).toPrecision(3)));
  const other = [0.4, 0.6, 0.2, 0.8, 1].map(shown).find((number) => number !== value);
  assert.notEqual(other, undefined);
  return other;
}

async function typeInto(field, text) {
  await field.fill(text);
  await field.press("Enter");
}

test("every setting accepts another value", async () => {
  const opened = await openSettings();
  const { page, heard, close } = opened;
  const settings = heard.scenes.a.settings;
  assert.ok(settings.length > 20, `${settings.length} settings`);
  for (const { key } of settings) {
    const setting = settingOf(heard, key);
    if (!setting) continue; // belongs to a choice made before
    const row = rowOf(page, key);
    const context = `${key} (${setting.kind})`;
    assert.equal(await row.count(), 1, context);
    await row.evaluate((element) => element.closest(".lil-gui.lil-closed")?.querySelector(".lil-title").click());
    let [wanted, answer] = [null, null];
    if (setting.kind === "number" || setting.kind === "integer") {
      wanted = otherNumber(setting);
      answer = await set(opened, key, () => typeInto(row.locator("input[type=text]").first(), String(wanted)));
    } else if (setting.kind === "vector") {
      wanted = setting.value.map((entry, i) => (i === 0 ? Number(entry) + 1 : entry));
      answer = await set(opened, key, () => typeInto(row.locator("input[type=text]").first(), String(wanted[0])));
    } else if (setting.kind === "choice") {
      wanted = setting.choices.find((choice) => choice !== setting.value);
      assert.ok(wanted !== undefined, context);
      answer = await set(opened, key, () => row.locator("select").selectOption(wanted));
    } else if (setting.kind === "switch") {
      wanted = !setting.value;
      answer = await set(opened, key, () => row.locator("input[type=checkbox]").click());
    } else {
      wanted = String(setting.value);
      answer = await set(opened, key, () => typeInto(row.locator("input[type=text]").first(), "2 * (1 + X)"));
    }
    if (answer.kind === "refused") {
      assert.ok(answer.why.length > 15, `${context}: refused with a message, not by '${answer.why}'`);
      await page.locator(".notice.error").first().waitFor();
      assert.ok(same(settingOf(heard, key).value, setting.value), `${context}: refused and changed`);
    } else if (setting.kind !== "text") {
      assert.ok(same(settingOf(heard, key)?.value, wanted), `${context}: ${JSON.stringify(wanted)} became ${JSON.stringify(settingOf(heard, key)?.value)}`);
    }
  }
  await backToTheScene(opened);
  assert.deepEqual(heard.scenes.a.settings, settings, "loading the scene brings every setting back");
  await close();
});

test("the material's energy density follows its choice", async () => {
  const { page, close } = await openSettings();
  const density = page.getByLabel("Strain energy density");
  const shown = await density.textContent();
  assert.match(shown, /ψ/);
  await rowOf(page, "material.model").locator("select").selectOption("stvk");
  await page.waitForFunction((before) => document.querySelector('[aria-label="Strain energy density"]').textContent !== before, shown);
  assert.match(await density.textContent(), /ψ[^]*E/);
  await keepPicture(page, "density");
  await close();
});

test("every slider follows the keyboard", async () => {
  const opened = await openSettings();
  const { page, heard, close } = opened;
  for (const { key, kind } of heard.scenes.a.settings.filter((setting) => setting.kind === "number" || setting.kind === "integer")) {
    const setting = settingOf(heard, key);
    if (!setting || typeof setting.value !== "number") continue;
    const slider = rowOf(page, key).locator("input[type=range]");
    const key_ = Number(await slider.inputValue()) >= 500 ? "ArrowLeft" : "ArrowRight";
    const answer = await set(opened, key, () => slider.press(key_));
    const now = settingOf(heard, key)?.value;
    if (answer.kind === "reply") assert.notEqual(now, setting.value, `${key} (${kind}): ${key_} moves it`);
    else assert.ok(answer.why.length > 15, key);
  }
  await backToTheScene(opened);
  await close();
});

test("every choice is accepted or refused", async () => {
  const opened = await openSettings();
  const { page, heard, until, close } = opened;
  for (const { key, choices, value: first } of heard.scenes.a.settings.filter(({ kind }) => kind === "choice")) {
    for (const value of [...choices.filter((choice) => choice !== first), first]) {
      if (settingOf(heard, key).value === value) continue;
      const answer = await set(opened, key, () => rowOf(page, key).locator("select").selectOption(value));
      if (answer.kind === "refused") {
        assert.ok(answer.why.length > 15, `${key} = ${value}`);
        continue;
      }
      assert.equal(settingOf(heard, key).value, value);
      const { step } = heard.state.a;
      await page.keyboard.press("s");
      await until(`a step with ${key} = ${value}`, () => heard.state.a.step === step + 1 && heard.state.a.status !== "");
    }
  }
  await toTheStart(opened);
  await close();
});

test("wrong input is refused and restored", async () => {
  const opened = await openSettings();
  const { page, heard, until, close } = opened;
  for (const { key } of heard.scenes.a.settings.filter(({ kind }) => ["number", "integer", "vector"].includes(kind))) {
    const setting = settingOf(heard, key);
    const field = rowOf(page, key).locator("input[type=text]").first();
    const before = await field.inputValue();
    for (const typed of ["nan", "1e400", "-1e30", "", "text", "[1, 2]", "9".repeat(400)]) {
      const asked = heard.sent.length;
      const from = heard.messages.length;
      const sent = () => heard.sent.slice(asked).map((text) => JSON.parse(text)).find(isAbout(key));
      await typeInto(field, typed);
      // A field that restores an invalid value sends nothing.
      await until(`${key} = '${typed}'`, async () => sent() || (await field.inputValue()) === before);
      if (!sent()) continue;
      const answer = await until(`an answer to ${key} = '${typed}'`, () => heard.messages.slice(from).find(({ id }) => id === sent().id));
      if (answer.kind === "refused") {
        assert.ok(answer.why.length > 15, `${key} = '${typed}': ${answer.why}`);
        await page.waitForFunction(
          ([title, text]) => [...document.querySelectorAll("#right .lil-name")].find((name) => name.title.endsWith(title))?.parentElement.querySelector("input[type=text]").value === text,
          [`\n${key}`, before],
        );
        assert.ok(same(settingOf(heard, key).value, setting.value));
      } else {
        // Undoes an extreme but valid value.
        await typeInto(field, before);
        await until(`${key} is back`, () => same(settingOf(heard, key).value, setting.value));
      }
    }
  }
  const { step } = heard.state.a;
  await pressAndWait(opened, "s", "a step", () => heard.state.a.step === step + 1);
  await close();
});

test("extreme values never stop the program", async () => {
  const opened = await openSettings();
  const { page, heard, until, close } = opened;
  await setPlaying(opened, true);
  for (const setting of heard.scenes.a.settings.filter(({ kind, value }) => kind === "number" && typeof value === "number")) {
    for (const value of [setting.min, setting.max, setting.value]) {
      if (settingOf(heard, setting.key).value === value) continue;
      await set(opened, setting.key, () => typeInto(rowOf(page, setting.key).locator("input[type=text]"), String(value)));
    }
  }
  const { step } = heard.state.a;
  await setPlaying(opened, true);
  await until("further steps", () => heard.state.a.step > step || heard.state.a.status !== "");
  await toTheStart(opened);
  await pressAndWait(opened, "s", "a step", () => heard.state.a.step === 1 && heard.state.a.words === null);
  await close();
});

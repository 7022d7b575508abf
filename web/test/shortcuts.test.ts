import assert from "node:assert/strict";
import { test } from "node:test";
import { Page } from "../src/page";
import { keyName, pressedKey } from "../src/shortcuts";

test("key names include Shift where the character stays", () => {
  assert.equal(pressedKey({ key: "s", shiftKey: false }), "s");
  assert.equal(pressedKey({ key: "S", shiftKey: true }), "Shift+S");
  assert.equal(pressedKey({ key: "S", shiftKey: false }), "s", "caps lock");
  assert.equal(pressedKey({ key: "?", shiftKey: true }), "?");
  assert.equal(pressedKey({ key: "ArrowLeft", shiftKey: true }), "Shift+ArrowLeft");
});

test("two shortcuts on one key throw", () => {
  const page = new Page();
  const shortcut = { key: "s", does: "One thing", group: "File", run: () => {} } as const;
  page.shortcut(shortcut);
  assert.throws(() => page.shortcut(shortcut), /two shortcuts on s/);
});

test("keys have their names on a keyboard", () => {
  assert.equal(keyName(" "), "Space");
  assert.equal(keyName("s"), "S");
  assert.equal(keyName("Shift+S"), "Shift+S");
  assert.equal(keyName("Shift+ArrowLeft"), "Shift+Left");
});

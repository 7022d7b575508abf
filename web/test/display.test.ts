import assert from "node:assert/strict";
import { test } from "node:test";
import type { Field, Scene } from "../src/protocol";
import { coarseBox } from "../src/view/body";
import { Display, kDefaults } from "../src/view/display";

const kStress: Field = { name: "von_mises", label: "von Mises stress", unit: "Pa", diverging: false, center: 0, log: false };
const kDet: Field = { name: "det_F", label: "det F", unit: "", diverging: true, center: 1, log: false };
const kYoung: Field = { name: "young", label: "E", unit: "Pa", diverging: false, center: 0, log: true };

test("settings are restored from what was saved", () => {
  const display = new Display();
  display.change({ wires: false, brush: 60, clip: "y", bodyColor: "#123456" });
  const other = new Display();
  other.restore(JSON.parse(JSON.stringify(display.save())));
  assert.deepEqual(other.settings, display.settings);
});

test("invalid saved settings are ignored", () => {
  const display = new Display();
  for (const saved of [null, 7, "x", { clip: "w" }, { bodyColor: "red" }, { wires: "yes" }, { constructor: 1 }, { low: null }]) display.restore(saved);
  assert.deepEqual(display.settings, kDefaults);
  display.restore({ brush: 1e9, shininess: -5 });
  assert.equal(display.settings.brush, 200);
  assert.equal(display.settings.shininess, 0);
});

test("another field starts another range", () => {
  const display = new Display();
  display.feed("a", kStress, 0, 1e6);
  display.feed("a", kDet, 0.9, 1.3);
  assert.deepEqual(display.range(kDet), { low: 0.7, high: 1.3, log: false });
});

test("a fixed range accepts either order", () => {
  const display = new Display();
  display.feed("a", kStress, 0, 10);
  display.change({ fixedRange: true, low: 5, high: 2 });
  assert.deepEqual(display.range(kStress), { low: 2, high: 5, log: false });
});

test("stiffness has a logarithmic scale by default", () => {
  const display = new Display();
  display.feed("a", kYoung, 1e3, 1e5);
  assert.deepEqual(display.range(kYoung), { low: 1e3, high: 1e5, log: true });
  display.change({ scale: "linear" });
  assert.deepEqual(display.range(kYoung), { low: 1e3, high: 1e5, log: false });
  display.change({ scale: "auto" });
  display.feed("a", kStress, 1, 10);
  assert.equal(display.range(kStress)?.log, false);
  display.change({ scale: "log" });
  assert.equal(display.range(kStress)?.log, true);
});

test("unlinked cameras start at the common view", () => {
  const display = new Display();
  assert.equal(display.camera("b"), display.camera("a"));
  display.cameras.a.turn(30, 10);
  display.change({ linked: false });
  assert(display.camera("b") !== display.camera("a"));
  assert.deepEqual(display.camera("b").lens(10, 10), display.camera("a").lens(10, 10));
});

test("the cut keeps the chosen half", () => {
  const display = new Display();
  const scene = { lower: [0, 0, 0], upper: [4, 8, 2] } as unknown as Scene;
  assert.equal(display.clip(scene), null);
  display.change({ clip: "y", clipAt: 0.25 });
  assert.equal(display.clip(scene)?.offset, -2);
  display.change({ clipOther: true });
  assert.equal(display.clip(scene)?.offset, 2);
});

test("the box ignores infinite positions", () => {
  const box = coarseBox(new Float32Array([0, 1, 2, NaN, 5, Infinity, -1, 3, 4]));
  assert.deepEqual(box, { lower: [-1, 1, 2], upper: [0, 5, 4] });
  assert.equal(coarseBox(new Float32Array([NaN, NaN, NaN])), null);
});

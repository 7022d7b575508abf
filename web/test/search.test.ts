import assert from "node:assert/strict";
import { test } from "node:test";
import { alphaRange, searchRange } from "../src/plots/search";

const trial = (
  alpha: number,
  accepted: boolean,
): { alpha: number; value: number; bound: number; accepted: boolean } => ({ alpha, value: 0, bound: 0, accepted });

test("the axis shows the valley, not the wall", () => {
  const [low, high] = searchRange([0, -1, 1e6, null], [0, -1.1], [1e9, -1]);
  assert.ok(low < -1 && low > -2.5);
  assert.ok(high > 0.2 && high < 5);
});

test("an unbounded model does not stretch the axis", () => {
  assert.ok(searchRange([0, -1], [0, -1e9], [-1])[0] > -3);
});

test("a rising curve has a range", () => {
  const [low, high] = searchRange([0, 2, 5], [0, 2, 4], []);
  assert.ok(low < 0 && high >= 1 && Number.isFinite(high));
  assert.ok(searchRange([0, 0], [0, 0], [])[1] > 0);
});

test("a short accepted trial narrows the axis", () => {
  const near = Array.from({ length: 40 }, (_, i) => -0.005 + i * 0.001);
  const trials = [trial(1, false), trial(0.01, true)];
  assert.deepEqual(alphaRange([...near, 0.5, 1.25], trials), [-0.005, 0.03]);
  assert.deepEqual(alphaRange([-0.25, 0, 0.5, 1.25], trials), [-0.25, 1.25]);
  assert.deepEqual(alphaRange([-0.25, 0, 1.25], [trial(1, true)]), [-0.25, 1.25]);
});

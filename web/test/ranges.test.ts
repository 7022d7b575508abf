import assert from "node:assert/strict";
import { test } from "node:test";
import { colorAt, kMapNames, mapTexels } from "../src/view/colorMaps";
import { about, fraction, logRange, logTicks, RunningRange, ticks } from "../src/view/ranges";

const luminance = ([r, g, b]: number[]): number => {
  const linear = [r, g, b].map((c) => (c / 255) ** 2.2);
  return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
};

test("a removed side leaves the other's range", () => {
  const range = new RunningRange();
  range.feed("a", 0, 5);
  range.feed("b", -1e30, 1e30);
  range.forget("b");
  assert.deepEqual(range.get(), { low: 0, high: 5 });
  range.forget("a");
  assert.deepEqual(range.get(), { low: 0, high: 5 });
});

test("ticks are round, inside, of requested number", () => {
  assert.deepEqual(ticks(0, 10, 5), [0, 2, 4, 6, 8, 10]);
  assert.deepEqual(ticks(-0.13, 0.31, 4), [0, 0.2]);
  for (const [low, high] of [[1e-7, 3e-7], [-5e9, 4e9], [0.999, 1.001]]) {
    const found = ticks(low, high, 6);
    assert(found.length >= 3 && found.length <= 8, `${found}`);
    for (const tick of found) assert(tick >= low - 1e-9 * (high - low) && tick <= high + 1e-9 * (high - low));
  }
});

test("an empty range has one tick", () => {
  assert.deepEqual(ticks(2, 2, 5), [2]);
  assert.deepEqual(ticks(NaN, 1, 5), []);
  assert.deepEqual(ticks(-Infinity, Infinity, 5), []);
});

test("logarithmic ticks are powers of ten", () => {
  assert.deepEqual(logTicks(1, 1000), [1, 10, 100, 1000]);
  assert.deepEqual(logTicks(1, 50), [1, 2, 5, 10, 20, 50]);
  assert.deepEqual(logTicks(20.1, 38.5), [25, 30, 35]);
  assert.deepEqual(logTicks(-1, 10), []);
});

test("a running range grows at once, shrinks slowly", () => {
  const range = new RunningRange();
  range.feed("a", 0, 10);
  range.feed("b", 5, 20);
  assert.deepEqual(range.get(), { low: 0, high: 20 });
  range.feed("b", 5, 12);
  const shrunk = range.get();
  assert(shrunk && shrunk.high < 20 && shrunk.high > 19);
  for (let k = 0; k < 500; ++k) range.feed("b", 5, 12);
  assert(Math.abs(range.get()!.high - 12) < 1e-3);
});

test("infinite values do not change a range", () => {
  const range = new RunningRange();
  assert.equal(range.get(), null);
  range.feed("a", 1, 2);
  range.feed("a", NaN, 3);
  range.feed("a", -Infinity, 3);
  range.feed("a", 9, 3);
  assert.deepEqual(range.get(), { low: 1, high: 2 });
});

test("a diverging range is centered", () => {
  assert.deepEqual(about(1, 0.9, 1.5), { low: 0.5, high: 1.5 });
});

test("a logarithmic range needs a positive value", () => {
  assert.equal(logRange(-2, 0), null);
  assert.deepEqual(logRange(0, 1), { low: 1e-9, high: 1 });
  assert.equal(fraction({ low: 1, high: 100, log: true }, 10), 0.5);
  assert.equal(fraction({ low: 3, high: 3, log: false }, 3), 0.5);
});

test("lightness of color maps is monotone or symmetric", () => {
  for (const map of kMapNames) {
    const light = Array.from({ length: 65 }, (_, i) => luminance(colorAt(map, i / 64)));
    for (let i = 1; i < 65; ++i) {
      const rises = map !== "blue_orange" || i <= 32;
      assert(rises ? light[i] > light[i - 1] : light[i] < light[i - 1], `${map} at ${i}`);
    }
  }
});

test("texels are the map's colors, clamped outside", () => {
  const texels = mapTexels("viridis", 256);
  assert.deepEqual([...texels.slice(0, 4)], [0x44, 0x01, 0x54, 255]);
  assert.deepEqual([...texels.slice(-4)], [0xfd, 0xe7, 0x25, 255]);
  assert.deepEqual(colorAt("viridis", -3), colorAt("viridis", 0));
  assert.deepEqual(colorAt("viridis", 7), colorAt("viridis", 1));
});

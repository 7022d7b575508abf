import assert from "node:assert/strict";
import { test } from "node:test";
import {
  clipped,
  gridOf,
  heightOf,
  heightRange,
  isInside,
  minimizerOf,
  quadraticAt,
  quadraticFrom,
  sample,
  uniform,
  valueAtHeight,
  type Quadratic,
} from "../src/plots/grid";

const square = { x: uniform(-1, 1, 5), y: uniform(0, 2, 3), value: [] };
const filled = (
  f: (x: number, y: number) => number | null,
): { x: number[]; y: number[]; value: (number | null)[] } => ({
  ...square,
  value: square.y.flatMap((y) => square.x.map((x) => f(x, y))),
});

test("a wall flattens no valley, hides no marks", () => {
  const valley = Array.from({ length: 1000 }, (_, i) => i / 1000);
  assert.deepEqual(heightRange(valley), { low: 0, high: 0.999, cut: false });
  const wall = heightRange([...valley, 1e9, 1e12, null]);
  assert.ok(wall.cut && wall.high < 3 && wall.low === 0);
  assert.ok(heightRange([...valley, 1e9], [50]).high > 50);
  assert.ok(heightRange(valley, [-1]).low === -1);
});

test("constant and empty grids have heights", () => {
  const flat = heightRange([5, 5, 5]);
  assert.ok(flat.high > flat.low);
  assert.deepEqual(heightRange([null, null]), { low: 0, high: 1, cut: false });
});

test("heights invert to values on both scales", () => {
  const range = { low: -2, high: 8, cut: false };
  for (const scale of ["linear", "log"] as const)
    for (const height of [0, 0.1, 0.5, 1])
      assert.ok(Math.abs(heightOf(range, scale)(valueAtHeight(range, scale)(height)) - height) < 1e-12);
  assert.equal(heightOf(range, "log")(8), 1);
  assert.ok(heightOf(range, "log")(-2 + 0.1) > 0.4);
});

test("sampling is exact for bilinear functions inside", () => {
  const grid = filled((x, y) => 1 + x + 2 * y + 3 * x * y);
  assert.ok(Math.abs(sample(grid, 0.3, 1.7)! - (1 + 0.3 + 3.4 + 1.53)) < 1e-12);
  assert.equal(sample(grid, 1.01, 1), null);
  assert.equal(sample(grid, Number.NaN, 1), null);
  const holed = filled((x, y) => (x === 0 && y === 1 ? null : x));
  assert.equal(sample(holed, 0.2, 0.9), null);
  assert.equal(sample(holed, 0.7, 0.9), 0.7);
});

test("samples determine a quadratic and its minimum", () => {
  const q: Quadratic = { center: [0.5, -1], value: 3, gradient: [1, -2], xx: 4, xy: 1, yy: 2 };
  const found = quadraticFrom(filled((x, y) => quadraticAt(q, x, y)))!;
  for (const [x, y] of [
    [0, 0],
    [0.3, 1.9],
    [-5, 7],
  ] as const)
    assert.ok(Math.abs(quadraticAt(found, x, y) - quadraticAt(q, x, y)) < 1e-9);
  const [p, lowest] = [minimizerOf(found)!, minimizerOf(q)!];
  assert.ok(Math.hypot(p.x - lowest.x, p.y - lowest.y) < 1e-9);
  assert.ok(quadraticAt(q, lowest.x, lowest.y) < quadraticAt(q, lowest.x + 0.01, lowest.y - 0.02));
});

test("saddles, troughs and hills have no minimum", () => {
  const q: Quadratic = { center: [0, 0], value: 0, gradient: [1, 1], xx: 1, xy: 0, yy: 1 };
  assert.equal(minimizerOf({ ...q, yy: -1 }), null);
  assert.equal(minimizerOf({ ...q, yy: 0 }), null);
  assert.equal(minimizerOf({ ...q, xy: 1 }), null);
  assert.equal(quadraticFrom(filled(() => null)), null);
});

test("segments are clipped at the picture's edge", () => {
  assert.deepEqual(clipped(square, { x: 0, y: 1 }, { x: 4, y: 1 }), [
    { x: 0, y: 1 },
    { x: 1, y: 1 },
  ]);
  assert.equal(clipped(square, { x: 2, y: 0 }, { x: 3, y: 1 }), null);
  assert.equal(clipped(square, { x: -3, y: 5 }, { x: 3, y: 5 }), null);
  assert.deepEqual(clipped(square, { x: 0.5, y: 0.5 }, { x: 0.5, y: 0.5 }), [
    { x: 0.5, y: 0.5 },
    { x: 0.5, y: 0.5 },
  ]);
  assert.ok(isInside(square, { x: 1, y: 2 }) && !isInside(square, { x: 1, y: 2.1 }));
});

test("slices accept coordinates per line or sample", () => {
  const slice = { columns: 2, rows: 3, s: [0, 1], t: [5, 6, 7], value: [], model: [] };
  const spread = { ...slice, s: [0, 1, 0, 1, 0, 1], t: [5, 5, 6, 6, 7, 7] };
  assert.deepEqual(gridOf(slice), { x: [0, 1], y: [5, 6, 7], value: [] });
  assert.deepEqual(gridOf(spread), gridOf(slice));
});

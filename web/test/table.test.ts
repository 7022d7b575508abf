import assert from "node:assert/strict";
import { test } from "node:test";
import { lowerBound, magnitude, merged, nearest, thinned } from "../src/plots/table";

test("thinning keeps extremes in two rows per bucket", () => {
  const x = Array.from({ length: 20000 }, (_, i) => i);
  const spike = x.map((i) => (i === 7777 ? 100 : i === 12345 ? -50 : Math.sin(i)));
  const thin = thinned({ x, columns: [spike, x] }, 0, x.length, 500);
  assert.ok(thin.x.length <= 1000);
  assert.equal(Math.max(...(thin.columns[0] as number[])), 100);
  assert.equal(Math.min(...(thin.columns[0] as number[])), -50);
  assert.deepEqual([thin.columns[1]![0], thin.columns[1]!.at(-1)], [0, 19999]);
  assert.ok(thin.x.every((value, i) => i === 0 || value > thin.x[i - 1]!));
});

test("a short table is not thinned", () => {
  assert.deepEqual(thinned({ x: [1, 2, 3], columns: [[4, null, 6]] }, 1, 3, 10), { x: [2, 3], columns: [[null, 6]] });
});

test("a bucket without values stays empty", () => {
  const x = Array.from({ length: 100 }, (_, i) => i);
  const thin = thinned({ x, columns: [x.map(() => null)] }, 0, 100, 4);
  assert.ok(thin.columns[0]!.every((value) => value === null));
});

test("tables merge over the union of x", () => {
  const both = merged({ x: [1, 2, 3], columns: [[10, 20, 30]] }, { x: [1.5, 2], columns: [[1, 2]] });
  assert.deepEqual(both, {
    x: [1, 1.5, 2, 3],
    columns: [
      [10, null, 20, 30],
      [null, 1, 2, null],
    ],
  });
});

test("lower bound finds rows by x", () => {
  assert.equal(lowerBound([1, 2, 2, 3], 2), 1);
  assert.equal(lowerBound([], 2), 0);
  assert.equal(nearest([0, 1, 2], 1.6), 2);
  assert.equal(nearest([0, 1, 2], -5), 0);
  assert.equal(nearest([0, 1, 2], 9), 2);
});

test("a logarithmic axis omits zero", () => {
  assert.equal(magnitude(0), null);
  assert.equal(magnitude(-3), 3);
  assert.equal(magnitude(null), null);
});

// The part of a landscape that contact blocks, and the mark of the largest step.
import assert from "node:assert/strict";
import { test } from "node:test";
import { uniform } from "../src/plots/grid";
import { limitText } from "../src/plots/search";
import { blockedGeometry, Frame } from "../src/plots/surfaceParts";

test("blocked samples cover their cells from below", () => {
  const grid = { x: uniform(0, 1, 4), y: uniform(0, 1, 3), value: Array.from({ length: 12 }, () => 1) };
  const frame = new Frame(grid, { low: 0, high: 1, cut: false }, "linear", 1);
  const cells = (samples: number[]): number => (blockedGeometry(frame, samples).getAttribute("position")?.count ?? 0) / 6;
  assert.equal(cells([]), 0);
  assert.equal(cells([0]), 1, "a corner of the grid");
  assert.equal(cells([5]), 4, "an inner sample");
  assert.equal(cells([3, 7, 11]), 2, "an edge of the grid");
  const positions = blockedGeometry(frame, [11]).getAttribute("position");
  for (let i = 0; i < positions.count; ++i) {
    assert.ok(positions.getY(i) < 0);
    assert.ok(positions.getX(i) >= frame.across(2 / 3) - 1e-6 && positions.getZ(i) <= frame.away(0.5) + 1e-6);
  }
});

test("the mark of the largest step names contact", () => assert.equal(limitText(3e-7), "contact: α ≤ 3e−7"));

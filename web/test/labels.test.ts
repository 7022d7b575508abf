import assert from "node:assert/strict";
import { test } from "node:test";
import { apart } from "../src/view/labels";

const box = (x: number, y: number): { x: number; y: number; width: number; height: number } => ({ x, y, width: 100, height: 14 });

test("only overlapping texts move apart", () => {
  const placed = apart([box(10, 50), box(20, 52), box(15, 55), box(300, 51), box(40, 200)], 7, 393);
  for (const p of placed)
    for (const q of placed) {
      const across = p.x >= q.x + q.width || q.x >= p.x + p.width;
      assert.ok(p === q || across || Math.abs(p.y - q.y) >= 14, `${p.y} ${q.y}`);
    }
  assert.equal(placed.find((p) => p.x === 300)!.y, 51);
  assert.equal(placed.find((p) => p.x === 40)!.y, 200);
});

test("at the lower edge texts move up", () => {
  const placed = apart([box(0, 90), box(0, 95), box(0, 99)], 7, 93);
  assert.ok(placed.every((p) => p.y >= 7 && p.y <= 93));
  assert.equal(new Set(placed.map((p) => Math.round(p.y))).size, 3);
});

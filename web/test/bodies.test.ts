import assert from "node:assert/strict";
import { test } from "node:test";
import { bodiesOf, bodyColors, bodyTexels } from "../src/view/bodies";
import { wiresOf } from "../src/view/body";
import type { Geometry } from "../src/protocol";

const geometry = (tet: number[]): Parameters<typeof bodiesOf>[0] => ({
  rest: new Float32Array(9 * tet.length),
  triangles: Uint32Array.from({ length: 3 * tet.length }, (_, i) => i),
  tet: Uint32Array.from(tet),
});

test("each vertex belongs to its tet's body", () => {
  assert.deepEqual([...bodiesOf(geometry([0, 9, 10, 25]), [0, 10, 20])], [0, 0, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2]);
  assert.deepEqual([...bodiesOf(geometry([3]), [])], [0, 0, 0]);
});

test("two bodies have two colors, first the reader's", () => {
  const colors = bodyColors("#4f8fd0", 8);
  assert.equal(colors[0], "#4f8fd0");
  for (const tissue of [false, true]) assert.equal(new Set(bodyColors("#4f8fd0", 5, tissue)).size, 5);
  assert.equal(new Set(colors).size, 8);
  assert.deepEqual([...bodyTexels(["#010203", "#ff8000"])], [1, 2, 3, 255, 255, 128, 0, 255]);
});

test("of the tube of a rod only cross sections are drawn", () => {
  const triangles = Uint32Array.of(0, 1, 2, 3, 4, 6); // of a sheet, and of a rod between its vertices 7 and 8
  const vertex = Uint32Array.of(0, 1, 2, 7, 7, 8, 8);
  const edges = Uint32Array.of(0, 1, 3, 4, 4, 6, 5, 6);
  const geometry = { triangles, edges, vertex, tet: Uint32Array.of(5, 6) } as unknown as Geometry;
  assert.deepEqual([...wiresOf(geometry, 6)], [0, 1, 3, 4, 5, 6]);
  assert.deepEqual([...wiresOf(geometry, Infinity)], [...edges]);
});

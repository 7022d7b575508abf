import assert from "node:assert/strict";
import { test } from "node:test";
import type { Geometry } from "../src/protocol";
import { borderOf, halfThickness, ThickSheets } from "../src/view/thickSheets";

const kUp = [0, 0, 127, 0];

function shown(triangles: number[], positions: number[], normals: number[], half = 0.1): ThickSheets {
  const solid = new ThickSheets(Uint32Array.from(triangles), new Float32Array(positions.length / 3).fill(half));
  solid.show({ positions: Float32Array.from(positions), normals: Int8Array.from(normals) });
  return solid;
}

// Volume inside triangles that point outward.
function volume({ triangles, positions }: ThickSheets): number {
  let sum = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => [...positions.subarray(3 * triangles[t + k], 3 * triangles[t + k] + 3)]);
    sum += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
  }
  return sum;
}

const kSquare = [0, 0, 5, 2, 0, 5, 2, 1, 5, 0, 1, 5];

test("a rectangle becomes a closed box of its thickness", () => {
  const solid = shown([0, 1, 2, 0, 2, 3], kSquare, [kUp, kUp, kUp, kUp].flat());
  assert.ok(Math.abs(volume(solid) - 2 * 1 * 0.2) < 1e-6, String(volume(solid)));
  const places = Array.from(solid.triangles, (p) => [...solid.positions.subarray(3 * p, 3 * p + 3)].join());
  const names = [...new Set(places)];
  assert.deepEqual([names.length, borderOf(places.map((place) => names.indexOf(place)), names.length)], [8, []]);
  const ofWalls = Array.from({ length: 16 }, (_, i) => [...solid.normals.subarray(4 * (8 + i), 4 * (8 + i) + 3)]);
  assert.deepEqual(new Set(ofWalls.map(String)), new Set(["0,-127,0", "127,0,0", "0,127,0", "-127,0,0"]));
});

test("three triangles at an edge, normals of length 0 and NaN are drawn", () => {
  const positions = [...kSquare, NaN, 0, 6];
  const solid = shown([0, 1, 2, 0, 2, 3, 0, 2, 4], positions, [kUp, [0, 0, 0, 0], kUp, kUp, kUp].flat());
  assert.equal(solid.triangles.length, 3 * (2 * 3 + 2 * 6));
  assert.deepEqual([...solid.positions.subarray(3, 6)], [2, 0, 5]);
});

test("values and wires are those of both sides, solids stay", () => {
  const geometry = { rest: new Float32Array(18), triangles: Uint32Array.of(0, 1, 2, 3, 4, 5), tet: Uint32Array.of(0, 7) } as Geometry;
  const elements = { body_tets: [0, 7], tets: 7, triangles: 1, thickness: [0, 0.5] };
  const half = halfThickness(geometry, elements);
  assert.deepEqual(half && [...half], [0, 0, 0, 0.25, 0.25, 0.25]);
  assert.equal(halfThickness(geometry, { ...elements, thickness: undefined }), null);
  const solid = new ThickSheets(geometry.triangles, half!);
  assert.deepEqual([...solid.bothSides(Uint32Array.of(0, 1, 3, 4))], [0, 1, 3, 4, 6, 7]);
  assert.deepEqual([...solid.values(Float32Array.of(0, 1, 2, 3, 4, 5))].slice(0, 9), [0, 1, 2, 3, 4, 5, 3, 4, 5]);
});

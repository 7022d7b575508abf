import assert from "node:assert/strict";
import { test } from "node:test";
import type { Geometry, Vec3 } from "../src/protocol";
import { CameraRig } from "../src/view/cameras";
import { chooseLabels } from "../src/view/labels";
import { length, minus, project, rayThrough } from "../src/view/lens";
import { interpolated, nearestVertex, pick, screenPositions, verticesInStroke } from "../src/view/picking";

// A unit sphere of rings; its poles are vertices 0 and 1.
function sphere(rings: number, around: number): { positions: Float32Array; triangles: Uint32Array } {
  const points: number[] = [0, 1, 0, 0, -1, 0];
  for (let i = 1; i < rings; ++i)
    for (let j = 0; j < around; ++j) {
      const [a, b] = [(Math.PI * i) / rings, (2 * Math.PI * j) / around];
      points.push(Math.sin(a) * Math.cos(b), Math.cos(a), Math.sin(a) * Math.sin(b));
    }
  const at = (i: number, j: number): number => (i === 0 ? 0 : i === rings ? 1 : 2 + (i - 1) * around + (j % around));
  const triangles: number[] = [];
  for (let i = 0; i < rings; ++i)
    for (let j = 0; j < around; ++j) {
      if (i > 0) triangles.push(at(i, j), at(i, j + 1), at(i + 1, j));
      if (i < rings - 1) triangles.push(at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    }
  return { positions: new Float32Array(points), triangles: new Uint32Array(triangles) };
}

const kBall = sphere(24, 32);

function frontCamera(orthographic = false): CameraRig {
  const rig = new CameraRig();
  rig.show("ball", [-1, -1, -1], [1, 1, 1], [0, 1, 0]);
  rig.setView("front");
  rig.setOrthographic(orthographic);
  return rig;
}

test("picks the nearest triangle with its weights", () => {
  for (const orthographic of [false, true]) {
    const lens = frontCamera(orthographic).lens(400, 400);
    const hit = pick(rayThrough(lens, 215, 190), kBall.positions, kBall.triangles, null);
    assert(hit);
    assert(hit.point[2] > 0.9, "the side that faces the camera");
    const point = [0, 1, 2].map((c) => interpolated(hit, kBall.triangles, kBall.positions.filter((_, i) => i % 3 === c)));
    assert(length(minus(point as Vec3, hit.point)) < 1e-6);
    assert(Math.abs(hit.weights.reduce((a, b) => a + b) - 1) < 1e-12);
    const [x, y] = project(lens, hit.point);
    assert(Math.hypot(x - 215, y - 190) < 1e-6);
  }
});

test("picks nothing beside the body", () => {
  const lens = frontCamera().lens(400, 400);
  assert.equal(pick(rayThrough(lens, 5, 5), kBall.positions, kBall.triangles, null), null);
});

test("picks the far wall behind a cut", () => {
  const lens = frontCamera().lens(400, 400);
  const clip = { normal: [0, 0, -1] as Vec3, offset: 0 }; // keeps z <= 0
  const hit = pick(rayThrough(lens, 200, 200), kBall.positions, kBall.triangles, clip);
  assert(hit && hit.point[2] < -0.9);
});

test("ignores infinite and degenerate triangles", () => {
  const positions = kBall.positions.slice();
  positions.fill(NaN, 0, 60);
  positions.fill(0, 60, 90);
  const lens = frontCamera().lens(400, 400);
  const hit = pick(rayThrough(lens, 200, 220), positions, kBall.triangles, null);
  assert(hit && hit.point.every(Number.isFinite));
});

test("picking is independent of scale", () => {
  for (const size of [1e-6, 1e3]) {
    const rig = new CameraRig();
    rig.show("ball", [-size, -size, -size], [size, size, size], [0, 0, 1]);
    const lens = rig.lens(400, 400);
    const hit = pick(rayThrough(lens, 200, 200), kBall.positions.map((x) => x * size), kBall.triangles, null);
    assert(hit && Math.abs(length(hit.point) / size - 1) < 0.02);
  }
});

test("the nearest corner has the largest weight", () => {
  const hit = { triangle: 1, weights: [0.2, 0.5, 0.3] as Vec3, point: [0, 0, 0] as Vec3, distance: 1 };
  assert.equal(nearestVertex(hit, new Uint32Array([0, 1, 2, 7, 8, 9])), 8);
});

test("the brush covers only visible vertices", () => {
  const lens = frontCamera().lens(400, 400);
  const surface = { ...kBall, clip: null };
  const found = verticesInStroke(lens, surface, [[200, 200]], 60);
  assert(found.length > 20);
  const inDisc = (v: number): boolean => {
    const [x, y] = project(lens, [kBall.positions[3 * v], kBall.positions[3 * v + 1], kBall.positions[3 * v + 2]]);
    return Math.hypot(x - 200, y - 200) <= 60 - 1e-3;
  };
  for (let v = 0; v < kBall.positions.length / 3; ++v) {
    const facing = kBall.positions[3 * v + 2] > 0;
    assert.equal(found.includes(v), facing && inDisc(v), `vertex ${v}`);
  }
});

test("a stroke covers its path with few points", () => {
  const lens = frontCamera().lens(400, 400);
  const surface = { ...kBall, clip: null };
  const line = (count: number): [number, number][] =>
    Array.from({ length: count + 1 }, (_, i) => [120 + (160 * i) / count, 170 + (60 * i) / count]);
  const found = verticesInStroke(lens, surface, line(1), 30);
  assert.deepEqual(verticesInStroke(lens, surface, line(64), 30), found);
  const discs = new Set(line(640).flatMap((place) => verticesInStroke(lens, surface, [place], 30)));
  assert(found.length > 20);
  assert.deepEqual([...discs].sort((a, b) => a - b), found);
});

test("the brush reaches through a cut", () => {
  const lens = frontCamera().lens(400, 400);
  const clip = { normal: [0, 0, -1] as Vec3, offset: 0 };
  const found = verticesInStroke(lens, { ...kBall, clip }, [[200, 200]], 60);
  assert(found.length > 20);
  for (const v of found) assert(kBall.positions[3 * v + 2] < 0);
});

test("vertices behind the camera have no pixel", () => {
  const lens = frontCamera().lens(400, 400);
  const screen = screenPositions(lens, new Float32Array([0, 0, 100, 0, 0, 0]), null);
  assert(Number.isNaN(screen[0]));
  assert(Math.abs(screen[3] - 200) < 1e-3 && Math.abs(screen[4] - 200) < 1e-3);
});

test("labels are at visible vertices and apart", () => {
  const n = kBall.positions.length / 3;
  const geometry: Geometry = {
    side: "a", generation: 1, rest: kBall.positions, triangles: kBall.triangles, edges: new Uint32Array(0),
    tet: new Uint32Array(kBall.triangles.length / 3), vertex: Uint32Array.from({ length: n }, (_, i) => (i === 5 ? 0xffffffff : i)),
  };
  const lens = frontCamera().lens(600, 600);
  const labels = chooseLabels(lens, { ...kBall, clip: null }, geometry, { vertices: true, tets: false, em: 12, cursor: null });
  assert(labels.length > 30 && labels.length <= 300);
  for (const { text } of labels) assert(kBall.positions[3 * Number(text) + 2] > -0.2, text);
  for (const a of labels)
    for (const b of labels) assert(a === b || Math.abs(a.x - b.x) >= 3 * 12 || Math.abs(a.y - b.y) >= 12, `${a.text} ${b.text}`);
});

import assert from "node:assert/strict";
import { test } from "node:test";
import { Vector3 } from "three";
import type { Vec3 } from "../src/protocol";
import { CameraRig, kViewNames, sceneAxes, type ViewName } from "../src/view/cameras";
import { dot, length, minus, onFacingPlane, project, rayThrough } from "../src/view/lens";

const kScales = [1e-6, 1, 1e3];
const kUps: Vec3[] = [[0, 1, 0], [0, 0, 1], [1, 0, 0], [0, -1, 0], [0.6, 0, 0.8]];

function rigFor(size: number, up: Vec3): CameraRig {
  const rig = new CameraRig();
  rig.show("scene", [-size, -size, -size], [size, size, size], up);
  return rig;
}

function near(actual: number, expected: number, tolerance: number): void {
  assert(Math.abs(actual - expected) <= tolerance, `${actual} is not ${expected}`);
}

function nearPoint(actual: Vec3, expected: Vec3, tolerance: number): void {
  assert(length(minus(actual, expected)) <= tolerance, `${actual} is not ${expected}`);
}

test("a pixel's ray passes through its point", () => {
  for (const size of kScales)
    for (const up of kUps)
      for (const orthographic of [false, true]) {
        const rig = rigFor(size, up);
        rig.setOrthographic(orthographic);
        rig.turn(37, -12);
        const lens = rig.lens(800, 600);
        const point: Vec3 = [0.3 * size, -0.7 * size, 0.2 * size];
        const [x, y] = project(lens, point);
        const hit = onFacingPlane(lens, rayThrough(lens, x, y), point);
        assert(hit);
        nearPoint(hit, point, 1e-9 * size);
      }
});

test("canonical views show the whole box", () => {
  for (const up of kUps)
    for (const name of kViewNames)
      for (const [width, height] of [[1280, 800], [300, 900]]) {
        const rig = rigFor(2, up);
        rig.setView(name);
        const lens = rig.lens(width, height);
        for (let corner = 0; corner < 8; ++corner) {
          const point = [0, 1, 2].map((c) => (corner & (1 << c) ? 2 : -2)) as Vec3;
          const [x, y, depth] = project(lens, point);
          assert(x >= 0 && x <= width && y >= 0 && y <= height && depth > 0, `${name} ${up}: ${x}, ${y}`);
        }
      }
});

test("canonical views follow the scene's axes", () => {
  for (const up of kUps) {
    const axes = sceneAxes(up);
    const toward: Record<Exclude<ViewName, "isometric">, Vector3> = {
      front: axes.front, back: axes.front.clone().negate(),
      right: axes.right, left: axes.right.clone().negate(),
      top: axes.up, bottom: axes.up.clone().negate(),
    };
    for (const [name, direction] of Object.entries(toward)) {
      const rig = rigFor(1, up);
      rig.setView(name as ViewName);
      const lens = rig.lens(100, 100);
      near(dot(lens.forward, direction.toArray()), -1, 1e-12);
      if (name !== "top" && name !== "bottom") near(dot(lens.up, axes.up.toArray()), 1, 1e-12);
    }
  }
});

test("a turntable keeps the horizon level", () => {
  for (const up of kUps) {
    const rig = rigFor(1, up);
    for (let k = 0; k < 200; ++k) {
      rig.turn(13 * Math.sin(k), 29);
      near(dot(rig.lens(100, 100).right, sceneAxes(up).up.toArray()), 0, 1e-9);
    }
    near(dot(rig.lens(100, 100).forward, sceneAxes(up).up.toArray()), -1, 1e-9);
  }
});

test("zooming fixes the point under the cursor", () => {
  for (const orthographic of [false, true]) {
    const rig = rigFor(1, [0, 1, 0]);
    rig.setOrthographic(orthographic);
    const before = rig.lens(800, 600);
    const point = onFacingPlane(before, rayThrough(before, 650, 140), rig.target.toArray());
    assert(point);
    rig.zoom(0.5, 650 - 400, 300 - 140, 600);
    const [x, y] = project(rig.lens(800, 600), point);
    near(x, 650, 1e-6);
    near(y, 140, 1e-6);
  }
});

test("panning follows the cursor", () => {
  const rig = rigFor(1, [0, 0, 1]);
  const point = rig.target.toArray() as Vec3;
  rig.pan(30, -20, 600);
  const [x, y] = project(rig.lens(800, 600), point);
  near(x, 430, 1e-6);
  near(y, 280, 1e-6);
});

test("a 2-D camera faces an axis forever", () => {
  const rig = rigFor(1, [0, 0, 1]);
  rig.turn(40, 25);
  rig.setMode("flat");
  const { forward } = rig.lens(100, 100);
  near(Math.max(...forward.map(Math.abs)), 1, 1e-12);
  rig.turn(100, 100);
  assert.deepEqual(rig.lens(100, 100).forward, forward);
});

test("a saved camera is restored for its scene", () => {
  const rig = rigFor(1, [0, 1, 0]);
  rig.turn(11, 7);
  rig.pan(3, 4, 100);
  const other = new CameraRig();
  other.restore(JSON.parse(JSON.stringify(rig.save())));
  other.show("scene", [-1, -1, -1], [1, 1, 1], [0, 1, 0]);
  nearPoint(other.lens(100, 100).eye, rig.lens(100, 100).eye, 1e-12);
});

test("an invalid saved camera is ignored", () => {
  const rig = rigFor(1, [0, 1, 0]);
  const before = JSON.stringify(rig.save());
  const bad = [null, 3, {}, { mode: "orbit" }, { ...(rig.save() as object), distance: -1 }, { ...(rig.save() as object), target: [0, null, 1] }];
  for (const saved of bad) rig.restore(saved);
  assert.equal(JSON.stringify(rig.save()), before);
});

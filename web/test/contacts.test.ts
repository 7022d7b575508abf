// Contact points and obstacles of a view.
import assert from "node:assert/strict";
import { test } from "node:test";
import { decode } from "../src/protocol";
import { contactColors, contactText, largestPressure } from "../src/view/contacts";
import { ObstacleBodies, planeAxes } from "../src/view/obstacles";
import { cross, dot, length } from "../src/view/lens";
import { Matrix4, type Mesh, Vector3 } from "three";
import type { Vec3 } from "../src/protocol";

test("pressures have the colors from first to last", () => {
  const contacts = Float32Array.of(0, 0, 0, 0, 1, 0, 0, 50, 2, 0, 0, 100);
  assert.equal(largestPressure(contacts), 100);
  const colors = contactColors(contacts, 100);
  assert.ok(colors[2] > colors[0] && colors[6] > 2 * colors[8], "dark violet, and yellow");
  assert.deepEqual(contactColors(contacts, 0).subarray(6), colors.subarray(0, 3), "no pressure: the first color");
});

test("the summary has count, gap and pressure", () => {
  const row = { contacts: 12, min_gap: 8.55e-5, min_gap_pair: "ear and foot", max_pressure: 15700 };
  assert.equal(contactText(row), "12 contacts, smallest gap 85.5 µm (ear and foot), largest pressure 15.7 kPa");
  assert.equal(contactText({ ...row, contacts: 1 }).slice(0, 10), "1 contact,");
  assert.equal(contactText({ ...row, contacts: 0 }), "no contacts");
});

test("a picture is decoded with its contact points", () => {
  const bytes = new ArrayBuffer(48 + 20 + 32);
  const view = new DataView(bytes);
  [2, 0, 1, 1].forEach((word, i) => view.setUint32(4 * i, word, true));
  view.setUint32(32, 1, true);
  view.setUint32(44, 2, true);
  view.setFloat32(64, 7, true);
  for (let i = 0; i < 8; ++i) view.setFloat32(68 + 4 * i, i, true);
  const decoded = decode(bytes);
  assert.ok("picture" in decoded);
  assert.deepEqual([...decoded.picture.contacts], [0, 1, 2, 3, 4, 5, 6, 7]);
  assert.deepEqual([...decoded.picture.values!], [7]);
});

test("axes of a plane are orthonormal and right-handed", () => {
  for (const normal of [[0, 1, 0], [1, 0, 0], [0, 0, -1], [0.6, 0.8, 0]] as Vec3[]) {
    const [u, v] = planeAxes(normal, [0, 1, 0]);
    assert.ok(Math.abs(length(u) - 1) < 1e-12 && Math.abs(dot(u, normal)) < 1e-12);
    assert.ok(dot(cross(u, v), normal) > 1 - 1e-12);
  }
});

test("planes keep their height and follow bodies", () => {
  const bodies = new ObstacleBodies();
  const plane = { origin: [0, 0.5, 0] as Vec3, normal: [0, 1, 0] as Vec3 };
  const sheet = { name: "sheet", plane: null, points: [0, 0, 0, 1, 0, 0, 0, 0, 1], triangles: [0, 2, 1] };
  bodies.show([{ name: "floor", plane, points: [], triangles: [] }, sheet], [0, 1, 0], new Matrix4());
  assert.ok(bodies.hasGround);
  const units = { radius: 2, gridStep: 0.5, toUnits: (p: Vec3) => new Vector3(...p).divideScalar(2) };
  bodies.follow([3, 9, 4], units);
  const ground = bodies.children[1] as Mesh;
  assert.deepEqual(ground.position.toArray(), [1.5, 0.25, 2]);
  const drawn = bodies.children[0]!.children[0] as Mesh;
  assert.deepEqual([...drawn.geometry.getAttribute("position").array], [0, 0, 0, 0, 0, 1, 1, 0, 0]);
  assert.deepEqual([...drawn.geometry.getAttribute("normal").array.slice(0, 3)], [0, 1, 0]);
  bodies.show([], [0, 1, 0], new Matrix4());
  assert.ok(!bodies.hasGround, "without a plane there is no ground");
});

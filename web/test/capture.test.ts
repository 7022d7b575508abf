import assert from "node:assert/strict";
import { test } from "node:test";
import { ForceCurve } from "../src/capture/curve";
import { angleOf, fullScale } from "../src/capture/dial";
import { errorText, fitText } from "../src/capture/fitForm";
import type { CaptureFit, ProbeState, Vec3 } from "../src/protocol";
import type { Lens } from "../src/view/lens";
import { markersOn, nearestOn } from "../src/view/markers";
import { depthOf, inwardNormal, wayIn } from "../src/view/pressing";

const kTop = { positions: [0, 0, 1, 2, 0, 1, 0, 2, 1], triangles: [0, 1, 2] }; // seen from above
const kFront: Lens = { eye: [0, -10, 0], right: [1, 0, 0], up: [0, 0, 1], forward: [0, 1, 0], slope: 0.5, extent: 0, width: 400, height: 200 };

function probe(change: Partial<ProbeState> = {}): ProbeState {
  const tip = { shape: "sphere", contact: "bonded", radius: 0.01, stiffness: 1e6 } as const;
  const place = { begun: [0, 0, 1] as Vec3, center: [0, 0, 1] as Vec3, axis: [0, 0, -1] as Vec3 };
  return { ...tip, ...place, depth: 0, wanted: 0, force: [0, 0, 0], torque: [0, 0, 0], points: 9, ...change };
}

test("pressing follows the inward normal, or drags down", () => {
  const inward = inwardNormal(kTop.positions, kTop.triangles, 0);
  assert.ok(inward[2] < -0.99);
  const way = wayIn(kFront, [0, 0, 0], inward);
  assert.ok(Math.abs(way.direction[1] - 1) < 1e-9); // down on the screen
  assert.ok(Math.abs(depthOf(way, [5, 20]) - 20 * 0.05) < 1e-9); // 10 m high, 200 pixels
  const along = wayIn(kFront, [0, 0, 0], [0, 1, 0]);
  assert.deepEqual(along.direction, [0, 1]);
  assert.ok(depthOf(along, [0, 10]) > 0);
});

test("markers follow their weights and face outward", () => {
  const [dot] = markersOn(kTop, { triangles: [0], weights: [0.5, 0.25, 0.25] });
  assert.deepEqual(dot!.at, [0.5, 0.5, 1]);
  assert.ok(dot!.normal[2] > 0.99);
  assert.deepEqual(markersOn(kTop, { triangles: [7], weights: [1, 0, 0] }), []); // belongs to a surface that no longer exists
  assert.equal(nearestOn([dot!], [3, 3, 3]).normal, dot!.normal);
});

test("the curve keeps the latest force per depth", () => {
  const curve = new ForceCurve();
  assert.equal(curve.add(null), false);
  assert.ok(curve.add(probe({ depth: 0.002, force: [0, 0, -2] })));
  assert.ok(curve.add(probe({ depth: 0.001, force: [0, 0, -1] })));
  assert.equal(curve.add(probe({ depth: 0.001, force: [0, 0, -1] })), false);
  assert.ok(curve.add(probe({ depth: 0.002, force: [0.5, 0, -3] })));
  assert.deepEqual(curve.sorted(), [[0.001, 1], [0.002, 3]]);
  curve.add(probe({ begun: [1, 0, 1], depth: 0, force: [0, 0, 4] }));
  assert.deepEqual(curve.sorted(), [[0, -4]]); // it pulls
});

test("the dial's scale grows at once, shrinks rarely", () => {
  const first = fullScale(0.7, 0);
  assert.equal(first, 1);
  assert.equal(fullScale(0.4, first), 1);
  assert.equal(fullScale(3, first), 5);
  assert.ok(fullScale(0.01, first) < 0.1);
  assert.equal(angleOf(0, 1), -120);
  assert.equal(angleOf(1, 1), 120);
  assert.ok(angleOf(99, 1) < 135);
});

test("the summary of a fit names its state", () => {
  const fit: CaptureFit = {
    running: true, stage: "a value for every tet", words: "", failure: "", residuals: 10, error: null, softest: null, stiffest: null,
    has_material: false, warnings: [], next: null,
    iterations: [{ index: 4, misfit: 1, roughness: 0, weight: 1, chi: 2.345 }],
  };
  assert.equal(fitText(null), "");
  assert.match(fitText(fit), /a value for every tet: iteration 4.*2\.3 standard/);
  assert.match(fitText({ ...fit, running: false, stage: "" }), /^Done: iteration 4/);
  assert.match(fitText({ ...fit, failure: "no rest" }), /failed: no rest/);
  assert.equal(errorText(Math.log(1.1)), "10 %");
  assert.equal(errorText(Math.log(2)), "a factor of 2");
});

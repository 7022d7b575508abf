// A fit as the page reads it, and the body that its maps cut open.
import assert from "node:assert/strict";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import type { Vec3 } from "../src/protocol";
import { bodyBelow, boundaryOf, section, type Soup, type TetMesh } from "../src/fit/cut";
import {
  closeness,
  depthOf,
  groupCurve,
  groupsOf,
  histogram,
  markerName,
  residuals,
  travel,
  unpackFit,
  verdict,
  worstMarkers,
  type Case,
  type Fit,
  type FitHead,
} from "../src/fit/data";

// Unit cube of n^3 cells, six tets each around the diagonal.
function cube(n: number): TetMesh {
  const points: number[] = [];
  for (let i = 0; i <= n; ++i) for (let j = 0; j <= n; ++j) for (let k = 0; k <= n; ++k) points.push(i / n, j / n, k / n);
  const at = (c: number[]): number => (c[0] * (n + 1) + c[1]) * (n + 1) + c[2];
  const tets: number[] = [];
  for (let i = 0; i < n; ++i)
    for (let j = 0; j < n; ++j)
      for (let k = 0; k < n; ++k)
        for (const [path, even] of [[[0, 1, 2], true], [[1, 2, 0], true], [[2, 0, 1], true], [[0, 2, 1], false], [[2, 1, 0], false], [[1, 0, 2], false]] as [number[], boolean][]) {
          const corner = [i, j, k];
          const tet = [at(corner)];
          for (const axis of path) {
            ++corner[axis];
            tet.push(at(corner));
          }
          if (!even) [tet[2], tet[3]] = [tet[3], tet[2]];
          tets.push(...tet);
        }
  return { points: Float32Array.from(points), tets: Uint32Array.from(tets) };
}

// Volume by the divergence theorem; correct only for a closed surface that faces outward.
function volumeIn({ positions }: Soup): number {
  let six = 0;
  for (let t = 0; t < positions.length; t += 9) {
    const [a, b, c] = [0, 3, 6].map((k) => positions.subarray(t + k, t + k + 3));
    six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six / 6;
}

test("a cube's boundary has two triangles per square", () => {
  const boundary = boundaryOf(cube(3));
  assert.equal(boundary.tet.length, 6 * 9 * 2);
});

test("the cut body is closed with exact volume", () => {
  const mesh = cube(3);
  const boundary = boundaryOf(mesh);
  assert.ok(Math.abs(volumeIn(bodyBelow(mesh, boundary, null)) - 1) < 1e-6);
  for (const [normal, offset, volume] of [
    [[1, 0, 0], 0.4, 0.4],
    [[0, -1, 0], -0.25, 0.75],
    [[0, 0, 1], 1 / 3, 1 / 3], // through vertices
    [[1, 0, 0], 2, 1],
    [[1, 0, 0], -1, 0],
  ] as [Vec3, number, number][]) {
    const soup = bodyBelow(mesh, boundary, { normal, offset });
    assert.ok(Math.abs(volumeIn(soup) - volume) < 1e-6, `${normal.join()}: ${volumeIn(soup)} instead of ${volume}`);
    assert.equal(soup.tet.length, soup.positions.length / 9);
    assert.ok(soup.edges.every((corner) => corner < soup.corner.length));
  }
  const s = Math.sqrt(0.5);
  const oblique = bodyBelow(mesh, boundary, { normal: [s, s, 0], offset: s });
  assert.ok(Math.abs(volumeIn(oblique) - 0.5) < 1e-6);
});

test("a plane cuts tets in triangles or quadrilaterals", () => {
  const corners: Vec3[] = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const cutAt = (z: number): Vec3[] => section(corners, corners.map((c) => c[2] - z), [0, 0, 1]);
  assert.equal(cutAt(0.5).length, 3);
  assert.equal(cutAt(2).length, 0);
  assert.equal(section(corners, [-1, -1, 1, 1], [0, 0, 1]).length, 4);
});

const kTip = { shape: "sphere" as const, radius: 0.1, axis: [0, -1, 0] as Vec3, touch: [0, 1, 0] as Vec3 };

function poke(name: string, group: string, depth: number, first: number, more: Partial<Case> = {}): Case {
  return {
    name,
    group,
    first,
    count: 1,
    leftOut: false,
    ok: true,
    pressure: 0,
    gravity: 0,
    tip: { ...kTip, center: [0, 1 - depth, 0] },
    force: { measured: [0, -10 * depth, 0], deviation: [0.1, 0.2, 0.1], predicted: [0, -11 * depth, 0], heldOut: null },
    ...more,
  };
}

// Two pokes at one place, deepest first, and a held-out case.
function head(): FitHead {
  return {
    format: 1,
    name: "block",
    version: "1",
    model: "neo_hookean",
    counts: { vertices: 4, tets: 1, markers: 2, cases: 3, unknowns: 1, residuals: 12, equilibria: 9 },
    fit: { words: "converged", success: true, interrupted: false, mesh: "a material per tet of 6, simulated on 6 tets", method: "lm", rule: "auto", iterations: 3, weight: 1, misfit: 6, roughness: 1, uniformMisfit: null, informed: null, noiseFactor: null },
    quantities: [],
    cases: [
      poke("a, 2", "a", 0.2, 0),
      poke("a, 1", "a", 0.1, 1),
      poke("b", "b", 0.3, 2, { leftOut: true, force: { measured: [0, -3, 0], deviation: [0.1, 0.1, 0.1], predicted: [0, -4, 0], heldOut: [0, -4, 0] } }),
    ],
    heldOut: null,
    history: [],
    weights: [],
    notes: [],
    warnings: [],
    nextPoke: null,
  };
}

async function fitOf(what: FitHead): Promise<Fit> {
  const arrays: [string, "u32" | "f32", Uint32Array | Float32Array][] = [
    ["markers", "f32", Float32Array.of(0, 0, 0, 1, 0, 0)],
    ["reading.marker", "u32", Uint32Array.of(0, 1, 0)],
    ["reading.measured", "f32", Float32Array.of(0, -0.5, 0, 1, 0, 0, 0, -1, 0)],
    ["reading.deviation", "f32", new Float32Array(9).fill(0.125)],
    ["reading.predicted", "f32", Float32Array.of(0, -0.75, 0, 1, 0, 0.125, 0, -2, 0)],
    ["reading.heldOut", "f32", new Float32Array(9).fill(NaN)],
  ];
  let at = 0;
  const list = arrays.map(([name, type, numbers]) => {
    const entry = { name, type, at, count: numbers.length };
    at += numbers.byteLength;
    return entry;
  });
  const json = Buffer.from(JSON.stringify({ ...what, arrays: list }));
  const start = Buffer.alloc(Math.ceil((4 + json.length) / 4) * 4);
  start.writeUInt32LE(json.length);
  json.copy(start, 4);
  const bytes = Buffer.concat([start, ...arrays.map(([, , numbers]) => Buffer.from(numbers.buffer))]);
  return unpackFit(gzipSync(bytes).toString("base64"));
}

test("groups keep order, curves sort by depth", async () => {
  const fit = await fitOf(head());
  const groups = groupsOf(fit.head.cases);
  assert.deepEqual(groups, [{ name: "a", cases: [0, 1] }, { name: "b", cases: [2] }]);
  const curve = groupCurve(fit, groups[0]);
  assert.deepEqual([curve.x.unit, curve.y.unit], ["m", "N"]);
  assert.deepEqual(curve.samples.map(({ x }) => Math.round(10 * x)), [1, 2]);
  assert.ok(curve.samples.every(({ measured: f }, i) => Math.abs(f! - [1, 2][i]) < 1e-12), "a push is positive along the way of the tip");
  assert.ok(Math.abs(curve.samples[0].deviation - 0.2) < 1e-12);
  assert.ok(curve.samples.every(({ heldOut }) => heldOut === null));
  const leftOut = groupCurve(fit, groups[1]);
  assert.ok(leftOut.leftOut && leftOut.samples[0].fitted === null && leftOut.samples[0].heldOut === 4);
});

test("a curve without forces shows marker motion", async () => {
  const what = head();
  for (const c of what.cases) c.force = null;
  const fit = await fitOf(what);
  const curve = groupCurve(fit, { cases: [0] });
  assert.deepEqual([curve.y.unit, ...curve.samples.map(({ measured, fitted, heldOut }) => [measured, fitted, heldOut])], ["m", [0.5, 0.75, null]]);
  for (const c of what.cases) c.tip = null;
  what.cases[0].pressure = 300;
  assert.deepEqual(groupCurve(await fitOf(what), { cases: [0] }).samples.map(({ x }) => x), [300]);
});

test("residuals exclude held-out readings", async () => {
  const { all, ofCase } = residuals(await fitOf(head()));
  assert.equal(all.length, 12);
  assert.equal(ofCase[2], null);
  assert.ok(Math.abs(all[1] + 2) < 1e-6 && Math.abs(all[4] + 0.2 / 0.2) < 1e-6);
});

test("the worst markers come first", async () => {
  const fit = await fitOf(head());
  assert.deepEqual(worstMarkers(fit, 9).map((w) => w.case), [2, 0, 1]);
  const [one] = worstMarkers(fit, 9, 1);
  assert.equal(one.marker, 1);
  assert.ok(Math.abs(one.sigmas - 1 / Math.sqrt(3)) < 1e-6);
});

test("a histogram counts outliers at its ends", () => {
  const { middle, count } = histogram([-9, -0.9, 0.1, 0.2, 7, NaN], 1, 4);
  assert.deepEqual(count, [2, 0, 2, 1]);
  assert.deepEqual(middle, [-0.75, -0.25, 0.25, 0.75]);
});

test("a resting tip points along its axis", () => {
  assert.deepEqual(travel({ ...kTip, center: kTip.touch }), [0, -1, 0]);
  assert.equal(depthOf({ ...kTip, center: [0, 0.5, 0] }), 0.5);
});

test("the program's verdict lists each reason once", () => {
  const what = head();
  assert.equal(closeness(6, 12), 1);
  assert.deepEqual(verdict({ ...what, verdict: { good: true, text: "Converged.", reasons: [] } }), { text: "Converged.", kind: "good", reasons: [] });
  const text = "Do not rely on this material: E is at its bound.";
  const reasons = [{ name: "at_bound", text: "E is at its bound" }, { name: "group_missed", text: "'a' is missed" }];
  assert.deepEqual(verdict({ ...what, verdict: { good: false, text, reasons } }), { text, kind: "bad", reasons: ["'a' is missed"] });
});

test("without a verdict nothing is good", () => {
  const what = head();
  assert.equal(verdict(what).kind, "plain");
  assert.equal(verdict({ ...what, fit: { ...what.fit, success: false } }).kind, "bad");
  assert.equal(verdict({ ...what, fit: { ...what.fit, interrupted: true } }).kind, "bad");
});

test("markers have the data set's names", () => {
  assert.equal(markerName({ ...head(), markerNames: ["nose", ""] }, 0), "nose");
  assert.equal(markerName({ ...head(), markerNames: ["nose", ""] }, 1), "2");
  assert.equal(markerName(head(), 1), "2");
});

// Pressed in slightly and turned about the axis, deepest first.
function twist(name: string, angle: number, more: Partial<Case> = {}): Case {
  const torque = { measured: [0, -0.5 * angle, 0] as Vec3, deviation: [0.1, 0.02, 0.1] as Vec3, predicted: [0, -0.6 * angle, 0] as Vec3, heldOut: null };
  return poke(name, "twist", 0.01, 0, { tip: { ...kTip, center: [0, 0.99, 0], turn: [0, -angle, 0] }, torque, ...more });
}

test("a twist is drawn as torque over angle", async () => {
  const fit = await fitOf({ ...head(), cases: [twist("twist 2", 0.4), twist("twist 1", 0.2)] });
  const curve = groupCurve(fit, { cases: [0, 1] });
  assert.deepEqual([curve.x.label, curve.x.unit, curve.y.label, curve.y.unit], ["angle", "rad", "torque", "N m"]);
  assert.deepEqual(curve.samples.map(({ x }) => x), [0.2, 0.4]);
  assert.deepEqual(curve.samples.map(({ measured }) => measured), [0.1, 0.2]);
  assert.ok(curve.samples.every(({ fitted: t }, i) => Math.abs(t! - [0.12, 0.24][i]) < 1e-12));
  assert.equal(curve.samples[0].deviation, 0.02);
});

test("a twist without torques shows marker motion", async () => {
  const fit = await fitOf({ ...head(), cases: [twist("twist", 0.4, { torque: null })] });
  const curve = groupCurve(fit, { cases: [0] });
  assert.deepEqual([curve.x.label, curve.y.label, curve.y.unit], ["angle", "mean motion", "m"]);
});

test("a slightly turned poke is no twist", async () => {
  const cases = [poke("a", "a", 0.2, 0, { tip: { ...kTip, center: [0, 0.8, 0], turn: [0, 0.01, 0] } })];
  const curve = groupCurve(await fitOf({ ...head(), cases }), { cases: [0] });
  assert.deepEqual([curve.x.label, curve.y.label], ["depth", "force"]);
});

test("residuals count torques", async () => {
  const { all } = residuals(await fitOf({ ...head(), cases: [twist("twist", 0.4)] }));
  assert.equal(all.length, 9);
  assert.ok(Math.abs(all[7] + 0.04 / 0.02) < 1e-9);
});

test("damaged fits are refused", async () => {
  await assert.rejects(unpackFit("AAAA"));
  await assert.rejects(fitOf({ ...head(), format: 2 }), /reads format 1/);
});

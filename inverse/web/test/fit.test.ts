// A fit as the page reads it, and the body that its maps cut open.
import assert from "node:assert/strict";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import type { Vec3 } from "../../../web/src/protocol";
import { intervalText } from "../fit/cells";
import { checksOf } from "../fit/checks";
import { bodyBelow, boundaryOf, section, type Soup, type TetMesh } from "../fit/cut";
import {
  closeness,
  groupCurve,
  groupsOf,
  isCorrected,
  markerName,
  percentile,
  stiffness,
  unpackFit,
  verdict,
  worstMarkers,
  type CaseFigures,
  type Fit,
  type FitHead,
} from "../fit/data";
import { colorCaption } from "../fit/maps";
import { trust } from "../fit/trust";

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

// A poke or twist of the group whose response is ten times the load.
function caseFigures(name: string, group: string, load: number, more: Partial<CaseFigures> = {}): CaseFigures {
  return {
    name,
    group,
    left_out: false,
    load: { name: "depth", unit: "m", value: load },
    response: { name: "force", unit: "N", measured: 10 * load, deviation: 0.2, fitted: 11 * load, on_mesh: 12 * load, held_out: null },
    stiffness_unit: "N/m",
    rms: 1,
    readings: 6,
    ...more,
  };
}

// Two pokes at one place, deepest first, and a held-out case.
function head(): FitHead {
  const shown = (name: string, group: string, first: number, leftOut = false) => ({ name, group, first, count: 1, hidden: 0, leftOut, ok: true });
  return {
    format: 1,
    name: "block",
    version: "1",
    model: "neo_hookean",
    counts: { tets: 1, markers: 2, cases: 3, parameters: 1, residuals: 12, equilibria: 9 },
    fit: { words: "converged", success: true, interrupted: false, mesh: "a material per tet of 6, simulated on 6 tets", method: "lm", iterations: 3, weight: 1, misfit: 6, roughness: 1, uniformMisfit: null, informed: null },
    quantities: [
      { name: "young", unit: "Pa", isLog: true, varies: false, rows: [{ where: "everywhere", value: 12_000, lower: 11_000, upper: 13_000 }] },
      { name: "poisson", unit: "", isLog: false, varies: false, rows: [{ where: "given", value: 0.4, lower: null, upper: null }] },
    ],
    cases: [shown("a, 2", "a", 0), shown("a, 1", "a", 1), shown("b", "b", 2, true)],
    figures: {
      residuals: 12,
      squares: 12,
      groups: [{ group: "a", readings: "forces", standard_deviations: 1.5 }],
      verdict: { good: true, text: "Converged.", reasons: [] },
      limits: { missed: 4, squares_per_reading: 2.25 },
      held_out: { groups: [], position: 0.012, force: 0.034, torque: null, largest_motion: 1, largest_force: 1, largest_torque: 0, poor: false, limits: { position: 0.05, force: 0.1, torque: 0.1, single: 2 } },
      // Errors of fewer groups; the errors above are judged.
      comparison: [{ how: "cross-validation", models: [{ model: "this fit", position: 0.02, force: 0.11, torque: null }] }],
      cases: [caseFigures("a, 2", "a", 0.2), caseFigures("a, 1", "a", 0.1), caseFigures("b", "b", 0.3, { left_out: true, rms: null })],
      histogram: { limit: 4, counts: [1, 2] },
    },
    history: [],
    weights: [],
    notes: [],
    warnings: [],
  };
}

async function fitOf(what: FitHead): Promise<Fit> {
  const arrays: [string, "u32" | "f32", Uint32Array | Float32Array][] = [
    ["markers", "f32", Float32Array.of(0, 0, 0, 1, 0, 0)],
    ["reading.marker", "u32", Uint32Array.of(0, 1, 0)],
    ["reading.measured", "f32", Float32Array.of(0, -0.5, 0, 1, 0, 0, 0, -1, 0)],
    ["reading.deviation", "f32", new Float32Array(9).fill(0.125)],
    ["reading.predicted", "f32", Float32Array.of(0, -0.75, 0, 1, 0, 0.125, 0, -2, 0)],
    ["reading.onMesh", "f32", Float32Array.of(0, -1, 0, 1, 0, 0.5, 0, -2, 0)],
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

test("groups keep order, curves sort by load", () => {
  const { cases, figures } = head();
  const groups = groupsOf(cases);
  assert.deepEqual(groups, [{ name: "a", cases: [0, 1] }, { name: "b", cases: [2] }]);
  const curve = groupCurve(figures, groups[0]);
  assert.deepEqual([curve.x, curve.y], [{ label: "depth", unit: "m" }, { label: "force", unit: "N" }]);
  assert.deepEqual(curve.samples.map(({ name }) => name), ["a, 1", "a, 2"]);
  assert.ok(!curve.leftOut && groupCurve(figures, groups[1]).leftOut);
});

test("stiffness is response over load", () => {
  const poke = caseFigures("a", "a", 0.2);
  assert.equal(stiffness(poke, 3), 15);
  assert.equal(stiffness({ ...poke, stiffness_unit: "" }, 3), null);
  assert.equal(stiffness(caseFigures("a", "a", 0), 3), null);
});

test("raw predictions are shown if they differ", () => {
  const { figures } = head();
  assert.ok(isCorrected(figures));
  for (const c of figures.cases) c.response.on_mesh = c.response.fitted;
  assert.ok(!isCorrected(figures));
});

test("the worst markers come first", async () => {
  const fit = await fitOf(head());
  assert.deepEqual(worstMarkers(fit, 9).map((w) => w.case), [2, 0, 1]);
  const [one] = worstMarkers(fit, 9, 1);
  assert.equal(one.marker, 1);
  assert.ok(Math.abs(one.sigmas - 1 / Math.sqrt(3)) < 1e-6);
  assert.ok(Math.abs(one.onMesh - 0.5) < 1e-6);
});

test("outliers count with their stated deviations", async () => {
  const what = head();
  what.figures.outliers = [{ case: "a, 1", reading: "2", weight: 0.01 }];
  const [one] = worstMarkers(await fitOf(what), 9, 1);
  assert.ok(Math.abs(one.sigmas - 10 / Math.sqrt(3)) < 1e-6, "a weight of 0.01 widens the deviation tenfold");
});

test("percentiles interpolate and skip values that are not finite", () => {
  assert.equal(percentile([4, 1, NaN, 3, 2, 5], 0.5), 3);
  assert.equal(percentile([0, 10], 0.02), 0.2);
  assert.ok(Number.isNaN(percentile([], 0.5)));
});

test("captions state clipped colors", () => {
  const shown = { label: "E", unit: "Pa", map: "viridis" as const, log: true };
  const caption = (values: number[], range: [number, number]): string => colorCaption({ ...shown, values: Float32Array.from(values), range });
  assert.equal(caption([1000, 2000, 900_000], [1000, 2000]), "Colors span the 2 % and 98 % percentiles of the tets, 1 kPa to 2 kPa; the values range from 1 kPa to 900 kPa.");
  assert.equal(caption([1000, 2000], [1000, 2000]), "Colors span 1 kPa to 2 kPa.");
  assert.equal(caption([1000, 1000], [1000, 1000]), "All tets have the value 1 kPa.");
});

test("the program's verdict lists each reason once", () => {
  const what = head().figures;
  assert.equal(closeness(6, 12), 1);
  assert.deepEqual(verdict(what), { title: "Good. Converged.", kind: "good", reasons: [] });
  const text = "Do not rely on this material: E is at its bound.";
  const reasons = [{ name: "at_bound", text: "E is at its bound" }, { name: "group_missed", text: "'a' is missed" }];
  assert.deepEqual(verdict({ ...what, verdict: { good: false, text, reasons } }), { title: "Do not rely on this material:", kind: "bad", reasons: ["E is at its bound", "'a' is missed"] });
  const interrupted = [{ name: "interrupted", text: "the same command continues the fit" }];
  assert.equal(verdict({ ...what, verdict: { good: false, text: "Interrupted.", reasons: interrupted } }).title, "Interrupted.");
});

test("the first paragraph has errors and a judgment", () => {
  const what = head();
  const good = trust(what);
  for (const part of ["1.2 % of the largest motion and 3.4 % of the largest force", "Trust predictions"]) assert.ok(good.includes(part), good);
  what.figures.verdict.good = false;
  assert.ok(!trust(what).includes("Trust"));
  what.figures.verdict.good = true;
  what.figures.held_out = null;
  assert.ok(trust(what).includes("untested") && !trust(what).includes("Trust"));
});

test("every figure above its limit is marked", () => {
  const what = head();
  const failing = (): string[] => checksOf(what).filter((c) => c.fails).map((c) => c.what);
  assert.deepEqual(failing(), []);
  what.figures.squares = 28;
  what.figures.groups[0].standard_deviations = 4.1;
  what.figures.common_errors = [{ cause: "the mesh", standard_deviations: -5 }];
  what.figures.held_out = { groups: [], position: 0.06, force: 0.09, torque: null, largest_motion: 1, largest_force: 1, largest_torque: 0, poor: true, limits: { position: 0.05, force: 0.1, torque: 0.1, single: 2 } };
  assert.deepEqual(failing(), ["|r|² per reading (expected: 1)", "group with the largest error: forces of a", "error of the mesh", "held-out positions: error beyond the noise, of the largest motion"]);
  what.figures.verdict = { good: false, text: "", reasons: [{ name: "groups_disagree", text: "'a' disagrees with 'b'", value: 2, limit: 1.5 }] };
  assert.equal(failing().at(-1), "'a' disagrees with 'b'");
});

test("digits distinguish the ends of an interval", () => {
  assert.equal(intervalText(20_002, 20_008, "Pa"), "20.002 kPa to 20.008 kPa");
  assert.equal(intervalText(0.44, 0.46, ""), "0.44 to 0.46");
  assert.equal(intervalText(null, null, "Pa"), "–");
});

test("markers have the data set's names", () => {
  assert.equal(markerName({ ...head(), markerNames: ["nose", ""] }, 0), "nose");
  assert.equal(markerName({ ...head(), markerNames: ["nose", ""] }, 1), "2");
  assert.equal(markerName(head(), 1), "2");
});

test("damaged fits are refused", async () => {
  await assert.rejects(unpackFit("AAAA"));
  await assert.rejects(fitOf({ ...head(), format: 2 }), /reads format 1/);
});

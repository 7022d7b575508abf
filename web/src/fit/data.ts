// A fit inside the page, as far as the page reads what apps/viewer/fit_page.cpp packs, and quantities derived from it.
import { Pack, unpacked } from "../pack";
import type { MaybeNumber, Vec3 } from "../protocol";
import { dot, length, minus, unit, vectorAt } from "../view/lens";

export interface ValueRow {
  where: string;
  value: MaybeNumber;
  lower: MaybeNumber; // lower end of the 95 % interval
  upper: MaybeNumber;
}

export interface Quantity {
  name: string;
  unit: string;
  isLog: boolean; // shown on a logarithmic scale
  rows: ValueRow[];
}

export interface Tip {
  radius: number; // [m]
  touch: Vec3;
  center: Vec3;
  axis: Vec3;
  turn?: Vec3; // rotation since first contact [rad]
}

// Force or torque of the tip on the body.
export interface Reading {
  measured: Vec3;
  deviation: Vec3;
  predicted: Vec3 | null;
  heldOut: Vec3 | null;
}

export interface Case {
  name: string;
  group: string;
  first: number; // index of its first reading
  count: number;
  leftOut: boolean;
  ok: boolean;
  pressure: number; // [Pa]
  gravity: number; // [m/s^2]
  tip: Tip | null;
  force: Reading | null; // [N]
  torque?: Reading | null; // [N m]
}

export interface HeldOutGroup extends Record<"peakMotion" | "positionError" | "peakForce" | "forceError", MaybeNumber> {
  group: string;
  ok: boolean;
  failure: string;
}

type WeightTrial = Record<"weight" | "misfit" | "roughness", MaybeNumber>; // misfit: |r|^2 / 2

export interface FitHead {
  format: number;
  name: string;
  version: string;
  model: string;
  verdict?: { good: boolean; text: string; reasons: { text: string }[] }; // verdict of the program
  counts: Record<"tets" | "markers" | "cases" | "unknowns" | "residuals" | "equilibria", number>;
  fit: WeightTrial & {
    words: string;
    success: boolean;
    interrupted: boolean;
    mesh: string;
    method: string;
    iterations: number;
    uniformMisfit: MaybeNumber;
    informed: MaybeNumber;
  };
  quantities: Quantity[];
  cases: Case[];
  heldOut: { groups: HeldOutGroup[]; position: MaybeNumber; force: MaybeNumber } | null;
  history: (WeightTrial & { decrement: MaybeNumber })[];
  weights: WeightTrial[];
  notes: string[];
  warnings: string[];
  markerNames?: string[]; // names in the data set, in the order of the markers
  nextPoke: { site: Vec3; inward: Vec3; words: string } | null;
}

export type Fit = Pack<FitHead>;

export async function unpackFit(text: string): Promise<Fit> {
  const fit = new Pack<FitHead>(await unpacked(text));
  if (fit.head.format !== 1) throw new Error(`the fit has format ${String(fit.head.format)}; this page reads format 1`);
  return fit;
}

// |r|^2 per reading: 1 when the residuals match the standard deviations.
export function closeness(misfit: MaybeNumber, residuals: number): MaybeNumber {
  return misfit === null || !(residuals > 0) ? null : (2 * misfit) / residuals;
}

// Groups in the order of their first case.
export function groupsOf(cases: readonly Case[]): { name: string; cases: number[] }[] {
  const names = [...new Set(cases.map((c) => c.group))];
  return names.map((name) => ({ name, cases: cases.flatMap((c, i) => (c.group === name ? [i] : [])) }));
}

// Unit direction of the tip's travel since first contact; its axis if it has not moved.
export function travel(tip: Tip): Vec3 {
  const way = minus(tip.center, tip.touch);
  return unit(length(way) > 1e-12 ? way : tip.axis);
}

function turnAxis(tip: Tip): Vec3 {
  const turn = tip.turn ?? tip.axis;
  return unit(length(turn) > 1e-12 ? turn : tip.axis);
}

export const depthOf = (tip: Tip): number => length(minus(tip.center, tip.touch));

interface Sample {
  x: number;
  measured: MaybeNumber;
  deviation: number;
  fitted: MaybeNumber;
  heldOut: MaybeNumber;
}

// Curve of one group for a chart: load against response, with one standard deviation of the measurements.
export interface GroupCurve {
  x: { label: string; unit: string };
  y: { label: string; unit: string };
  samples: Sample[];
  leftOut: boolean;
}

type Answer = "force" | "torque" | "motion";

const turnOf = (tip: Tip): number => length(tip.turn ?? [0, 0, 0]);

// Whether the group is a twist: a tip that turns on the spot moves its rim by more than its center.
function isTwist(cases: readonly Case[]): boolean {
  const largest = (of: (tip: Tip) => number): number => Math.max(0, ...cases.map((c) => (c.tip ? of(c.tip) : 0)));
  return cases.every((c) => c.tip !== null) && largest((tip) => tip.radius * turnOf(tip)) > largest(depthOf);
}

const kAnswers: Record<Answer, { label: string; unit: string }> = {
  force: { label: "force", unit: "N" },
  torque: { label: "torque", unit: "N m" },
  motion: { label: "mean motion", unit: "m" },
};

export function groupCurve(fit: Fit, group: { cases: number[] }): GroupCurve {
  const cases = group.cases.map((c) => fit.head.cases[c]);
  const load = loadAxis(cases);
  const isMeasured = (answer: "force" | "torque"): boolean => load.byTip && cases.some((c) => (c[answer] ?? null) !== null);
  const answer = load.twists && isMeasured("torque") ? "torque" : isMeasured("force") && !load.twists ? "force" : "motion";
  const sample = (c: Case): Omit<Sample, "x"> => (answer === "motion" ? motionSample(fit, c) : tipSample(c, answer));
  const samples = cases.map((c, i) => ({ ...sample(c), x: load.of(c, i) }));
  samples.sort((a, b) => a.x - b.x);
  return { x: load, y: kAnswers[answer], samples, leftOut: cases.some((c) => c.leftOut) };
}

interface LoadAxis {
  label: string;
  unit: string;
  byTip: boolean;
  twists: boolean;
  of: (c: Case, i: number) => number;
}

function loadAxis(cases: readonly Case[]): LoadAxis {
  const byTip = cases.every((c) => c.tip !== null);
  if (isTwist(cases)) return { label: "angle", unit: "rad", byTip, twists: true, of: (c) => (c.tip ? turnOf(c.tip) : 0) };
  if (byTip) return { label: "depth", unit: "m", byTip, twists: false, of: (c) => (c.tip ? depthOf(c.tip) : 0) };
  if (cases.some((c) => c.pressure !== 0)) return { label: "pressure", unit: "Pa", byTip, twists: false, of: (c) => c.pressure };
  return { label: "acceleration of gravity", unit: "m/s²", byTip, twists: false, of: (c, i) => c.gravity || i };
}

// Response along the tip's travel, or about its axis of rotation; positive where the tip pushes or twists the body.
function tipSample(c: Case, answer: "force" | "torque"): Omit<Sample, "x"> {
  const reading = c[answer];
  if (!c.tip || !reading) return { measured: null, deviation: 0, fitted: null, heldOut: null };
  const way = answer === "force" ? travel(c.tip) : turnAxis(c.tip);
  const { measured, deviation, predicted, heldOut } = reading;
  return {
    measured: dot(measured, way),
    deviation: Math.hypot(way[0] * deviation[0], way[1] * deviation[1], way[2] * deviation[2]),
    fitted: predicted && !c.leftOut ? dot(predicted, way) : null,
    heldOut: heldOut ? dot(heldOut, way) : null,
  };
}

function motionSample(fit: Fit, c: Case): Omit<Sample, "x"> {
  const [marker, rest] = [fit.indices("reading.marker"), fit.floats("markers")];
  const mean = (name: string): MaybeNumber => {
    const positions = fit.floats(name);
    let sum = 0;
    for (let i = c.first; i < c.first + c.count; ++i) sum += length(minus(vectorAt(positions, i), vectorAt(rest, marker[i])));
    return c.count > 0 && Number.isFinite(sum) ? sum / c.count : null;
  };
  const deviations = fit.floats("reading.deviation");
  let variance = 0;
  for (let i = c.first; i < c.first + c.count; ++i) variance += length(vectorAt(deviations, i)) ** 2 / 3;
  return {
    measured: mean("reading.measured"),
    deviation: c.count > 0 ? Math.sqrt(variance) / c.count : 0,
    fitted: c.leftOut ? null : mean("reading.predicted"),
    heldOut: mean("reading.heldOut"),
  };
}

// Residuals of all fitted readings in standard deviations, and the root mean square of each case; null where nothing was
// fitted.
export function residuals(fit: Fit): { all: number[]; ofCase: MaybeNumber[] } {
  const [measured, predicted] = [fit.floats("reading.measured"), fit.floats("reading.predicted")];
  const deviation = fit.floats("reading.deviation");
  const all: number[] = [];
  const ofCase = fit.head.cases.map((c) => {
    if (c.leftOut || !c.ok) return null;
    const own: number[] = [];
    for (let i = 3 * c.first; i < 3 * (c.first + c.count); ++i) own.push((predicted[i] - measured[i]) / deviation[i]);
    for (const reading of [c.force, c.torque])
      if (reading?.predicted)
        for (let k = 0; k < 3; ++k) own.push((reading.predicted[k] - reading.measured[k]) / reading.deviation[k]);
    all.push(...own);
    return own.length > 0 ? Math.sqrt(own.reduce((sum, r) => sum + r * r, 0) / own.length) : null;
  });
  return { all, ofCase };
}

// Name of a marker in the data set.
export const markerName = (head: FitHead, marker: number): string => head.markerNames?.[marker] || String(marker + 1);

export interface WorstMarker {
  case: number;
  marker: number;
  error: Vec3; // predicted - measured [m]
  sigmas: number; // root mean square over the three coordinates, in standard deviations
}

// Readings with the largest residuals.
export function worstMarkers(fit: Fit, count: number, onlyCase: number | null = null): WorstMarker[] {
  const [measured, predicted] = [fit.floats("reading.measured"), fit.floats("reading.predicted")];
  const [deviation, marker] = [fit.floats("reading.deviation"), fit.indices("reading.marker")];
  const found: WorstMarker[] = [];
  fit.head.cases.forEach((c, index) => {
    if (!c.ok || (onlyCase !== null && index !== onlyCase)) return;
    for (let i = c.first; i < c.first + c.count; ++i) {
      const error = minus(vectorAt(predicted, i), vectorAt(measured, i));
      const sigmas = Math.hypot(...error.map((e, k) => e / deviation[3 * i + k])) / Math.sqrt(3);
      found.push({ case: index, marker: marker[i], error, sigmas });
    }
  });
  return found.sort((a, b) => b.sigmas - a.sigmas).slice(0, count);
}

// Counts of values in equal bins over [-limit, limit]. Values outside are in the outermost bins.
export function histogram(values: readonly number[], limit: number, bins: number): { middle: number[]; count: number[] } {
  const width = (2 * limit) / bins;
  const count = new Array<number>(bins).fill(0);
  for (const value of values)
    if (Number.isFinite(value)) ++count[Math.min(bins - 1, Math.max(0, Math.floor((value + limit) / width)))];
  return { middle: count.map((_, i) => -limit + (i + 0.5) * width), count };
}

// The program's verdict, and reasons other than the one in its text. Reports of older programs have only the status of the
// fit.
export function verdict({ verdict, fit }: FitHead): { text: string; kind: "good" | "bad" | "plain"; reasons: string[] } {
  if (verdict) {
    const { text, good, reasons } = verdict;
    return { text, kind: good ? "good" : "bad", reasons: reasons.map((reason) => reason.text).filter((reason) => !text.includes(reason)) };
  }
  if (fit.interrupted) return { text: "Interrupted before convergence. Run the same command with --resume to continue.", kind: "bad", reasons: [] };
  if (!fit.success) return { text: `Not converged: ${fit.words}. Do not rely on it.`, kind: "bad", reasons: [] };
  return { text: fit.words, kind: "plain", reasons: [] };
}

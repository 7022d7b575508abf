// A fit inside the page, as far as the page reads what apps/viewer/fit_page.cpp packs, and quantities derived from it.
import { Pack, unpacked } from "../../../web/src/pack";
import type { MaybeNumber, Vec3 } from "../../../web/src/protocol";
import { length, minus, vectorAt } from "../../../web/src/view/lens";

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
  varies: boolean; // over the body
  rows: ValueRow[];
}

export interface Case {
  name: string;
  group: string;
  first: number; // index of its first reading in the page
  count: number; // readings in the page
  hidden: number; // readings that are not in the page
  leftOut: boolean;
  ok: boolean;
}

interface Measure {
  name: string;
  unit: string;
}

// Figures of a case as in figures.json.
export interface CaseFigures {
  name: string;
  group: string;
  left_out: boolean;
  load: Measure & { value: number };
  // Predictions: corrected for the discretization error, as simulated on the mesh, and by a fit without the group.
  response: Measure & { deviation: number } & Record<"measured" | "fitted" | "on_mesh" | "held_out", MaybeNumber>;
  stiffness_unit: string; // of response over load; empty if that is no stiffness
  rms: MaybeNumber; // of the residuals [standard deviations]
  readings: number;
}

export type ReadingName = "position" | "force" | "torque";
export type PeakName = "motion" | "force" | "torque";
// Kinds of held-out readings.
export interface ReadingKind {
  name: ReadingName;
  peak: PeakName;
  unit: string;
}
export const kReadingKinds: readonly ReadingKind[] = [
  { name: "position", peak: "motion", unit: "m" },
  { name: "force", peak: "force", unit: "N" },
  { name: "torque", peak: "torque", unit: "N m" },
];

type GroupErrors = Record<`peak_${PeakName}` | `${ReadingName}_${"error" | "noise" | "beyond_noise"}`, MaybeNumber>;

export interface HeldOutGroup extends Partial<GroupErrors> {
  group: string;
  ok: boolean;
  failure: string;
  poor?: boolean; // above the limit of a single group
}

export type HeldOutFigures = Record<ReadingName | `largest_${PeakName}`, MaybeNumber> & {
  groups: HeldOutGroup[];
  poor: boolean;
  limits: Record<ReadingName | "single", number>;
};

export interface Comparison {
  models: ({ model: string } & Record<ReadingName, MaybeNumber>)[];
}

export interface Reason {
  name: string;
  text: string;
  value?: number;
  limit?: number;
}

// A systematic error of the instruments, in SI units.
export interface FoundError {
  name: string;
  unit: string;
  value: number;
  deviation?: number;
  prior_deviation: number;
  determined_by?: string;
  coefficient?: number; // friction, layer stiffness or rim in `unit`, whose logarithm has the error
  coefficient_95?: [number, number];
}

export interface LawFigures {
  law: string;
  ok: boolean;
  verdict: string;
  values?: Record<string, Record<string, { value: number; unit?: string }>>;
  squares_per_reading?: number;
  position_error?: number; // < 0: none
  force_error?: number;
  evidence_loss?: MaybeNumber;
  held_out_loss?: MaybeNumber;
}

type Ends = Record<"lower" | "upper", number>;

export interface HistoryFigures {
  name: string; // of the history
  reading: string; // "force", "motion of marker 3"
  unit: string;
  points: Record<"time" | "measured" | "sd" | "fitted", number>[];
}

export interface RelaxationFigures {
  squares_per_reading: number;
  readings: number;
  scale: Ends & { value: number; known?: boolean };
  branches: { ratio: number; ratio_interval: Ends; relaxation_time: number; time_interval: Ends }[];
  trials: { branches: number; failure: string; squares_per_reading: number; log_evidence: number }[];
  curves: HistoryFigures[];
}

// Parts of a stiffness field; the values table lists their values.
export interface PartsFigures {
  kept: boolean; // false: no division fits the measurements
  volumes: number[]; // fractions of the body
  contrast?: { value: number } & Partial<Ends>; // stiffest over softest
}

// figures.json as far as the page shows it
export interface Figures {
  residuals: number;
  parts?: PartsFigures;
  squares: number; // |r|^2
  groups: { group: string; readings: string; standard_deviations: number }[];
  truth?: { quantity: string; error: number; coverage: number }[]; // of synthetic data; coverage < 0: unknown
  errors?: FoundError[];
  common_errors?: { cause: string; standard_deviations: number }[];
  outliers?: { case: string; reading: string; weight: number }[];
  laws?: { chosen: string; text: string; trials: LawFigures[] };
  relaxation?: ({ ok: true } & RelaxationFigures) | { ok: false; failure: string };
  verdict: { good: boolean; text: string; reasons: Reason[] };
  limits: { missed: number; squares_per_reading: number };
  held_out: HeldOutFigures | null;
  comparison: Comparison[];
  cases: CaseFigures[];
  histogram: { limit: number; counts: number[] };
}

type WeightTrial = Record<"weight" | "misfit" | "roughness", MaybeNumber>; // misfit: |r|^2 / 2

export interface FitHead {
  format: number;
  name: string;
  version: string;
  model: string;
  counts: Record<"tets" | "markers" | "cases" | "parameters" | "residuals" | "equilibria", number>;
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
  figures: Figures;
  history: (WeightTrial & { decrement: MaybeNumber })[];
  weights: WeightTrial[];
  fibres: string[]; // directions
  notes: string[];
  warnings: string[];
  markerNames?: string[]; // names in the data set, in the order of the markers
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

// Curve of one group for a chart: load against response, with one standard deviation of the measurements.
export interface GroupCurve {
  x: { label: string; unit: string };
  y: { label: string; unit: string };
  samples: CaseFigures[]; // by ascending load
  leftOut: boolean;
}

export function groupCurve(figures: Figures, group: { cases: number[] }): GroupCurve {
  const samples = group.cases.map((c) => figures.cases[c]).sort((a, b) => a.load.value - b.load.value);
  const [{ load, response }] = samples;
  return { x: { label: load.name, unit: load.unit }, y: { label: response.name, unit: response.unit }, samples, leftOut: samples.some((c) => c.left_out) };
}

// Response over load, such as a force over a displacement; null without a load.
export function stiffness(figures: CaseFigures, response: MaybeNumber): MaybeNumber {
  return figures.stiffness_unit === "" || response === null || !(figures.load.value > 0) ? null : response / figures.load.value;
}

// Whether the correction for the discretization error changes predictions noticeably.
export const isCorrected = ({ cases }: Figures): boolean =>
  cases.some(({ response: { fitted, on_mesh: raw } }) => fitted !== null && raw !== null && Math.abs(fitted - raw) > 1e-6 * Math.abs(fitted));

// Name of a marker in the data set.
export const markerName = (head: FitHead, marker: number): string => head.markerNames?.[marker] || String(marker + 1);

export interface WorstMarker {
  case: number;
  marker: number;
  error: Vec3; // predicted - measured [m]
  onMesh: number; // length of the error without the correction for the discretization error [m]
  sigmas: number; // root mean square over the three coordinates, in standard deviations
}

// Readings with the largest residuals.
export function worstMarkers(fit: Fit, count: number, onlyCase: number | null = null): WorstMarker[] {
  const [measured, predicted, onMesh] = ["measured", "predicted", "onMesh"].map((name) => fit.floats(`reading.${name}`));
  const [deviation, marker] = [fit.floats("reading.deviation"), fit.indices("reading.marker")];
  const weights = new Map((fit.head.figures.outliers ?? []).map((o) => [`${o.case}\n${o.reading}`, o.weight]));
  const found: WorstMarker[] = [];
  fit.head.cases.forEach((c, index) => {
    if (!c.ok || (onlyCase !== null && index !== onlyCase)) return;
    for (let i = c.first; i < c.first + c.count; ++i) {
      const error = minus(vectorAt(predicted, i), vectorAt(measured, i));
      const weight = weights.get(`${c.name}\n${markerName(fit.head, marker[i])}`) ?? 1; // of the robust loss, within the deviation
      const sigmas = Math.hypot(...error.map((e, k) => e / deviation[3 * i + k])) / Math.sqrt(3 * weight);
      found.push({ case: index, marker: marker[i], error, onMesh: length(minus(vectorAt(onMesh, i), vectorAt(measured, i))), sigmas });
    }
  });
  return found.sort((a, b) => b.sigmas - a.sigmas).slice(0, count);
}

// The program's verdict, and all its reasons.
export function verdict({ verdict: { text, good, reasons } }: Figures): { title: string; kind: "good" | "bad"; reasons: string[] } {
  const texts = reasons.map((reason) => reason.text);
  const repeats = texts.some((reason) => text.includes(reason));
  return { title: good ? `Good. ${text}` : repeats ? "Do not rely on this material:" : text, kind: good ? "good" : "bad", reasons: texts };
}

// Value below which a fraction of the finite values lies, by linear interpolation.
export function percentile(values: ArrayLike<number>, fraction: number): number {
  const sorted = Array.from(values).filter(Number.isFinite).sort((a, b) => a - b);
  const at = fraction * (sorted.length - 1);
  const [low, high] = [sorted[Math.floor(at)] ?? NaN, sorted[Math.ceil(at)] ?? NaN];
  return low + (at - Math.floor(at)) * (high - low);
}

// Certificate of a run: convergence of its steps, residuals of the others, and the worst values with their steps.
import { statusName } from "../names";
import { short } from "../numbers";
import type { MaybeNumber, StepRow } from "../protocol";

// Residual relative to its threshold; above 1 the step missed it. Null if there is no threshold.
export function excess(row: StepRow): MaybeNumber {
  return row.residual === null || !row.residual_threshold ? null : row.residual / row.residual_threshold;
}

export interface Column {
  title: string;
  meaning: string;
  value: (row: StepRow) => MaybeNumber | string; // null: no value
  worse?: (row: StepRow) => number; // larger is worse; without it rows are ordered by step number
  isBad?: (row: StepRow) => boolean;
  whole?: (row: StepRow) => string; // complete value, where the cell is shortened
}

const kNoValue = -Infinity;

// Whether the energy bound was checked. Steps without a guarantee have only the slack.
function isBounded(row: StepRow): boolean {
  return row.energy_bound === "holds" || row.energy_bound === "broken";
}

function boundText(row: StepRow): string | null {
  if (row.energy_bound === "none") return null;
  if (row.energy_bound === "not_guaranteed") return "not guaranteed";
  return `${row.energy_bound} by ${short(Math.abs(row.energy_slack ?? 0))}`;
}

function boundBadness(row: StepRow): number {
  if (row.energy_bound === "none") return kNoValue;
  if (row.energy_bound === "holds") return -(row.energy_slack ?? 0);
  return row.energy_bound === "broken" ? Infinity : Number.MAX_VALUE;
}

// Three of the six numbers of each pin: the force (from 0) or the moment (from 3).
function reactionText(row: StepRow, first: 0 | 3): string | null {
  const pins = Object.entries(row.reactions ?? {});
  const vector = (values: MaybeNumber[]): string => values.slice(first, first + 3).map((value) => short(value)).join(", ");
  return pins.length ? pins.map(([pin, values]) => `${pin} (${vector(values)})`).join("; ") : null;
}

function largestFirst(title: string, meaning: string, value: (row: StepRow) => MaybeNumber): Column {
  return { title, meaning, value, worse: (row) => value(row) ?? kNoValue };
}

export const kColumns: Column[] = [
  { title: "step", meaning: "number of the time step", value: (row) => row.step },
  { title: "time [s]", meaning: "at the end of the step", value: (row) => row.time },
  {
    title: "status",
    meaning: "status of its minimization",
    value: (row) => statusName(row.status),
    worse: (row) => (row.converged ? 0 : 1),
    isBad: (row) => !row.converged,
  },
  largestFirst("residual [N]", "norm of M a + dV/dx + dD/dx over free vertices", (row) => row.residual),
  { title: "threshold [N]", meaning: "largest residual of a converged step", value: (row) => row.residual_threshold || null },
  {
    ...largestFirst("residual / threshold", "above 1: the step missed the threshold", excess),
    isBad: (row) => (excess(row) ?? 0) > 1,
  },
  largestFirst(
    "decrement [J]",
    "decrease of E that the last direction predicts: a measure of the distance from the minimum",
    (row) => row.decrement,
  ),
  largestFirst("iterations", "of the minimizer", (row) => row.iterations.length),
  {
    title: "min det F",
    meaning: "smallest volume of a tet relative to its rest volume; below 0: inverted",
    value: (row) => row.min_det_F,
    worse: (row) => (row.min_det_F === null ? Infinity : -row.min_det_F),
    isBad: (row) => (row.min_det_F ?? 1) <= 0,
  },
  {
    title: "ledger error [J]",
    meaning: "imbalance of the energy ledger",
    value: (row) => row.ledger_error,
    worse: (row) => (row.ledger_error === null ? Infinity : Math.abs(row.ledger_error)),
  },
  { title: "reactions [N]", meaning: "force of each pin on its vertices (x, y, z)", value: (row) => reactionText(row, 0) },
  { title: "moments [N m]", meaning: "moment of each pin's forces on its vertices about the origin (x, y, z)", value: (row) => reactionText(row, 3) },
  {
    title: "energy bound [J]",
    meaning: "guarantee of backward Euler: V + 1/2 |change of velocity|² in the mass norm does not exceed the previous energy plus works",
    value: boundText,
    worse: boundBadness,
    isBad: (row) => row.energy_bound === "broken",
  },
  {
    title: "state",
    meaning: "hash of positions and velocities at the end of the step; equal for bit-reproducible runs",
    value: (row) => row.state_hash?.slice(0, 8) ?? null,
    whole: (row) => row.state_hash ?? "",
  },
];

// Columns that have a value in some row: a scene without pins has no reactions.
export function withValues(steps: readonly StepRow[]): Column[] {
  return kColumns.filter(({ value }) => steps.length === 0 || steps.some((row) => value(row) !== null));
}

// Rows to list: the worst by a column first, or in order of time.
export function listed(steps: readonly StepRow[], column: Column, onlyFailed: boolean): StepRow[] {
  const rows = onlyFailed ? steps.filter((row) => !row.converged) : [...steps];
  const worse = column.worse;
  return worse ? rows.sort((a, b) => compare(worse(b), worse(a)) || a.step - b.step) : rows;
}

// Compares equal infinities as equal; their difference is NaN.
function compare(a: number, b: number): number {
  return a < b ? -1 : a > b ? 1 : 0;
}

export function totals(steps: readonly StepRow[]) {
  const worst = (badness: (row: StepRow) => MaybeNumber): StepRow | null =>
    steps.reduce<StepRow | null>((found, row) => {
      const value = badness(row);
      return value !== null && (!found || value > (badness(found) as number)) ? row : found;
    }, null);
  return {
    steps: steps.length,
    failed: steps.filter((row) => !row.converged).length,
    iterations: steps.reduce((sum, row) => sum + row.iterations.length, 0),
    worstExcess: worst(excess),
    smallestVolume: worst((row) => (row.min_det_F === null ? null : -row.min_det_F)),
    inverted: steps.filter((row) => row.min_det_F !== null && row.min_det_F <= 0).length, // at the end of the step
    largestError: worst((row) => (row.ledger_error === null ? null : Math.abs(row.ledger_error))),
    bounded: steps.filter(isBounded).length,
    held: steps.filter((row) => row.energy_bound === "holds").length,
    smallestSlack: worst((row) => (isBounded(row) ? -(row.energy_slack ?? 0) : null)),
    state: steps.reduce<StepRow | null>((found, row) => (row.state_hash ? row : found), null), // the last row with a hash
  };
}

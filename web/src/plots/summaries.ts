// Sentences about a minimization that follow from its numbers.
import type { IterationRow, MaybeNumber, Setting, StepRow } from "../protocol";
import { explanationText, statusName } from "../names";
import { plural, short, withUnit } from "../numbers";

export type Pace = "squaring" | "faster" | "steady" | "none";

// Rate at which the gradient's norm fell.
export function pace(norms: readonly MaybeNumber[]): { pace: Pace; factor: number } {
  const known = norms.filter((n): n is number => n !== null && n > 0);
  const falls = known.slice(1).map((norm, i) => Math.log(known[i]! / norm));
  const none = { pace: "none" as const, factor: 1 };
  if (falls.length < 2 || known[known.length - 1]! >= known[0]!) return none;
  const [before, last] = falls.slice(-2) as [number, number];
  // |g| -> C |g|^p: two consecutive reductions determine p. Below a factor of 3 they do not.
  if (before > Math.log(3) && last / before >= 1.7) return { pace: "squaring", factor: Math.exp(last) };
  if (before > 0 && last > 1.2 * before) return { pace: "faster", factor: Math.exp(last) };
  const late = falls.slice(-Math.max(2, Math.ceil(falls.length / 2)));
  const mean = late.reduce((sum, fall) => sum + fall, 0) / late.length;
  const isSteady = Math.min(...late) > 0 && Math.max(...late) - Math.min(...late) <= 0.7 * mean;
  return isSteady ? { pace: "steady", factor: Math.exp(mean) } : none;
}

function paceText(rows: readonly IterationRow[]): string {
  const found = pace(rows.map((row) => row.gradient_norm));
  const factor = short(Number(found.factor.toPrecision(found.factor < 2 ? 3 : 2)));
  switch (found.pace) {
    case "squaring":
      return ` The gradient fell faster in each iteration, the last time by a factor of ${factor}: near the minimum each iteration about squares the error.`;
    case "faster":
      return ` The gradient fell faster from one iteration to the next, the last time by a factor of ${factor}.`;
    case "steady":
      return ` Each iteration divided the gradient by about ${factor}.`;
    case "none":
      return "";
  }
}

function residualText(row: StepRow): string {
  if (row.residual === null || row.residual_threshold === null) return "";
  return `the residual, ${withUnit(row.residual, "N", 3)}, is ${row.residual <= row.residual_threshold ? "below" : "above"} the threshold of ${withUnit(row.residual_threshold, "N", 3)}`;
}

function shortened(rows: readonly IterationRow[]): string {
  const less = rows.filter((row) => row.trials.some((trial) => !trial.accepted)).length;
  return less > 0 ? ` In ${plural(less, "iteration")} the line search rejected the first trial and accepted a shorter step.` : "";
}

export function stepText(row: StepRow, implicit: boolean, settings: readonly Setting[]): string {
  if (row.explanation) return explanationText(row.explanation, settings).join(" ");
  if (!implicit) return "This integrator does not minimize: it computes the next positions from the present forces.";
  const count = plural(row.iterations.length, "iteration");
  const residual = residualText(row);
  const met = residual || "the criterion is met";
  if (!row.converged) return `Not converged (${statusName(row.status)}) after ${count}${residual && `: ${residual}`}.`;
  if (row.iterations.length === 0)
    return `Converged: ${met}. It needed no iteration, or its iterations are no longer stored.`;
  if (row.status === "round_off")
    return `Converged to round-off after ${count}: the energy no longer changes by more than round-off.`;
  return `Converged in ${count}: ${met}.${paceText(row.iterations)}${shortened(row.iterations)}`;
}

export function totalSeconds(row: IterationRow): number {
  return Object.values(row.seconds).reduce((sum, seconds) => sum + seconds, 0);
}

// E of the iterates above the lowest one; null for that one, which a logarithmic axis cannot show.
export function aboveLowest(values: readonly MaybeNumber[]): MaybeNumber[] {
  const known = values.filter((v): v is number => v !== null);
  const lowest = known.reduce((low, v) => Math.min(low, v), Infinity);
  return values.map((v) => (v === null || v <= lowest ? null : v - lowest));
}

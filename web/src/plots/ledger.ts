// Energy of one side step by step: states as they are, works and losses summed up.
import type { MaybeNumber, StepRow } from "../protocol";
import type { Curve } from "./chart";
import { extremes } from "../view/ranges";
import { lowerBound } from "./table";
import { finite, short, withUnit } from "../numbers";
import { furtherColor, type Color } from "./palette";

// Colors of the curves that most scenes have. The others get those of the remaining families of hues, so that no two
// curves of a plot look alike.
const kOwnColors: Record<string, Color> = { kinetic: "series2", potential_total: "series1", total: "text", damping_loss: "series7", numerical_loss: "bad", balance: "good" };
const kFreeColors: Color[] = ["series4", "series5", "series10", "series8", "series9", "series12"];

export class CurveColors {
  private readonly given = new Map<string, Color>();

  // Color of the curve with this key; the same at each call.
  of(key: string): Color {
    const known = kOwnColors[key] ?? this.given.get(key);
    if (known) return known;
    const color = kFreeColors[this.given.size] ?? furtherColor(this.given.size);
    this.given.set(key, color);
    return color;
  }
}

const kWide = { width: 2 };
const kWider = { width: 2.5 };
const kSum = { dash: [2, 3] }; // of sums over the steps

type Column = Omit<Curve, "color">;

export function ledgerColumns(potentials: readonly string[]): Column[] {
  const line = (key: string, label: string, meaning: string, more: Partial<Curve>): Column => ({ key, label, meaning, width: 1.5, ...more });
  const terms = potentials.map((name) => line(`potential_${name}`, `V: ${name.replaceAll("_", " ")}`, "a term of the potential energy", { width: 1.25 }));
  const summed = (key: string, label: string, meaning: string): Column => line(key, label, `${meaning}, summed over the steps`, kSum);
  return [
    line("kinetic", "T", "kinetic energy", kWide),
    ...terms,
    line("potential_total", "V", "potential energy, the sum of its terms", kWide),
    line("total", "T + V", "kinetic plus potential energy", kWider),
    summed("mouse_work", "work of the mouse", "work of the mouse's spring"),
    summed("tool_work", "work of the tool", "work of the indenter"),
    summed("pin_work", "work of pins", "work of moving pins"),
    summed("load_work", "work of loads", "work of moving spring targets and time-dependent loads"),
    summed("muscle_work", "work of muscles", "work of changing activations"),
    summed("obstacle_work", "work of obstacles, wind and pressures", "work of moving obstacles, of wind, and of pressures on open patches beyond the change of their potential"),
    summed("damping_loss", "dissipation", "dissipated by damping and friction"),
    summed("numerical_loss", "numerical loss", "dissipated by the integrator"),
    line("balance", "balance", "T + V − works + losses: constant if every step is solved accurately", kWider),
  ];
}

const kAlways = ["total", "balance"];
const kRoundOff = 1e-12; // relative to the largest energy; smaller values are zero
const kExplosion = 1e3; // relative to the initial energy and the works

// Limit of stored steps. Beyond it every other step of the older half is dropped.
const kMostSteps = 100_000;

export class Ledger {
  readonly step: number[] = [];
  readonly time: number[] = [];
  readonly columns: MaybeNumber[][];
  readonly residualWork: MaybeNumber[] = []; // work of the residual in each step
  readonly ledgerError: MaybeNumber[] = [];
  private readonly lowest: number[] = []; // smallest balance so far
  private readonly highest: number[] = [];
  private readonly largest: number[] = []; // largest magnitude of each column so far
  private readonly peak: number[] = []; // largest T + V so far
  private readonly given: number[] = []; // largest of the initial energy and the works so far
  private readonly first: (number | undefined)[]; // first step at which each column exceeds round-off

  constructor(readonly potentials: readonly string[]) {
    this.columns = ledgerColumns(potentials).map(() => []);
    this.first = this.columns.map(() => undefined);
  }

  // Updates the steps after number `from` from `rows`, which are consecutive; earlier steps do not change.
  update(rows: readonly StepRow[], from: number): void {
    const keep = lowerBound(this.step, from + 0.5);
    for (const column of this.all()) column.length = keep;
    this.first.forEach((at, i) => (this.first[i] = at !== undefined && at < keep ? at : undefined));
    const known = this.step[keep - 1] ?? -Infinity;
    const first = rows[0]?.step ?? 0;
    for (let i = Math.max(0, known + 1 - first); i < rows.length; ++i) this.append(rows[i]!);
    if (this.step.length > kMostSteps) this.thinOut();
  }

  private all(): MaybeNumber[][] {
    const running = [this.lowest, this.highest, this.largest, this.peak, this.given];
    return [this.step, this.time, this.residualWork, this.ledgerError, ...running, ...this.columns];
  }

  private thinOut(): void {
    const old = this.step.length / 2;
    for (const column of this.all()) {
      const kept = column.filter((_, i) => i >= old || i % 2 === 0);
      column.length = kept.length;
      kept.forEach((value, i) => (column[i] = value));
    }
    this.columns.forEach((column, i) => {
      if (this.first[i] !== undefined) this.first[i] = Math.max(0, column.findIndex((value) => value !== 0));
    });
  }

  // Columns to show: those that ever exceeded round-off or are unknown, and the sums T + V and balance.
  used(): string[] {
    const columns = ledgerColumns(this.potentials);
    return columns.filter(({ key }, i) => kAlways.includes(key) || this.first[i] !== undefined).map(({ key }) => key);
  }

  // Largest T + V if it is far above the initial energy and all works, so that the integrator has created it; otherwise
  // null.
  exploded(): number | null {
    const last = this.step.length - 1;
    if (last < 0) return null;
    if (this.columns[this.totalColumn]![last] === null) return Infinity;
    const peak = this.peak[last]!;
    return peak > kExplosion * this.given[last]! && peak > 0.1 * this.largest[last]! ? peak : null;
  }

  private get totalColumn(): number {
    return this.potentials.length + 2;
  }

  // Range of the balance since the first step, and the largest energy so far.
  drift(): { drift: number; scale: number } {
    const last = this.step.length - 1;
    return { drift: last < 0 ? 0 : this.highest[last] - this.lowest[last], scale: this.largest[last] ?? 0 };
  }

  private append(row: StepRow): void {
    const last = this.step.length - 1;
    const terms = this.potentials.map((_, i) => row.potential[i] ?? null);
    const potential = sum(terms);
    const total = sum([row.kinetic, potential]);
    const [loads, muscles] = [row.load_work ?? 0, row.muscle_work ?? 0];
    const pins = sum([row.pin_work, -loads, -muscles]);
    const flows = [row.mouse_work, row.tool_work, pins, loads, muscles, (row.obstacle_work ?? 0) + (row.nonconservative_work ?? 0), row.damping_loss, row.numerical_loss];
    const firstFlow = this.totalColumn + 1;
    const sums = flows.map((flow, i) => sum([last < 0 ? 0 : this.columns[firstFlow + i]![last]!, flow]));
    const works = sums.slice(0, -2);
    const balance = sum([total, ...works.map(negated), ...sums.slice(-2)]);
    const values = [row.kinetic, ...terms, potential, total, ...sums, balance];
    const largest = Math.max(this.largest[last] ?? 0, ...values.map((v) => Math.abs(v ?? 0)));
    values.forEach((value, i) => {
      if (value === null || Math.abs(value) > kRoundOff * largest) this.first[i] ??= this.step.length;
      this.columns[i]!.push(value);
    });
    const given = works.reduce((all: number, work) => all + Math.abs(work ?? 0), 0);
    this.peak.push(Math.max(this.peak[last] ?? 0, total ?? 0));
    this.given.push(Math.max(this.given[last] ?? Math.abs(balance ?? 0), given));
    this.lowest.push(Math.min(this.lowest[last] ?? Infinity, balance ?? Infinity));
    this.highest.push(Math.max(this.highest[last] ?? -Infinity, balance ?? -Infinity));
    this.largest.push(largest);
    this.step.push(row.step);
    this.time.push(row.time ?? NaN);
    this.residualWork.push(row.residual_work);
    this.ledgerError.push(row.ledger_error);
  }
}

const kDwarfs = 1e3; // factor beyond which the other curve is indistinguishable from zero

// Range for two sides of which one has blown up: about the energies of the calmer one. Null: both fit.
export function calmRange(one: Ledger, other: Ledger): [number, number] | null {
  const [calm, wild] = one.drift().scale <= other.drift().scale ? [one, other] : [other, one];
  const scale = calm.drift().scale;
  if (!(scale > 0) || wild.drift().scale <= kDwarfs * scale) return null;
  const [low, high] = extremes(calm.columns.flatMap((column) => [0, ...finite(column)])) ?? [0, 0];
  return [2 * low, 2 * high];
}

// Sum of the parts; null if a part is null.
function sum(parts: readonly MaybeNumber[]): MaybeNumber {
  return parts.reduce<MaybeNumber>((total, part) => (total === null || part === null ? null : total + part), 0);
}

function negated(value: MaybeNumber): MaybeNumber {
  return value === null ? null : -value;
}

export function explosionText(peak: number): string {
  return Number.isFinite(peak) ? `exploded: T + V rose to ${withUnit(peak, "J", 3)} without work` : "exploded: T + V is not finite";
}

export function balanceText(drift: number, scale: number): string {
  const part = scale > 0 ? drift / scale : 0;
  if (part <= 1e-3) return `balance flat to ${withUnit(drift, "J", 2)} (${short(part, 2)} of the largest energy)`;
  return `balance drifts by ${withUnit(drift, "J", 2)} (${short(part, 2)} of the largest energy): some steps were not solved accurately`;
}

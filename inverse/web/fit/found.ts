// What a fit has found beside the material: systematic errors, outliers, laws, and relaxation.
import { element, type Child } from "../../../web/src/dom";
import { Chart, type FilledCurve } from "../../../web/src/plots/chart";
import { short } from "../../../web/src/numbers";
import { digitsOf, failedRow, intervalText, percent, row, valueText } from "./cells";
import type { Figures, FoundError, HistoryFigures, LawFigures, PartsFigures, RelaxationFigures } from "./data";
import { numberTable } from "./numberTable";

const kLargeError = 3; // estimate in prior standard deviations that is marked

function interval95({ value, deviation, unit, coefficient_95: of }: FoundError): string {
  if (deviation === undefined) return "–";
  return of ? intervalText(of[0], of[1], unit) : intervalText(value - 1.96 * deviation, value + 1.96 * deviation, unit);
}

function errorRow(e: FoundError): HTMLElement {
  const ratio = e.prior_deviation > 0 ? Math.abs(e.value) / e.prior_deviation : 0;
  return row(e.name, [valueText(e.coefficient ?? e.value, e.unit, 3), interval95(e), priorText(e), `${short(ratio, 2)} sd`, e.determined_by ?? "–"], ratio > kLargeError ? "large" : "");
}

function priorText({ prior_deviation: deviation, unit, value, coefficient }: FoundError): string {
  if (coefficient === undefined) return `0 ± ${valueText(deviation, unit, 3)}`;
  return `${valueText(coefficient / Math.exp(value), unit, 3)}, logarithm ± ${short(deviation, 3)}`;
}

export function errorTable({ errors }: Figures): HTMLElement | null {
  if (!errors || errors.length === 0) return null;
  const unitless = (e: FoundError): FoundError => (e.unit === "" && e.coefficient === undefined ? { ...e, name: `${e.name} (logarithm of the factor)` } : e);
  return numberTable(["error", "estimate", "95 % interval", "prior", "estimate / prior sd", "determined by"], 1, element("tbody", {}, ...errors.map((e) => errorRow(unitless(e)))));
}

export function partsText({ kept, volumes, contrast }: PartsFigures): string {
  if (!kept || !contrast) return "No division into parts fits the measurements as well as the field.";
  const { value, lower = null, upper = null } = contrast;
  const interval = lower === null ? "" : ` (95 %: ${intervalText(lower, upper, "")})`;
  const shares = volumes.map((volume, k) => `${k === 0 ? "Part" : "part"} ${k + 1} is ${percent(volume)} of the body`);
  return `${shares.join(", ")}. The stiffest is ${short(value, digitsOf(lower, upper))} times as stiff as the softest${interval}.`;
}

export function outlierTable({ outliers }: Figures): HTMLElement | null {
  if (!outliers || outliers.length === 0) return null;
  const rows = outliers.map((o) => row(o.case, [/^(force|torque)$/.test(o.reading) ? o.reading : `marker ${o.reading}`, percent(o.weight)]));
  return numberTable(["case", "reading", "weight"], 1, element("tbody", {}, ...rows));
}

function lawValues(law: LawFigures): string {
  const byName = Object.entries(law.values ?? {}).sort(([a], [b]) => Number(b === "young") - Number(a === "young"));
  const all = byName.flatMap(([name, places]) => Object.entries(places).map(([where, v]) => `${name}${where === "everywhere" ? "" : ` (${where})`} ${valueText(v.value, v.unit ?? "", 4)}`));
  return all.join(", ");
}

export function lawTable(laws: NonNullable<Figures["laws"]>): HTMLElement {
  const rows = laws.trials.map((t) => {
    if (!t.ok) return failedRow(t.law, t.verdict, 7);
    const losses = [t.evidence_loss, t.held_out_loss].map((loss) => (loss === null || loss === undefined ? "–" : short(-loss, 3)));
    const cells = [short(t.squares_per_reading, 3), ...losses, percent(t.position_error), percent(t.force_error)];
    const texts = [lawValues(t), t.verdict].map((text) => element("td", { class: "prose" }, text));
    return element("tr", { class: t.law === laws.chosen ? "total" : "" }, element("th", { scope: "row" }, t.law), ...cells.map((text) => element("td", { class: "number" }, text)), ...texts);
  });
  const table = numberTable(["law", "|r|² per reading", "log evidence", "held-out log probability", "held-out positions", "held-out forces", "values", "result"], 1, element("tbody", {}, ...rows));
  for (const head of [...table.querySelectorAll("thead th")].slice(-2)) head.className = "";
  return table;
}

export function branchTable(relaxation: RelaxationFigures): HTMLElement {
  const line = (name: string, value: number, ends: { lower: number; upper: number }, unit: string): HTMLElement =>
    row(name, [valueText(value, unit, digitsOf(ends.lower, ends.upper)), intervalText(ends.lower, ends.upper, unit)]);
  const rows = relaxation.branches.flatMap((b, i) => [
    line(`branch ${i + 1}: relaxation time`, b.relaxation_time, b.time_interval, "s"),
    line(`branch ${i + 1}: shear modulus / that of the material`, b.ratio, b.ratio_interval, ""),
  ]);
  if (!relaxation.scale.known) rows.push(line("long-term stiffness / that of the first fit (included above)", relaxation.scale.value, relaxation.scale, ""));
  return numberTable(["relaxation", "value", "95 % interval"], 1, element("tbody", {}, ...rows));
}

export function trialTable(relaxation: RelaxationFigures): HTMLElement | null {
  if (relaxation.trials.length < 2) return null;
  const rows = relaxation.trials.map((t) =>
    t.failure === "" ? row(String(t.branches), [short(t.squares_per_reading, 3), short(t.log_evidence, 4)], t.branches === relaxation.branches.length ? "total" : "") : failedRow(String(t.branches), t.failure, 2),
  );
  return numberTable(["branches", "|r|² per reading", "log evidence"], 1, element("tbody", {}, ...rows));
}

// On a logarithmic axis, so without a reading at the time 0.
function historyChart(curve: HistoryFigures): Chart {
  const points = curve.points.filter((p) => p.time > 0);
  const curves: FilledCurve[] = [
    { key: "fitted", label: "fitted", meaning: "predicted with the fitted branches", color: "series1", width: 2, values: points.map((p) => p.fitted) },
    { key: "measured", label: "measured", color: "text", shape: "points", values: points.map((p) => p.measured) },
  ];
  return Chart.of(points.map((p) => Math.log10(p.time)), curves, {
    label: `${curve.name}: ${curve.reading} against the logarithm of time`,
    x: { label: "log₁₀ of the time [s]" },
    y: { label: curve.reading, unit: curve.unit },
    showsLast: true,
  });
}

export function historyFigures({ curves }: RelaxationFigures): Child[] {
  return curves.map((c) => element("figure", {}, element("figcaption", {}, `${c.name}: ${c.reading}`), historyChart(c).element));
}

// Charts of a fit: force against depth, residuals, trial weights, convergence.
import type uPlot from "uplot";
import { Chart, type FilledCurve } from "../../../web/src/plots/chart";
import { finite, short } from "../../../web/src/numbers";
import type { Palette } from "../../../web/src/plots/palette";
import { inkOn } from "../../../web/src/plots/painting";
import { nearest } from "../../../web/src/plots/table";
import type { MaybeNumber } from "../../../web/src/protocol";
import { text } from "../../../web/src/view/marks";
import { closeness, isCorrected, type FitHead, type Figures, type GroupCurve } from "./data";

// Error bars of one standard deviation, in device pixels.
function paintErrorBars(u: uPlot, colors: Palette, curve: GroupCurve): void {
  const { ctx } = u;
  ctx.save();
  ctx.strokeStyle = colors.text;
  ctx.lineWidth = devicePixelRatio;
  const cap = 4 * devicePixelRatio;
  ctx.beginPath();
  for (const { load, response: { measured, deviation } } of curve.samples) {
    if (measured === null) continue;
    const column = u.valToPos(load.value, "x", true);
    const [top, bottom] = [measured + deviation, measured - deviation].map((y) => u.valToPos(y, "y", true));
    ctx.moveTo(column, top);
    ctx.lineTo(column, bottom);
    for (const y of [top, bottom]) {
      ctx.moveTo(column - cap, y);
      ctx.lineTo(column + cap, y);
    }
  }
  ctx.stroke();
  ctx.restore();
}

function around(values: readonly MaybeNumber[], includeZero: boolean): [number, number] {
  const known = [...finite(values), ...(includeZero ? [0] : [])];
  const [low, high] = [Math.min(...known), Math.max(...known)];
  const margin = 0.07 * (high - low) || 1e-9;
  return [low === 0 ? 0 : low - margin, high + margin];
}

export function loadChart(name: string, curve: GroupCurve, figures: Figures): Chart {
  const { samples } = curve;
  const x = samples.map((s) => s.load.value);
  const [fitted, onMesh, heldOut, measured] = (["fitted", "on_mesh", "held_out", "measured"] as const).map((key) => samples.map((s) => s.response[key]));
  const shape = x.length > 2 ? "line" : "both";
  const all: FilledCurve[] = [
    { key: "fitted", label: "fitted", meaning: "predicted by the fitted material, corrected for the discretization error", color: "series1", width: 2, shape, values: fitted },
    { key: "onMesh", label: "on the mesh", meaning: "the same as simulated, without the correction", color: "series3", width: 1.5, dash: [2, 3], shape, values: isCorrected(figures) ? onMesh : x.map(() => null) },
    { key: "heldOut", label: curve.leftOut ? "predicted" : "held out", meaning: "predicted by a fit without this group, corrected", color: "series2", width: 2, dash: [6, 4], shape, values: heldOut },
    { key: "measured", label: "measured", meaning: "measured, ± one standard deviation", color: "text", shape: "points", values: measured },
  ];
  const curves = all.filter(({ key, values }) => key === "measured" || values.some((v) => v !== null));
  const spread = samples.flatMap(({ response: { measured: m, deviation } }) => (m === null ? [] : [m - deviation, m + deviation]));
  return Chart.of(x, curves, {
    label: `${name}: ${curve.y.label} against ${curve.x.label}, measured and fitted`,
    x: { label: curve.x.label, unit: curve.x.unit },
    y: curve.y,
    showsLast: true,
    xRange: () => around(x, true),
    yRange: () => around([...spread, ...curves.flatMap(({ values }) => values)], true),
    paint: (u, colors) => paintErrorBars(u, colors, curve),
  });
}

// Histogram of residuals beside the expected counts for normally distributed noise.
export function histogramChart({ histogram: { limit, counts: count } }: Figures): Chart {
  const width = (2 * limit) / count.length;
  const middle = count.map((_, i) => -limit + (i + 0.5) * width);
  const total = count.reduce((sum, n) => sum + n, 0);
  const normal = middle.map((r) => (total * width * Math.exp((-r * r) / 2)) / Math.sqrt(2 * Math.PI));
  const curves: FilledCurve[] = [
    { key: "count", label: "residuals", meaning: `(fitted − measured) / standard deviation; values beyond ±${limit} are in the outermost bins`, color: "series1", shape: "bars", values: count },
    { key: "normal", label: "normal", meaning: "expected from noise with the given standard deviations", color: "series2", width: 2, values: normal },
  ];
  return Chart.of(middle, curves, {
    label: "Histogram of the residuals",
    x: { label: "residual [standard deviations]" },
    y: { label: "number of coordinates" },
    xRange: () => [-limit, limit],
    yRange: () => [0, 1.08 * Math.max(...count, ...normal, 1)],
  });
}

const log10 = (value: MaybeNumber): MaybeNumber => (value !== null && value > 0 ? Math.log10(value) : null);

// Misfit against roughness, both as powers of ten. The chosen weight is highlighted.
export function weightChart(head: FitHead): Chart | null {
  const trials = head.weights
    .map((w) => ({ x: log10(w.roughness), misfit: w.misfit, weight: w.weight }))
    .filter((w): w is { x: number; misfit: number; weight: number } => w.x !== null && w.misfit !== null && w.weight !== null)
    .sort((a, b) => a.x - b.x);
  if (trials.length < 2) return null;
  const x = trials.map((t) => t.x);
  const misfit = trials.map((t) => closeness(t.misfit, head.counts.residuals) ?? 0);
  const log = Math.max(...misfit) > 30 * Math.min(...misfit);
  const curves: FilledCurve[] = [
    { key: "trials", label: "trial weights", color: "series1", width: 2, shape: "both", values: misfit },
    { key: "target", label: "noise", meaning: "1: consistent with the standard deviations", color: "series7", dash: [6, 4], values: x.map(() => 1) },
  ];
  return Chart.of(x, curves, {
    label: "Misfit against roughness for every trial weight",
    x: { label: "log₁₀ of the roughness R (no unit)" },
    y: { label: "|r|² per reading (no unit)", log },
    read: (key, at) => (key === "trials" && at !== null ? [`weight ${short(trials[nearest(x, at)].weight, 3)}`] : []),
    xRange: () => around([...x, log10(head.fit.roughness)], false),
    yRange: () => (log ? null : around([...misfit, 1], true)),
    paint: (u, colors) => paintChosen(u, colors, log10(head.fit.roughness), closeness(head.fit.misfit, head.counts.residuals), `chosen: ${short(head.fit.weight, 3)}`),
  });
}

function paintChosen(u: uPlot, colors: Palette, x: MaybeNumber, y: MaybeNumber, words: string): void {
  if (x === null || y === null || !(y > 0)) return;
  const ink = inkOn(u, colors, colors.series2);
  const [column, row] = [u.valToPos(x, "x", true), u.valToPos(y, "y", true)];
  ink.context.strokeStyle = colors.series2;
  ink.context.lineWidth = 0.2 * ink.em;
  ink.context.beginPath();
  ink.context.arc(column, row, 0.6 * ink.em, 0, 2 * Math.PI);
  ink.context.stroke();
  const leftwards = column > u.bbox.left + 0.6 * u.bbox.width;
  text(ink, words, column + (leftwards ? -0.4 : 0.4) * ink.em, row - 1.4 * ink.em, leftwards ? "right" : "left");
  ink.context.restore();
}

// History of all iterations in order, over all starts and weights.
export function historyChart(head: FitHead): Chart | null {
  if (head.history.length < 3) return null;
  const x = head.history.map((_, i) => i + 1);
  const positive = (value: MaybeNumber): MaybeNumber => (value !== null && value > 0 ? value : null);
  const misfit = head.history.map((i) => positive(i.misfit));
  const prior = head.history.map((i) => (i.roughness === null || i.weight === null ? null : positive(i.roughness * i.weight)));
  const decrement = head.history.map((i) => positive(i.decrement));
  const curves: FilledCurve[] = [
    { key: "misfit", label: "misfit", meaning: "|r|²/2", color: "series1", width: 2, shape: "both", values: misfit },
    { key: "prior", label: "weight · R", meaning: "penalty of smoothness and prior", color: "series3", width: 2, shape: "both", values: prior },
    { key: "decrement", label: "decrement", meaning: "distance from the minimum in posterior standard deviations", color: "series2", width: 1.5, dash: [6, 4], shape: "both", values: decrement },
  ];
  return Chart.of(x, curves, {
    label: "Misfit, prior and decrement over the iterations",
    x: { label: "iteration", integer: true },
    y: { label: "objective (no unit)", log: true },
    showsLast: true,
  });
}

// E along the direction d: the curve, its quadratic model, the acceptance test of the line search, and its trials.
import type uPlot from "uplot";
import type { IterationReply, MaybeNumber, TrialRow } from "../protocol";
import { Chart, type Curve } from "./chart";
import { short } from "./numbers";
import type { Palette } from "./palette";
import { nearest } from "./table";
import { paintVerticalLine } from "./verticalLine";

export interface Search {
  curve: IterationReply["curve"];
  trials: TrialRow[];
  maxStep?: MaybeNumber; // largest alpha that contact allows
  test: string; // acceptance test: "textbook", "slide" or "none"
  about?: string; // the iteration, where it is not clear from the context
}

// Range of the axis: the valley, and trials unless they dwarf it. Values are differences from E at alpha 0.
export function searchRange(
  values: readonly MaybeNumber[],
  model: readonly MaybeNumber[],
  trials: readonly MaybeNumber[],
): [number, number] {
  const known = (list: readonly MaybeNumber[]): number[] =>
    list.filter((v): v is number => v !== null && Number.isFinite(v));
  const lowest = Math.min(0, ...known(values), ...known(trials));
  const promised = Math.min(0, ...known(model));
  const depth = -lowest || -promised || Math.max(...known(values).map(Math.abs), 1e-300);
  const low = Math.max(Math.min(lowest, promised), -2 * depth); // a model without a minimum has no lower bound
  const high = [...known(values), ...known(trials)].filter((v) => v > 0 && v <= 4 * depth);
  const top = Math.min(4 * depth, Math.max(0.25 * depth, ...high));
  const margin = 0.07 * (top - low);
  return [low - margin, top + margin];
}

// Range of alpha: all trials; or the surroundings of the accepted one if it is much shorter and the curve is known
// there.
export function alphaRange(alpha: readonly number[], trials: readonly TrialRow[]): [number, number] {
  const [first, last] = [alpha[0] ?? 0, alpha[alpha.length - 1] ?? 1];
  const accepted = trials.find((trial) => trial.accepted)?.alpha ?? 0;
  const [low, high] = [-0.5 * accepted, 3 * accepted];
  const known = alpha.filter((a) => a >= low && a <= high).length;
  return accepted > 0 && last > 2 * high && known >= 12 ? [Math.max(low, first), high] : [first, last];
}

export class SearchChart {
  readonly chart = new Chart();
  private search: Search | null = null;

  constructor(private readonly symbol = "E") {}

  get element(): HTMLElement {
    return this.chart.element;
  }

  show(search: Search | null): void {
    this.search = search;
    if (!search) {
      this.chart.element.hidden = true;
      return;
    }
    this.chart.element.hidden = false;
    this.chart.configure({
      label: "E along the direction d",
      x: { label: "α" },
      y: { label: `${this.symbol} − ${this.symbol}(α = 0)` },
      curves: curvesOf(search, this.symbol),
      read: (key, alpha) => this.read(key, alpha),
      xRange: () => alphaRange(search.curve.alpha, search.trials),
      yRange: () => this.range(),
      paint: (u, colors) => {
        this.paintLimit(u, colors);
        this.paintTrials(u, colors);
      },
    });
    const { alpha } = search.curve;
    this.chart.show(alpha, this.columns());
  }

  private origin(): number {
    const { curve } = this.search!;
    return curve.value[nearest(curve.alpha, 0)] ?? curve.model[nearest(curve.alpha, 0)] ?? 0;
  }

  private columns(): MaybeNumber[][] {
    const { curve, test } = this.search!;
    const origin = this.origin();
    const [low, high] = this.range();
    const far = 20 * (high - low); // canvases take very long to dash extremely long lines
    const near = (v: number): number => Math.min(high + far, Math.max(low - far, v));
    const shifted = (values: MaybeNumber[]): MaybeNumber[] => values.map((v) => (v === null ? null : near(v - origin)));
    const ahead = (values: MaybeNumber[]): MaybeNumber[] =>
      shifted(values).map((v, i) => (curve.alpha[i]! < 0 ? null : v));
    const columns = [shifted(curve.value), shifted(curve.model)];
    if (test !== "none") columns.push(ahead(curve.textbook));
    if (test === "slide") columns.push(ahead(curve.slide));
    return columns;
  }

  private range(): [number, number] {
    const { curve, trials } = this.search!;
    const origin = this.origin();
    const [low, high] = alphaRange(curve.alpha, trials);
    const shown = (alpha: number): boolean => alpha >= low && alpha <= high;
    const shifted = (values: MaybeNumber[]): MaybeNumber[] =>
      values.map((v, i) => (v === null || !shown(curve.alpha[i]!) ? null : v - origin));
    const tried = trials.filter((t) => shown(t.alpha)).map((t) => (t.value === null ? null : t.value - origin));
    return searchRange(shifted(curve.value), shifted(curve.model), tried);
  }

  private read(key: string, alpha: number | null): string[] {
    if (!this.search || alpha === null) return [];
    const column = curvesOf(this.search, this.symbol).findIndex((c) => c.key === key);
    return [short(this.columns()[column]?.[nearest(this.search.curve.alpha, alpha)], 4)];
  }

  // Draws the largest step that contact allows.
  private paintLimit(u: uPlot, colors: Palette): void {
    const { maxStep } = this.search!;
    if (maxStep === null || maxStep === undefined) return;
    paintVerticalLine(u, maxStep, colors.bad, 0.6);
    const scale = u.bbox.width / u.over.clientWidth || 1;
    const x = u.valToPos(maxStep, "x", true);
    const pen = u.ctx;
    pen.save();
    pen.font = `${colors.fontSize * 0.82 * scale}px sans-serif`;
    pen.fillStyle = colors.bad;
    pen.textBaseline = "bottom";
    const text = limitText(maxStep);
    const isRight = x + 6 * scale + pen.measureText(text).width < u.bbox.left + u.bbox.width;
    pen.textAlign = isRight ? "left" : "right";
    pen.fillText(text, x + (isRight ? 6 : -6) * scale, u.bbox.top + u.bbox.height - 6 * scale);
    pen.restore();
  }

  // Draws rejected trials as crosses and the accepted one as a dot. Values outside of the axis are drawn at its edge.
  private paintTrials(u: uPlot, colors: Palette): void {
    const { trials } = this.search!;
    const pen = u.ctx;
    const scale = u.bbox.width / u.over.clientWidth || 1;
    const origin = this.origin();
    pen.save();
    pen.font = `${colors.fontSize * 0.82 * scale}px sans-serif`;
    let right = -Infinity; // right end of the last text, to avoid overlaps
    for (const trial of [...trials].sort((p, q) => p.alpha - q.alpha)) {
      const x = u.valToPos(trial.alpha, "x", true);
      if (x > u.bbox.left + u.bbox.width + 1) continue;
      const value = trial.value === null ? Infinity : trial.value - origin;
      const at = Number.isFinite(value) ? u.valToPos(value, "y", true) : -Infinity;
      const y = Math.max(u.bbox.top + 6 * scale, at);
      mark(pen, trial.accepted, x, y, 5 * scale, trial.accepted ? colors.good : colors.bad);
      const off = at < u.bbox.top ? "↑ " : "";
      const text = `${off}α = ${short(trial.alpha, 3)}: ${short(value, 3)}`;
      const width = pen.measureText(text).width;
      const left = Math.min(Math.max(u.bbox.left, x + 8 * scale), u.bbox.left + u.bbox.width - width);
      if (left < right && !trial.accepted) continue;
      right = left + width;
      pen.fillStyle = trial.accepted ? colors.good : colors.bad;
      pen.strokeStyle = colors.panel;
      pen.lineWidth = 4 * scale;
      pen.lineJoin = "round";
      pen.textBaseline = "middle";
      pen.textAlign = "left";
      const line = y + (y < u.bbox.top + 18 * scale ? 14 : -13) * scale;
      pen.strokeText(text, left, line);
      pen.fillText(text, left, line);
    }
    pen.restore();
  }
}

export function limitText(maxStep: number): string {
  return `contact: α ≤ ${short(maxStep, 3)}`;
}

function mark(pen: CanvasRenderingContext2D, accepted: boolean, x: number, y: number, r: number, color: string): void {
  pen.beginPath();
  pen.setLineDash([]);
  pen.fillStyle = pen.strokeStyle = color;
  pen.lineWidth = r * 0.45;
  if (accepted) {
    pen.arc(x, y, r, 0, 2 * Math.PI);
    return pen.fill();
  }
  for (const sign of [-1, 1]) {
    pen.moveTo(x - r, y - sign * r);
    pen.lineTo(x + r, y + sign * r);
  }
  pen.stroke();
}

function curvesOf(search: Search, symbol: string): Curve[] {
  const curves: Curve[] = [
    { key: "value", label: symbol, meaning: "the objective along d", color: "series1", width: 2.25 },
    {
      key: "model",
      label: "quadratic model",
      meaning: "E + α g·d + α²/2 d·H d",
      color: "series2",
      width: 1.75,
      dash: [6, 4],
    },
  ];
  if (search.test !== "none")
    curves.push({
      key: "textbook",
      label: search.test === "slide" ? "Armijo line (textbook)" : "Armijo line: accepted below it",
      meaning: "E + c α g·d, the bound of the textbook's test",
      color: "series3",
      dash: [2, 3],
    });
  if (search.test === "slide")
    curves.push({
      key: "slide",
      label: "slide's line: accepted below it",
      meaning: "E + c g·d, the bound as printed in the lecture",
      color: "series4",
      dash: [2, 3],
    });
  return curves;
}

// E along the direction d: the curve, its quadratic model, the acceptance test of the line search, and its trials.
import type uPlot from "uplot";
import type { IterationReply, MaybeNumber, TrialRow } from "../protocol";
import { text } from "../view/marks";
import { Chart, type Curve } from "./chart";
import { finite, short } from "../numbers";
import type { Palette } from "./palette";
import { nearest } from "./table";
import { inkOn, paintVerticalLine } from "./painting";

export interface Search extends Pick<IterationReply, "curve" | "trials">, Partial<Pick<IterationReply, "max_step">> {
  test: string; // acceptance test: "textbook", "slide" or "none"
  about?: string; // the iteration, where it is not clear from the context
}

// Range of the axis: the valley, and trials unless they dwarf it. Values are differences from E at alpha 0.
export function searchRange(values: MaybeNumber[], model: MaybeNumber[], trials: MaybeNumber[]): [number, number] {
  const lowest = Math.min(0, ...finite(values), ...finite(trials));
  const promised = Math.min(0, ...finite(model));
  const depth = -lowest || -promised || Math.max(...finite(values).map(Math.abs), 1e-300);
  const low = Math.max(Math.min(lowest, promised), -2 * depth); // a model without a minimum has no lower bound
  const high = finite([...values, ...trials]).filter((v) => v > 0 && v <= 4 * depth);
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
  readonly element = this.chart.element;
  private search: Search | null = null;

  constructor(private readonly symbol = "E") {}

  show(search: Search | null): void {
    this.search = search;
    this.chart.element.hidden = search === null;
    if (!search) return;
    this.chart.configure({
      label: "E along the direction d",
      x: { label: "α" },
      y: { label: `${this.symbol} − ${this.symbol}(α = 0)` },
      curves: curvesOf(search, this.symbol),
      xRange: () => alphaRange(search.curve.alpha, search.trials),
      yRange: () => this.range(),
      paint: (u, colors) => {
        paintLimit(u, colors, search.max_step ?? null);
        this.paintTrials(u, colors);
      },
    });
    this.chart.show(search.curve.alpha, this.columns());
  }

  private origin(): number {
    const { curve } = this.search!;
    return curve.value[nearest(curve.alpha, 0)] ?? curve.model[nearest(curve.alpha, 0)] ?? 0;
  }

  private columns(): MaybeNumber[][] {
    const { curve } = this.search!;
    const origin = this.origin();
    const [low, high] = this.range();
    const far = 20 * (high - low); // canvases take very long to dash extremely long lines
    const near = (v: number): number => Math.min(high + far, Math.max(low - far, v));
    const shifted = (values: MaybeNumber[]): MaybeNumber[] => values.map((v) => (v === null ? null : near(v - origin)));
    const ahead = (values: MaybeNumber[]): MaybeNumber[] => shifted(values).map((v, i) => (curve.alpha[i] < 0 ? null : v));
    const columns = [shifted(curve.value), shifted(curve.model), ahead(curve.textbook), ahead(curve.slide)];
    return columns.slice(0, curvesOf(this.search!, this.symbol).length);
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

  // Draws rejected trials as crosses and the accepted one as a dot. Values outside of the axis are drawn at its edge.
  private paintTrials(u: uPlot, colors: Palette): void {
    const origin = this.origin();
    const ink = inkOn(u, colors, colors.bad);
    const { em } = ink;
    const bounds = u.bbox;
    let end = -Infinity; // right end of the last text, to avoid overlaps
    for (const { alpha, value: tried, accepted } of [...this.search!.trials].sort((p, q) => p.alpha - q.alpha)) {
      const x = u.valToPos(alpha, "x", true);
      if (x > bounds.left + bounds.width + 1) continue;
      const value = tried === null ? Infinity : tried - origin;
      const at = Number.isFinite(value) ? u.valToPos(value, "y", true) : -Infinity;
      const y = Math.max(bounds.top + 0.5 * em, at);
      ink.text = accepted ? colors.good : colors.bad;
      mark(ink.context, accepted, x, y, 0.45 * em, ink.text);
      const words = `${at < bounds.top ? "↑ " : ""}α = ${short(alpha, 3)}: ${short(value, 3)}`;
      const width = ink.context.measureText(words).width;
      const left = Math.min(Math.max(bounds.left, x + 0.7 * em), bounds.left + bounds.width - width);
      if (left < end && !accepted) continue;
      end = left + width;
      text(ink, words, left, y + (y < bounds.top + 1.6 * em ? 1.2 : -1.1) * em);
    }
    ink.context.restore();
  }
}

// Draws the largest step that contact allows.
function paintLimit(u: uPlot, colors: Palette, maxStep: MaybeNumber): void {
  if (maxStep === null) return;
  paintVerticalLine(u, maxStep, colors.bad, 0.6);
  const ink = inkOn(u, colors, colors.bad);
  const { left, top, width, height } = u.bbox;
  const x = u.valToPos(maxStep, "x", true);
  const words = limitText(maxStep);
  const isRight = x + ink.em + ink.context.measureText(words).width < left + width;
  text(ink, words, x + (isRight ? 0.5 : -0.5) * ink.em, top + height - ink.em, isRight ? "left" : "right");
  ink.context.restore();
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

function curvesOf({ test }: Search, symbol: string): Curve[] {
  const line = { dash: [2, 3] };
  const textbook = test === "slide" ? "Armijo line (textbook)" : "Armijo line: accepted below it";
  const curves: Curve[] = [
    { key: "value", label: symbol, meaning: "the objective along d", color: "series1", width: 2.25 },
    { key: "model", label: "quadratic model", meaning: "E + α g·d + α²/2 d·H d", color: "series2", width: 1.75, dash: [6, 4] },
    { key: "textbook", label: textbook, meaning: "E + c α g·d, the bound of the textbook's test", color: "series3", ...line },
    { key: "slide", label: "slide's line: accepted below it", meaning: "E + c g·d, the bound as printed in the lecture", color: "series4", ...line },
  ];
  return curves.slice(0, test === "none" ? 2 : test === "slide" ? 4 : 3);
}

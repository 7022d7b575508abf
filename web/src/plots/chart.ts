// A 2-D chart in the page's colors: curves over x, a legend whose entries show the values under the cursor and hide
// their curves, and a picture of both.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import "./plots.css";
import type { MaybeNumber } from "../protocol";
import { onLook } from "../theme";
import { axis, padded, ranged, type Axis } from "./axes";
import { oncePerFrame } from "../controls";
import { element } from "../dom";
import { titled } from "./legend";
import { short, withUnit } from "../numbers";
import { cssOf, inkOf, palette, samePalette, type Color, type Palette } from "./palette";
import { nearest, type Table } from "./table";

export interface Curve {
  key: string; // curves with the same key share an entry of the legend
  label: string;
  meaning?: string;
  color: Color;
  width?: number;
  dash?: number[];
  shape?: "line" | "points" | "both" | "bars";
}

export type FilledCurve = Curve & { values: MaybeNumber[] };

export interface ChartOptions {
  label: string; // name for screen readers
  x: Axis;
  y: Axis & { log?: boolean };
  curves: Curve[];
  legend?: "side" | "top"; // top by default
  read?: (key: string, x: number | null) => string[]; // texts for the legend at x, or without a cursor; default: the value
  showsLast?: boolean; // without a cursor the legend shows the last values
  caption?: (x: number | null) => string; // text above the values
  xRange?: () => [number, number] | null;
  yRange?: () => [number, number] | null; // null: the range of the visible curves
  paint?: (u: uPlot, colors: Palette) => void; // draws over the curves
  zoomed?: (range: [number, number] | null) => void; // range selected with the mouse; null: all of it
  clicked?: (x: number) => void;
}

interface Entry {
  key: string;
  button: HTMLButtonElement;
  values: HTMLSpanElement;
}

export class Chart {
  readonly element = element("div", { class: "chart" });
  readonly hidden = new Set<string>();
  private readonly plot = element("div", { class: "chart-plot", tabindex: "0", role: "img" });
  private readonly legend = element("div", { class: "chart-legend", role: "group", "aria-label": "Curves" });
  private readonly caption = element("div", { class: "chart-caption" });
  private options: ChartOptions | null = null;
  private data: Table = { x: [], columns: [] };
  private chart: uPlot | null = null;
  private entries: Entry[] = [];
  private cursor: number | null = null;
  private colors: Palette | null = null;
  private readonly resize = oncePerFrame(() => this.fit());

  constructor() {
    this.element.append(this.plot, this.legend);
    new ResizeObserver(this.resize).observe(this.plot);
    onLook(this.resize);
    this.plot.addEventListener("keydown", (event) => this.walk(event));
  }

  // A chart whose content does not change.
  static of(x: number[], curves: FilledCurve[], options: Omit<ChartOptions, "curves">): Chart {
    const chart = new Chart();
    chart.configure({ ...options, curves });
    chart.show(
      x,
      curves.map(({ values }) => values),
    );
    return chart;
  }

  configure(options: ChartOptions): void {
    this.options = options;
    this.element.dataset.legend = options.legend ?? "top";
    this.plot.setAttribute("aria-label", `${options.label}. The arrow keys move through its values.`);
    this.buildLegend();
    this.rebuild();
  }

  // Shows the columns, in the order of the curves.
  show(x: number[], columns: MaybeNumber[][]): void {
    this.data = { x, columns };
    if (!this.chart) return this.rebuild();
    this.chart.setData([x, ...columns]);
    this.readLegend();
  }

  private rebuild(): void {
    this.chart?.destroy();
    this.chart = null;
    const [width, height] = [this.plot.clientWidth, this.plot.clientHeight];
    const options = this.options;
    if (!options || width < 60 || height < 40 || this.data.columns.length !== options.curves.length) return;
    const colors = (this.colors = palette(this.element));
    this.chart = new uPlot(
      this.settings(options, colors, width, height),
      [this.data.x, ...this.data.columns],
      this.plot,
    );
    this.readLegend();
  }

  get width(): number {
    return this.plot.clientWidth;
  }

  // The chart with its title above and its legend below.
  picture(title: string): HTMLCanvasElement | null {
    if (!this.chart || !this.options) return null;
    const source = this.chart.ctx.canvas;
    const scale = uPlot.pxRatio;
    const colors = palette(this.element);
    const shown = this.entries.filter((entry) => !this.hidden.has(entry.key));
    const curves = shown.map(({ key }) => this.options!.curves.find((curve) => curve.key === key)!);
    const signs = curves.map(({ dash, color, label }) => ({ sign: dash ? "╌╌" : "━━", color, text: label }));
    return titled(source, title, colors, scale, signs);
  }

  private settings(options: ChartOptions, colors: Palette, width: number, height: number): uPlot.Options {
    const log = options.y.log === true;
    return {
      width,
      height,
      legend: { show: false },
      padding: [colors.fontSize * 0.6, colors.fontSize * 1.6, 0, 0],
      cursor: {
        y: false,
        points: { size: 6 },
        drag: { x: options.zoomed !== undefined, y: false, setScale: false, dist: 6 },
      },
      scales: {
        x: {
          time: false,
          range: (_u, low, high) => options.xRange?.() ?? padded(low, high, options.x.integer === true),
        },
        y: { distr: log ? 3 : 1, log: 10, range: (_u, low, high) => options.yRange?.() ?? ranged(low, high, log) },
      },
      axes: [axis(options.x, colors, false), axis(options.y, colors, true)],
      series: [{}, ...options.curves.map((curve) => this.series(curve, colors))],
      hooks: {
        setCursor: [(u) => this.moved(u)],
        setSelect: [(u) => this.selected(u)],
        draw: [(u) => options.paint?.(u, colors)],
        ready: [(u) => this.listen(u)],
      },
    };
  }

  private series(curve: Curve, colors: Palette): uPlot.Series {
    const stroke = inkOf(colors, curve.color);
    const shape = curve.shape ?? "line";
    return {
      show: !this.hidden.has(curve.key),
      stroke,
      width: shape === "points" ? 0 : (curve.width ?? 1.5),
      dash: curve.dash,
      spanGaps: true,
      pxAlign: 0,
      fill: shape === "bars" ? stroke : undefined,
      paths: shape === "bars" ? uPlot.paths.bars!({ size: [0.7, 40] }) : undefined,
      points: {
        show: (u, _series, first, last) => showsPoints(shape, last - first, u.over.clientWidth),
        size: 6,
        fill: stroke,
      },
    };
  }

  private listen(u: uPlot): void {
    u.over.addEventListener("dblclick", () => this.options?.zoomed?.(null));
    u.over.addEventListener("click", () => {
      if (u.cursor.left !== undefined && u.cursor.left >= 0) this.options?.clicked?.(u.posToVal(u.cursor.left, "x"));
    });
  }

  private moved(u: uPlot): void {
    const left = u.cursor.left ?? -1;
    this.cursor = left < 0 ? null : u.posToVal(left, "x");
    this.readLegend();
  }

  private selected(u: uPlot): void {
    if (u.select.width < 4) return;
    const range: [number, number] = [u.posToVal(u.select.left, "x"), u.posToVal(u.select.left + u.select.width, "x")];
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.options?.zoomed?.(range);
  }

  private walk(event: KeyboardEvent): void {
    const u = this.chart;
    const by = event.key === "ArrowLeft" ? -1 : event.key === "ArrowRight" ? 1 : 0;
    if (!u || by === 0 || this.data.x.length === 0) return;
    event.preventDefault();
    event.stopPropagation();
    const index = Math.min(this.data.x.length - 1, Math.max(0, (u.cursor.idx ?? this.data.x.length - 1) + by));
    u.setCursor({ left: u.valToPos(this.data.x[index]!, "x"), top: u.over.clientHeight / 2 });
  }

  private fit(): void {
    const [width, height] = [this.plot.clientWidth, this.plot.clientHeight];
    if (width < 60 || height < 40) return;
    if (this.chart && samePalette(this.colors, palette(this.element))) this.chart.setSize({ width, height });
    else this.rebuild();
  }

  private buildLegend(): void {
    const curves = this.options!.curves.filter((curve, i, all) => all.findIndex((c) => c.key === curve.key) === i);
    this.entries = curves.map((curve) => {
      const values = element("span", { class: "chart-values" });
      const sample = element("span", { class: "chart-sample" });
      const dashed = curve.dash ? "dashed" : "solid";
      sample.style.borderTop = `${Math.max(2, (curve.width ?? 1.5) * 1.4)}px ${dashed} ${cssOf(curve.color)}`;
      const title = `${curve.meaning ?? curve.label}. Click to hide or show it.`;
      const entry = element("button", {
        type: "button",
        class: "chart-entry",
        title,
        "aria-pressed": String(!this.hidden.has(curve.key)),
      });
      entry.append(sample, element("span", { class: "chart-label" }, curve.label), values);
      entry.addEventListener("click", () => this.toggle(curve.key));
      return { key: curve.key, button: entry, values };
    });
    this.legend.replaceChildren(
      ...(this.options!.caption ? [this.caption] : []),
      ...this.entries.map(({ button }) => button),
    );
  }

  private toggle(key: string): void {
    if (!this.hidden.delete(key)) this.hidden.add(key);
    for (const entry of this.entries) entry.button.setAttribute("aria-pressed", String(!this.hidden.has(entry.key)));
    this.rebuild();
  }

  private readLegend(): void {
    const caption = this.options!.caption?.(this.cursor) ?? "";
    if (this.caption.textContent !== caption) this.caption.textContent = caption;
    for (const entry of this.entries) {
      const texts = this.options!.read?.(entry.key, this.cursor) ?? this.valueText(entry.key);
      if (entry.values.childElementCount !== texts.length)
        entry.values.replaceChildren(...texts.map(() => element("span")));
      texts.forEach((text, i) => {
        const cell = entry.values.children[i]!;
        if (cell.textContent !== text) cell.textContent = text;
      });
    }
  }

  private valueText(key: string): string[] {
    const { curves, y, showsLast } = this.options!;
    const { x, columns } = this.data;
    const at = this.cursor ?? (showsLast ? Infinity : null);
    if (at === null || x.length === 0) return [];
    const value = columns[curves.findIndex((curve) => curve.key === key)]?.[nearest(x, at)];
    return [y.unit ? withUnit(value, y.unit, 3) : short(value)];
  }
}

// Whether a line has dots: only where they are apart.
function showsPoints(shape: Curve["shape"], count: number, width: number): boolean {
  return shape === "points" || (shape === "both" && count * 9 <= width);
}

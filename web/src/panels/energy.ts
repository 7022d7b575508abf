// Energy plot: the forms of energy, and what added or removed it.
import { fieldsOf, type Page, type Panel } from "../page";
import type { MaybeNumber, SideName } from "../protocol";
import type { Store } from "../store";
import { Chart, type Curve } from "../plots/chart";
import { checkbox, choice, numberField, oncePerFrame } from "../controls";
import { button, downloadCanvas, element, fileName, saveFile } from "../dom";
import { balanceText, calmRange, CurveColors, explosionText, Ledger, ledgerColumns } from "../plots/ledger";
import { csv, short, withUnit } from "../numbers";
import type { Palette } from "../plots/palette";
import { paintVerticalLine } from "../plots/painting";
import { lowerBound, magnitude, merged, nearest, thinned, type Table } from "../plots/table";
import type uPlot from "uplot";

const kSides: SideName[] = ["a", "b"];
const kWindows = [["all", "all"], ["10", "last 10 s"], ["2", "last 2 s"], ["typed", "last ... s"]] as const;

const kWindowHelp = "Visible range of time; drag in the plot to zoom, double-click for all";

export class EnergyPanel implements Panel {
  readonly name = "energy";
  readonly title = "Energy";
  readonly element = element("div", { class: "plot-panel", role: "group", "aria-label": "Energy plot" });
  private readonly chart = new Chart();
  private readonly note = element("span", { class: "plot-note", role: "status" });
  private readonly ledgers: Record<SideName, Ledger | null> = { a: null, b: null };
  private readonly typed = numberField("", "Length of the window [s]", 1, { min: 1e-6 }, () => this.setWindow());
  private readonly windows = choice("Window", kWindowHelp, kWindows, "all", () => this.setWindow());
  private readonly log = checkbox("log", "Logarithmic axis of absolute values; zeros are omitted", false, () => this.configure());
  private range: [number, number] | null = null; // range selected with the mouse [s]
  private byStep = false; // x is the step: a static scene has no time
  private rows = new Set<string>(); // keys of the legend's rows
  private colors = new CurveColors();
  private readonly redraw = oncePerFrame(() => this.element.isConnected && this.draw());
  readonly show = this.redraw;

  constructor(
    private readonly store: Store,
    page: Page,
  ) {
    this.typed.element.hidden = true;
    const csv = button({ text: "CSV", title: "Save all columns as CSV with all digits" }, () => this.saveCsv());
    const png = button({ text: "PNG", title: "Save the plot as a picture" }, () => this.savePng());
    this.element.append(
      element("div", { class: "plot-bar" }, this.windows.element, this.typed.element, this.log.element, csv, png, this.note),
      element("div", { class: "plot-fill" }, this.chart.element),
    );
    store.on("scene", (side) => this.newScene(side));
    store.on("gone", () => this.newScene("b"));
    store.on("steps", ({ side, from }) => {
      this.ledgers[side]?.update(store.side(side)?.steps ?? [], from);
      this.redraw();
    });
    store.on("state", () => this.redraw());
    page.on("scale", (scale) => {
      this.log.input.checked = scale === "log";
      this.configure();
    });
    page.keep("energy", { save: () => this.save(), restore: (saved) => this.restore(saved) });
    for (const side of kSides) this.newScene(side);
  }

  private newScene(name: SideName): void {
    const side = this.store.side(name);
    const known = this.ledgers[name];
    const isKnown = side && known?.potentials.join() === side.scene.potentials.join();
    if (!isKnown) this.ledgers[name] = side && new Ledger(side.scene.potentials);
    if (!isKnown && name === "a") this.colors = new CurveColors();
    this.ledgers[name]?.update(side!.steps, isKnown ? (side.steps.at(-1)?.step ?? 0) : 0);
    this.configure(); // its label may have changed
  }

  private shown(): { side: SideName; ledger: Ledger }[] {
    return kSides.flatMap((side) => (this.ledgers[side] ? [{ side, ledger: this.ledgers[side] }] : []));
  }

  // Keys of the columns that are nonzero at some time on one of the sides.
  private used(): Set<string> {
    return new Set(this.shown().flatMap(({ ledger }) => ledger.used()));
  }

  private curves(): Curve[] {
    const dashed = (curve: Curve): Curve => ({ ...curve, dash: curve.dash ? [8, 3, 2, 3] : [8, 5] });
    return this.shown().flatMap(({ side, ledger }) => this.columnsOf(ledger).map(({ column }) => (side === "a" ? column : dashed(column))));
  }

  private columnsOf(ledger: Ledger): { column: Curve; values: MaybeNumber[] }[] {
    return ledgerColumns(ledger.potentials)
      .map((column, i) => ({ column, values: ledger.columns[i]! }))
      .filter(({ column }) => this.rows.has(column.key))
      .map(({ column, values }) => ({ column: { ...column, color: this.colors.of(column.key) }, values }));
  }

  private configure(): void {
    this.rows = this.used();
    const log = this.log.input.checked;
    this.byStep = this.isStatic();
    this.chart.configure({
      label: "Energy over time",
      x: this.byStep ? { label: "step", integer: true } : { label: "time [s]" },
      y: { label: log ? "|energy|" : "energy", unit: "J", log },
      curves: this.curves(),
      legend: "side",
      read: (key, x) => this.shown().map(({ ledger }) => withUnit(this.valueAt(ledger, key, x), "J")),
      caption: (x) => this.captionAt(x),
      xRange: () => this.xRange(),
      yRange: () => (log ? null : this.calmRange()),
      paint: (u, colors) => this.paintNow(u, colors),
      zoomed: (range) => {
        this.range = range;
        this.redraw();
      },
    });
    this.redraw();
  }

  private isStatic(): boolean {
    return this.shown().every(({ ledger }) => (ledger.time.at(-1) ?? 0) === 0);
  }

  private calmRange(): [number, number] | null {
    const { a, b } = this.ledgers;
    return a && b && calmRange(a, b);
  }

  private xOf(ledger: Ledger): number[] {
    return this.byStep ? ledger.step : ledger.time;
  }

  private valueAt(ledger: Ledger, key: string, x: number | null): MaybeNumber {
    const column = ledger.columns[ledgerColumns(ledger.potentials).findIndex((c) => c.key === key)];
    return column?.[this.indexAt(ledger, x)] ?? null;
  }

  // Index of the step at x, or of the last step up to the time of the picture.
  private indexAt(ledger: Ledger, x: number | null): number {
    if (x !== null) return nearest(this.xOf(ledger), x);
    const last = ledger.step.length - 1;
    const state = this.store.state?.[ledger === this.ledgers.b ? "b" : "a"];
    return state ? Math.max(0, Math.min(last, lowerBound(ledger.step, state.step + 0.5) - 1)) : last;
  }

  private captionAt(x: number | null): string {
    const sides = this.shown().filter(({ ledger }) => ledger.step.length > 0);
    const texts = sides.map(({ side, ledger }) => {
      const i = this.indexAt(ledger, x);
      const label = sides.length > 1 ? `${this.store.label(side)}: ` : "";
      return `${label}step ${ledger.step[i]}${this.byStep ? "" : `, ${short(ledger.time[i])} s`}`;
    });
    return texts.join(" · ");
  }

  private xRange(): [number, number] | null {
    if (this.range) return this.range;
    const ends = this.shown().flatMap(({ ledger }) => (ledger.step.length > 0 ? [this.xOf(ledger)] : []));
    if (ends.length === 0) return null;
    const last = Math.max(...ends.map((x) => x[x.length - 1]));
    const { value } = this.windows.select;
    const length = value === "typed" ? Math.max(1e-6, this.typed.input.valueAsNumber || 1) : Number(value);
    const first = value === "all" ? Math.min(0, ...ends.map((x) => x[0])) : last - length;
    return last > first ? [first, last] : [first, first + 1];
  }

  private setWindow(): void {
    this.typed.element.hidden = this.windows.select.value !== "typed";
    this.range = null;
    this.redraw();
  }

  private table(ledger: Ledger): Table {
    const x = this.xOf(ledger);
    const range = this.xRange();
    const from = range ? Math.max(0, lowerBound(x, range[0]) - 1) : 0;
    const to = range ? Math.min(x.length, lowerBound(x, range[1]) + 1) : x.length;
    const columns = this.columnsOf(ledger).map(({ values }) => values);
    return thinned({ x, columns }, from, to, Math.max(100, this.chart.width / 2));
  }

  private draw(): void {
    const used = this.used();
    if (this.isStatic() !== this.byStep || used.size !== this.rows.size || [...used].some((key) => !this.rows.has(key)))
      return this.configure();
    const { x, columns } = merged(...this.shown().map(({ ledger }) => this.table(ledger)));
    this.chart.show(x, this.log.input.checked ? columns.map((column) => column.map(magnitude)) : columns);
    this.describe();
  }

  private describe(): void {
    const texts = this.shown().map(({ side, ledger }) => {
      const { drift, scale } = ledger.drift();
      const name = this.ledgers.b ? `${this.store.label(side)}: ` : "";
      const peak = ledger.exploded();
      if (peak !== null) return `${name}${explosionText(peak)}`;
      return ledger.step.length >= 2 && Number.isFinite(drift) && `${name}${balanceText(drift, scale)}`;
    });
    const log = this.log.input.checked;
    const dashes = this.ledgers.b && `${this.store.label("b")} is dashed`;
    const wild = !log && this.calmRange() && "one side exceeds the plot; switch to log";
    const text = [...texts, dashes, wild, log && "absolute values; zeros are omitted"].filter(Boolean).join(" · ");
    if (this.note.textContent !== text) this.note.textContent = text;
  }

  // Draws a line at the time of the picture unless that is the end.
  private paintNow(u: uPlot, colors: Palette): void {
    const state = this.store.state?.a;
    const ledger = this.ledgers.a;
    if (!state || !ledger || ledger.step.length === 0 || state.step >= ledger.step[ledger.step.length - 1]!) return;
    paintVerticalLine(u, this.byStep ? state.step : state.time, colors.accent);
  }

  private saveCsv(): void {
    const sides = this.shown();
    const names = sides.flatMap(({ side, ledger }) => {
      const keys = ledgerColumns(ledger.potentials).map((column) => column.key);
      const all = ["time", ...keys, "residual_work_of_step", "ledger_error_of_step"];
      return sides.length > 1 ? all.map((name) => `${name}_${side}`) : all;
    });
    const columnsOf = ({ time, columns, residualWork, ledgerError }: Ledger): MaybeNumber[][] => [time, ...columns, residualWork, ledgerError];
    const { x, columns } = merged(...sides.map(({ ledger }) => ({ x: ledger.step, columns: columnsOf(ledger) })));
    const text = csv(["step", ...names], [x, ...columns], x.length);
    saveFile(fileName(`${this.store.name}_energy`, "csv"), new Blob([text], { type: "text/csv" }));
  }

  private savePng(): void {
    const [first, second] = this.shown().map(({ side }) => this.store.label(side));
    const picture = this.chart.picture(`${this.store.name}: energy${second ? ` (${first}; dashed: ${second})` : ""}`);
    if (picture) void downloadCanvas(`${this.store.name}_energy`, picture);
  }

  private save(): unknown {
    const { windows, typed, log, chart } = this;
    return { window: windows.select.value, typed: typed.input.value, log: log.input.checked, hidden: [...chart.hidden] };
  }

  private restore(saved: unknown): void {
    const kept = fieldsOf(saved);
    if (kWindows.some(([name]) => name === kept.window)) this.windows.select.value = kept.window as string;
    if (Number(kept.typed) > 0) this.typed.input.value = String(kept.typed);
    this.log.input.checked = kept.log === true;
    this.chart.hidden.clear();
    for (const key of Array.isArray(kept.hidden) ? kept.hidden : []) this.chart.hidden.add(String(key));
    this.setWindow();
    this.configure();
  }
}

// The virtual bench: an indenter with its gauge, the kept readings, and the fit of a material to them. Lengths are in
// millimeters, forces in newtons.
import "./bench.css";
import { choice, numberField, oncePerFrame } from "../../../web/src/controls";
import { button, element } from "../../../web/src/dom";
import type { Page, Panel } from "../../../web/src/page";
import { Chart } from "../../../web/src/plots/chart";
import { short } from "../../../web/src/numbers";
import type { Store } from "../../../web/src/store";
import type { Display } from "../../../web/src/view/display";
import { ForceCurve } from "./curve";
import { FitForm } from "./fitForm";
import type { Bench, BenchCommand, IndenterChoice, IndenterState } from "./protocol";
import type { IndenterTool } from "./tool";

const kDeepest = 1.5; // end of the slider, in radii of the indenter
const kHint = "Click the body to place an indenter, and drag on to press it in. Lift it before the next place.";

export const inMillimeters = (meters: number): string => `${short(1000 * meters, 3)} mm`;
export const inNewtons = (force: number): string => `${short(force, 3)} N`;

// Columns of the chart, over depths in millimeters. Equal depths get a tiny distance, because the chart needs ascending ones.
export function columnsOf(curve: [depth: number, force: number][], readings: Bench["readings"]) {
  const now = curve.map(([depth, force]) => ({ depth: 1000 * depth, live: force as number | null, kept: null as number | null }));
  const before = readings.map(({ depth, force }) => ({ depth: 1000 * depth, live: null, kept: force }));
  const rows = [...now, ...before].sort((a, b) => a.depth - b.depth);
  let last = -Infinity;
  const depths = rows.map(({ depth }) => (last = Math.max(depth, last + 1e-9)));
  return { depths, live: rows.map(({ live }) => live), kept: rows.map(({ kept }) => kept) };
}

export class BenchPanel implements Panel {
  readonly name = "bench";
  readonly title = "Bench";
  readonly isTall = true;
  readonly element = element("div", { class: "plot-panel", role: "group", "aria-label": "Virtual bench" });
  private readonly force = element("output", { class: "bench-force", "aria-label": "Force of the indenter" });
  private readonly place = element("p", { class: "bench-row" });
  private readonly slider = element("input", { type: "range", min: "0", max: "1", step: "any", "aria-label": "Depth, slider" });
  private readonly depth = numberField("Depth [mm]", "Depth since the first contact", 0, {}, (value) => this.press(value / 1000));
  private readonly radius = numberField("Radius [mm]", "Radius of the next indenter", 0, { min: 1e-6 }, (value) => (this.tool.choice.radius = value / 1000));
  private readonly lift = button({ text: "Lift", title: "Remove the indenter", steers: true }, () => this.send({ do: "lift" }));
  private readonly keep = button({ text: "Keep this reading", title: "Keep depth and force, once the body rests", steers: true }, () => this.send({ do: "keep" }));
  private readonly list = element("ol", { class: "bench-list", "aria-label": "Readings" });
  private readonly chart = new Chart();
  private readonly curve = new ForceCurve();
  private readonly fit: FitForm;
  private readonly draw = oncePerFrame(() => this.element.isConnected && this.drawNow());
  private tip: IndenterState | null = null;
  private bench: Bench | null = null;

  constructor(
    private readonly store: Store,
    private readonly page: Page,
    private readonly display: Display,
    private readonly tool: IndenterTool,
  ) {
    this.fit = new FitForm(store, page);
    this.chart.configure({
      label: "Force over depth",
      x: { label: "depth", unit: "mm" },
      y: { label: "force", unit: "N" },
      curves: [
        { key: "live", label: "now", meaning: "Readings during this touch", color: "series2", width: 2, shape: "both" },
        { key: "kept", label: "kept", meaning: "Kept readings", color: "series1", shape: "points" },
      ],
    });
    this.slider.addEventListener("input", () => this.tip && this.press(this.slider.valueAsNumber * kDeepest * this.tip.radius));
    const shape = choice("Tip", "Shape of the next indenter", [["sphere", "sphere"], ["disc", "flat disc"]], "sphere", (value) => {
      tool.choice.shape = value as IndenterChoice["shape"];
    });
    const contact = choice("Contact", "Bonded: it sticks and can also pull. Sliding: it pushes without friction.", [["bonded", "bonded"], ["sliding", "sliding"]], "bonded", (value) => {
      tool.choice.contact = value as IndenterChoice["contact"];
    });
    const row = (...parts: HTMLElement[]): HTMLElement => element("div", { class: "bench-row" }, ...parts);
    const parts = element(
      "div",
      { class: "bench" },
      element("section", { "aria-label": "Indenter" }, element("p", { class: "faint" }, kHint), row(shape.element, contact.element, this.radius.element), row(this.depth.element, this.slider, this.lift), this.force, this.place, row(this.keep)),
      element("div", { class: "plot-fill bench-chart" }, this.chart.element),
      element("section", { "aria-label": "Kept readings" }, element("h3", {}, "Kept readings"), this.list),
      this.fit.element,
    );
    this.element.append(parts);
    for (const event of ["state", "role"] as const) store.on(event, () => this.follow());
    store.on("extension", (message) => this.showReadings(message as Bench));
    this.follow();
  }

  // The mouse moves the indenter while the panel is open.
  show(visible: boolean): void {
    const { tool } = this.display.settings;
    if (visible && tool === "drag") this.display.change({ tool: "extension" });
    if (!visible && tool === "extension") this.display.change({ tool: "drag" });
    if (visible) this.draw();
  }

  private follow(): void {
    const tip = (this.tip = (this.store.state?.a.tool ?? null) as IndenterState | null);
    const { steers } = this.store;
    this.force.textContent = tip ? inNewtons(tip.force) : "–";
    this.place.textContent = tip ? `${tip.shape === "disc" ? "disc" : "sphere"} of radius ${inMillimeters(tip.radius)}, ${inMillimeters(tip.depth)} deep` : "no indenter";
    this.keep.disabled = !steers || !tip || tip.wanted === 0;
    this.slider.disabled = this.depth.input.disabled = this.lift.disabled = !steers || !tip;
    if (tip && !this.slider.matches(":active")) this.slider.value = String(tip.wanted / (kDeepest * tip.radius));
    this.depth.show(tip ? short(1000 * tip.wanted, 3).replace("−", "-") : "0");
    if (this.curve.add(tip)) this.draw();
  }

  private showReadings(bench: Bench): void {
    this.bench = bench;
    if (!this.tool.choice.radius) this.radius.show(short(1000 * bench.radius, 3));
    const items = bench.readings.map(({ name, radius, depth, force }, i) => {
      const forget = button({ icon: "close", label: `Forget ${name}, ${inMillimeters(depth)}`, steers: true }, () => this.send({ do: "forget", reading: i }));
      const words = [name, `r ${inMillimeters(radius)}`, inMillimeters(depth), inNewtons(force)];
      return element("li", {}, ...words.map((text) => element("span", {}, text)), forget);
    });
    this.list.replaceChildren(...(items.length > 0 ? items : [element("li", { class: "faint" }, "None yet.")]));
    this.fit.follow(bench);
    this.draw();
  }

  private drawNow(): void {
    const { depths, live, kept } = columnsOf(this.curve.sorted(), this.bench?.readings ?? []);
    this.chart.show(depths, [live, kept]);
  }

  private press(depth: number): void {
    if (!this.tip) return;
    this.store.source.send({ do: "press", depth });
    if (!this.store.state?.playing) this.store.source.send({ do: "play" });
  }

  private send(command: BenchCommand): void {
    void this.store.source.request(command).catch(this.page.report);
  }
}

// The virtual bench: a probe with its force gauge, the cases that were recorded, and the material that is fitted to them.
import "./capture.css";
import { Gauge } from "../capture/gauge";
import { TipForm } from "../capture/tipForm";
import { element } from "../dom";
import type { Page, Panel } from "../page";
import type { Store } from "../store";
import type { Display } from "../view/display";

const kHint =
  "Click the body: a tip touches it there. Drag on to press it in; the gauge shows the force. A stiff place pushes back harder: " +
  "from many such pokes one can tell what is inside.";

export function makeCapturePanel(store: Store, page: Page, display: Display): Panel {
  return new CapturePanel(store, page, display);
}

class CapturePanel implements Panel {
  readonly name = "capture";
  readonly title = "Capture";
  readonly isTall = true;
  readonly element = element("div", { class: "plot-panel capture", role: "group", "aria-label": "Virtual bench" });
  private readonly gauge = new Gauge();
  private readonly tip: TipForm;
  private readonly hint = element("p", { class: "capture-hint" }, kHint);

  constructor(
    private readonly store: Store,
    page: Page,
    private readonly display: Display,
  ) {
    this.tip = new TipForm(store, page, display);
    const chart = element("div", { class: "plot-fill capture-chart" }, this.gauge.chart.element);
    const left = element("div", { class: "capture-column" }, this.hint, this.tip.element);
    this.element.append(left, this.gauge.element, chart);
    const follow = (): void => this.follow();
    store.on("state", follow);
    store.on("role", follow);
    page.on("theme", () => this.gauge.chart.retheme());
    page.on("layout", () => this.gauge.chart.retheme());
  }

  // The mouse has the probe while the panel is open.
  show(visible: boolean): void {
    this.gauge.visible = visible;
    const { tool } = this.display.settings;
    if (visible && tool === "drag") this.display.change({ tool: "probe" });
    if (!visible && tool === "probe") this.display.change({ tool: "drag" });
    if (visible) this.gauge.refresh();
  }

  private follow(): void {
    const probe = this.store.state?.a.probe ?? null;
    this.gauge.show(probe);
    this.tip.show(probe);
  }
}

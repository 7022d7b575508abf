// The virtual bench: a probe with its force gauge, the recorded cases, and the material that is fitted to them.
import "./capture.css";
import { CaseList } from "../capture/caseList";
import { FitForm } from "../capture/fitForm";
import { Gauge } from "../capture/gauge";
import { TipForm } from "../capture/tipForm";
import { element } from "../dom";
import type { Page, Panel } from "../page";
import type { Store } from "../store";
import type { Display } from "../view/display";

const kHint =
  "Click the body to touch it with a tip. Drag on to press it in; the gauge shows the force. Stiff places need a larger force: " +
  "many pokes together reveal the stiffness inside.";

export class CapturePanel implements Panel {
  readonly name = "capture";
  readonly title = "Capture";
  readonly isTall = true;
  readonly element = element("div", { class: "plot-panel capture", role: "group", "aria-label": "Virtual bench" });
  private readonly gauge = new Gauge();
  private readonly tip: TipForm;
  private readonly cases: CaseList;
  private readonly fit: FitForm;
  private isSetUp = false;
  private readonly hint = element("p", { class: "capture-note faint" }, kHint);

  constructor(
    private readonly store: Store,
    page: Page,
    private readonly display: Display,
  ) {
    this.tip = new TipForm(store, page, display);
    const chart = element("div", { class: "plot-fill capture-chart" }, this.gauge.chart.element);
    this.cases = new CaseList(store, page, display);
    this.fit = new FitForm(store, page);
    const left = element("div", { class: "capture-column" }, this.hint, this.tip.element);
    const right = element("div", { class: "capture-column" }, this.cases.element);
    const last = element("div", { class: "capture-column" }, this.fit.element);
    this.element.append(left, this.gauge.element, chart, right, last);
    const follow = (): void => this.follow();
    store.on("state", follow);
    store.on("role", follow);
    store.on("capture", () => this.showBench());
  }

  // The mouse moves the probe while the panel is open.
  show(visible: boolean): void {
    const { tool } = this.display.settings;
    if (visible && tool === "drag") this.display.change({ tool: "probe" });
    if (!visible && tool === "probe") this.display.change({ tool: "drag" });
    this.display.showsBench = visible;
    this.display.change({});
    if (!visible) return;
    this.gauge.redraw();
    this.setUp();
  }

  // Places the markers when the panel first becomes visible.
  private setUp(): void {
    if (this.isSetUp || !this.element.isConnected || !this.store.steers || !this.store.capture) return;
    this.isSetUp = true;
    if (this.store.capture.tets === 0) this.store.source.request({ do: "bench" }).catch(() => {}); // a body that cannot be measured is reported later
  }

  private follow(): void {
    const probe = this.store.state?.a.probe ?? null;
    this.gauge.show(probe);
    this.tip.show(probe);
    this.cases.follow(probe);
  }

  private showBench(): void {
    const { capture } = this.store;
    this.setUp();
    this.cases.show(capture);
    this.fit.show(capture);
    this.gauge.showRecorded((capture?.cases ?? []).map(({ depth, push }) => [depth, push]));
  }
}

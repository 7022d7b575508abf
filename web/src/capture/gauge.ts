// Force gauge of the probe: dial, numbers, and force over depth.
import { element } from "../dom";
import { Chart } from "../plots/chart";
import { oncePerFrame } from "../controls";
import { withUnit } from "../plots/numbers";
import { merged } from "../plots/table";
import type { ProbeState } from "../protocol";
import { length } from "../view/lens";
import { vectorText } from "../view/values";
import { ForceCurve } from "./curve";
import { Dial } from "./dial";

export class Gauge {
  readonly element = element("section", { class: "capture-gauge", "aria-label": "Force gauge" });
  readonly chart = new Chart();
  private readonly dial = new Dial("N");
  private readonly force = element("output", { class: "capture-force", "aria-label": "Force of the tip" });
  private readonly parts = element("dl", { class: "capture-parts" });
  private readonly curve = new ForceCurve();
  private recorded: [depth: number, force: number][] = [];
  readonly redraw = oncePerFrame(() => this.element.isConnected && this.draw());

  constructor() {
    this.element.append(element("h3", {}, "Force gauge"), this.dial.element, this.force, this.parts);
    this.chart.configure({
      label: "Force over depth",
      x: { label: "depth", unit: "m" },
      y: { label: "force", unit: "N" },
      curves: [
        { key: "live", label: "now", meaning: "Readings during this touch", color: "series2", width: 2, shape: "both" },
        { key: "recorded", label: "recorded", meaning: "Recorded cases with noise", color: "series1", shape: "points" },
      ],
    });
    this.show(null);
  }

  show(probe: ProbeState | null): void {
    const newtons = probe ? length(probe.force) : 0;
    this.dial.show(newtons);
    this.force.textContent = probe ? withUnit(newtons, "N", 3) : "–";
    const parts = {
      depth: probe && withUnit(probe.depth, "m", 3),
      "force x, y, z": probe && vectorText(probe.force, "N"),
      torque: probe && withUnit(length(probe.torque), "Nm", 3),
      touches: probe && (probe.points > 0 ? `${probe.points} points` : "no contact"),
    };
    this.parts.replaceChildren(
      ...Object.entries(parts).flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value ?? "–")]),
    );
    if (this.curve.add(probe)) this.redraw();
  }

  showRecorded(points: [depth: number, force: number][]): void {
    this.recorded = [...points].sort((a, b) => a[0] - b[0]);
    this.redraw();
  }

  private draw(): void {
    const column = (points: [number, number][]) => ({ x: points.map(([x]) => x), columns: [points.map(([, y]) => y)] });
    const { x, columns } = merged(column(this.curve.sorted()), column(this.recorded));
    this.chart.show(x, columns);
  }
}

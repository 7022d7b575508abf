// Shows the largest marker residuals as magnified arrows from the measured to the fitted position.
import { element } from "../../../web/src/dom";
import { choice } from "../../../web/src/controls";
import { roundStep } from "../../../web/src/view/ranges";
import { short, withUnit } from "../../../web/src/numbers";
import type { CameraRig } from "../../../web/src/view/cameras";
import { makeArrows, makeBalls, type Arrow } from "./arrows";
import { numberTable } from "./numberTable";
import { BodyView, type FittedBody, type Note } from "./bodyView";
import { along, length, vectorAt } from "../../../web/src/view/lens";
import { isCorrected, markerName, worstMarkers, type Fit, type WorstMarker } from "./data";

const kArrows = 60;
const kRows = 10;
const kLongest = 0.25; // longest arrow relative to the body's size

export class Misfits {
  readonly element: HTMLElement;
  private readonly view: BodyView;
  private readonly note = element("p", { class: "hint" });
  private readonly table = element("tbody");
  private readonly isCorrected: boolean;

  constructor(
    private readonly fit: Fit,
    private readonly body: FittedBody,
    rig: CameraRig,
  ) {
    this.isCorrected = isCorrected(fit.head.figures);
    this.view = new BodyView(body, rig, "Largest marker residuals on the body");
    this.view.showWires(false);
    const cases: [string, string][] = [["all", "all cases"], ...fit.head.cases.map((c, i): [string, string] => [String(i), c.name])];
    const pick = choice("worst markers of", "Case whose residuals are drawn", cases, "all", (value) => this.show(value === "all" ? null : Number(value)));
    this.element = element(
      "div",
      { class: "map-row misfits" },
      element("div", { class: "map plot-panel" }, pick.element, this.view.element, this.note),
      numberTable(["marker", "case", ...(this.isCorrected ? ["error, corrected", "error on the mesh"] : ["error"]), "error [sd]"], 2, this.table),
    );
    this.show(null);
  }

  private show(onlyCase: number | null): void {
    const worst = worstMarkers(this.fit, kArrows, onlyCase);
    const rest = this.fit.floats("markers");
    const largest = Math.max(...worst.map((w) => length(w.error)), 1e-300);
    const scale = largest > 1e-300 ? magnification((kLongest * this.body.size) / largest) : 1;
    const arrows: Arrow[] = worst.map((w) => {
      const from = vectorAt(rest, w.marker);
      return { from, to: along(from, scale, w.error) };
    });
    const size = this.body.size;
    const notes: Note[] = worst.slice(0, 1).map((w) => ({ at: vectorAt(rest, w.marker), words: `marker ${markerName(this.fit.head, w.marker)}: ${withUnit(length(w.error), "m", 3)}` }));
    this.view.mark([makeArrows(arrows, 0.005 * size, "#d55e00"), makeBalls(arrows.map((a) => a.from), 0.006 * size, "#1b1f27")], notes);
    const hidden = this.fit.head.cases.reduce((sum, c, i) => sum + (onlyCase === null || onlyCase === i ? c.hidden : 0), 0);
    const others = hidden > 0 ? ` ${hidden} readings with smaller residuals are not in this page.` : "";
    this.note.textContent = worst.length > 0 ? `Arrows are ${short(scale, 3)} times as long as the residuals, at the rest positions of the markers.${others}` : "This case has no measured positions.";
    this.table.replaceChildren(...worst.slice(0, kRows).map((w) => this.row(w)));
  }

  private row(w: WorstMarker): HTMLElement {
    const cells = [markerName(this.fit.head, w.marker), this.fit.head.cases[w.case].name, withUnit(length(w.error), "m", 3), ...(this.isCorrected ? [withUnit(w.onMesh, "m", 3)] : []), short(w.sigmas, 3)];
    return element("tr", {}, ...cells.map((text, i) => element("td", { class: i > 1 ? "number" : "" }, text)));
  }
}

// Largest round number that does not exceed the requested one.
function magnification(wished: number): number {
  const step = roundStep(wished);
  return step > wished * (1 + 1e-9) ? roundStep(wished / 2.5) : step;
}

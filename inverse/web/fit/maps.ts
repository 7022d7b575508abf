// Two views of the fitted body side by side: a quantity and its uncertainty. Both have the same cut and camera.
import { element } from "../../../web/src/dom";
import { checkbox, choice } from "../../../web/src/controls";
import type { Vec3 } from "../../../web/src/protocol";
import { sceneAxes, type CameraRig } from "../../../web/src/view/cameras";
import { short, withUnit } from "../../../web/src/numbers";
import { vectorAt } from "../../../web/src/view/lens";
import { extremes } from "../../../web/src/view/ranges";
import { makeBalls } from "./arrows";
import { BodyView, type Cut, type FittedBody, type Shown } from "./bodyView";
import { percentile, type Fit } from "./data";
import { kQuantityNames as kNames } from "./trust";

interface Field {
  key: string;
  title: string;
  shown: Shown;
}

const kEnds = [0.02, 0.98]; // percentiles of the tets at the ends of the colors, so that a few tets do not flatten the picture

function clipped(values: Float32Array): [number, number] {
  return [percentile(values, kEnds[0]), percentile(values, kEnds[1])];
}

// Range of the colors in words, and the values outside.
export function colorCaption({ values, range: [low, high], unit }: Shown): string {
  const [least, most] = extremes(values) ?? [NaN, NaN];
  const text = (value: number): string => (unit === "" ? short(value, 3) : withUnit(value, unit, 3));
  if (least >= low && most <= high) return least === most ? `All tets have the value ${text(least)}.` : `Colors span ${text(low)} to ${text(high)}.`;
  const [first, last] = kEnds.map((part) => `${Math.round(100 * part)} %`);
  return `Colors span the ${first} and ${last} percentiles of the tets, ${text(low)} to ${text(high)}; the values range from ${text(least)} to ${text(most)}.`;
}

// Half width of the 95 % interval of a normal distribution, in standard deviations.
const kDeviations95 = 1.96;

function fieldsOf(fit: Fit): { values: Field[]; doubts: Field[] } {
  const [values, doubts]: Field[][] = [[], []];
  const array = (name: string): Float32Array | null => (fit.arrays.has(`tet.${name}`) ? fit.floats(`tet.${name}`) : null);
  for (const { name: key, unit, isLog: log } of fit.head.quantities) {
    const name = kNames[key] ?? key;
    const [value, sigma, reduction] = [array(key), array(`${key}_deviation`), array(`${key}_reduction`)];
    if (!value) continue;
    values.push({ key, title: name, shown: { label: key === "young" ? "E" : key, unit, values: value, map: "viridis", log, range: clipped(value) } });
    if (sigma) {
      const numbers = log ? sigma.map((s) => Math.exp(kDeviations95 * s)) : sigma;
      const title = `${name}: ${log ? "known within a factor" : "standard deviation"}`;
      const shown: Shown = { label: log ? "factor" : "deviation", unit: "", values: numbers, map: "cividis", log: false, range: clipped(numbers) };
      doubts.push({ key: `${key}.deviation`, title, shown });
    }
    if (reduction) {
      const shown: Shown = { label: "determined", unit: "", values: reduction, map: "blue_orange", log: false, range: [0, 1] };
      doubts.push({ key: `${key}.reduction`, title: `${name}: determined by the data, 0 to 1`, shown });
    }
  }
  return { values, doubts };
}

export class Maps {
  readonly element = element("div", { class: "maps" });
  private readonly views: BodyView[] = [];
  private cut: Cut;
  private isCut = true;
  private readonly showsMarkers = checkbox("markers", "Show the markers at rest", false, () => this.mark());

  constructor(
    private readonly fit: Fit,
    private readonly body: FittedBody,
    rig: CameraRig,
  ) {
    const { values, doubts } = fieldsOf(fit);
    this.cut = cutInFront(body.up);
    const row = element("div", { class: "map-row" });
    if (values.length > 0) row.append(this.column("Quantity", values, rig));
    if (doubts.length > 0 && fit.head.quantities.some((q) => q.varies)) row.append(this.column("Uncertainty", doubts, rig));
    this.element.append(this.controls(), row, element("p", { class: "hint" }, "Drag to turn, shift-drag to move, ctrl-wheel to zoom, double-click to see all. Both views move together."));
    this.mark();
  }

  private column(label: string, fields: Field[], rig: CameraRig): HTMLElement {
    const view = new BodyView(this.body, rig, `${label} on the body`);
    this.views.push(view);
    const caption = element("p", { class: "hint" });
    const show = ({ shown }: Field): void => {
      view.show(shown);
      caption.textContent = colorCaption(shown);
    };
    show(fields[0]);
    view.slice(this.cut);
    const pick = choice("", label, fields.map(({ key, title }) => [key, title] as const), fields[0].key, (key) => {
      const field = fields.find((f) => f.key === key);
      if (field) show(field);
    });
    return element("div", { class: "map" }, pick.element, view.element, caption);
  }

  private controls(): HTMLElement {
    const slice = (): void => {
      position.disabled = !this.isCut;
      for (const view of this.views) view.slice(this.isCut ? this.cut : null);
    };
    const position = element("input", { type: "range", min: "0", max: "1", step: "0.01", value: "0.5", "aria-label": "Position of the cut" });
    position.addEventListener("input", () => {
      this.cut = { ...this.cut, at: position.valueAsNumber };
      slice();
    });
    const axis = choice("cut", "Cut the body open", [["off", "off"], ["0", "across x"], ["1", "across y"], ["2", "across z"]], String(this.cut.axis), (value) => {
      this.isCut = value !== "off";
      if (this.isCut) this.cut = { ...this.cut, axis: Number(value) as 0 | 1 | 2 };
      slice();
    });
    axis.select.dataset.control = "cut";
    const other = checkbox("other half", "Show the hidden half", this.cut.other, (on) => {
      this.cut = { ...this.cut, other: on };
      slice();
    });
    const wires = checkbox("edges", "Show the edges of the tets", true, (on) => this.views.forEach((view) => view.showWires(on)));
    return element("div", { class: "map-controls plot-panel" }, axis.element, position, other.element, this.showsMarkers.element, wires.element);
  }

  private mark(): void {
    const markers = this.fit.floats("markers");
    const centers = Array.from({ length: markers.length / 3 }, (_, i) => vectorAt(markers, i));
    for (const view of this.views) view.mark(this.showsMarkers.input.checked ? [makeBalls(centers, 0.006 * this.body.size, "#1b1f27")] : [], []);
  }
}

// Cut through the middle that faces the camera.
function cutInFront(up: Vec3): Cut {
  const front = sceneAxes(up).front.toArray();
  const axis = [0, 1, 2].reduce((best, k) => (Math.abs(front[k]) > Math.abs(front[best]) ? k : best)) as 0 | 1 | 2;
  return { axis, at: 0.5, other: front[axis] < 0 };
}

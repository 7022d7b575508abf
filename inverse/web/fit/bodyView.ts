// The fitted body in 3-D: colored by a quantity of its tets, whole or cut open, with arrows and balls on it. The
// cameras of all views of a page move together.
import "../../../web/src/view/view.css";
import * as THREE from "three";
import { element } from "../../../web/src/dom";
import type { Vec3 } from "../../../web/src/protocol";
import { onLook } from "../../../web/src/theme";
import { Body, boxOf } from "../../../web/src/view/body";
import type { CameraRig } from "../../../web/src/view/cameras";
import type { MapName } from "../../../web/src/view/colorMaps";
import { kDefaults } from "../../../web/src/view/display";
import { disposeOf } from "../../../web/src/view/dispose";
import { kSkinPoint } from "../../../web/src/view/labels";
import { length, minus } from "../../../web/src/view/lens";
import { kBarWidth } from "../../../web/src/view/marks";
import { readStyle } from "../../../web/src/view/overlay";
import { logRange, type ColorRange } from "../../../web/src/view/ranges";
import { Screen } from "../../../web/src/view/screen";
import { bodyBelow, boundaryOf, type Boundary, type Plane, type Soup, type TetMesh } from "./cut";

export interface Shown {
  label: string; // label of the color bar
  unit: string;
  values: Float32Array; // one value per tet
  map: MapName;
  log: boolean;
  range: [number, number]; // range of the colors; values outside have the colors of its ends
}

export interface Note {
  at: Vec3;
  words: string;
}

export interface Cut {
  axis: 0 | 1 | 2;
  at: number; // position of the cut, 0 to 1 over the box
  other: boolean; // keep the other half
}

const kWheel = 0.0015;

// Data that all views of a page share, computed once.
export class FittedBody {
  readonly boundary: Boundary;
  readonly lower: Vec3;
  readonly upper: Vec3;
  readonly size: number; // length of the box's diagonal [m]

  constructor(
    readonly mesh: TetMesh,
    readonly up: Vec3,
  ) {
    this.boundary = boundaryOf(mesh);
    ({ lower: this.lower, upper: this.upper } = boxOf(mesh.points));
    this.size = length(minus(this.upper, this.lower));
  }

  plane(cut: Cut | null): Plane | null {
    if (!cut) return null;
    const sign = cut.other ? -1 : 1;
    const normal = [0, 1, 2].map((c) => (c === cut.axis ? sign : 0)) as Vec3;
    const level = this.lower[cut.axis] + cut.at * (this.upper[cut.axis] - this.lower[cut.axis]);
    return { normal, offset: sign * level };
  }
}

export class BodyView {
  readonly element = element("div", { class: "view fit-view" });
  private readonly screen = new Screen();
  private body: Body | null = null;
  private soup: Soup | null = null;
  private shown: Shown | null = null;
  private cut: Cut | null = null;
  private objects: THREE.Object3D[] = [];
  private notes: Note[] = [];
  private wires = true;
  private frame = 0;
  drawn = 0; // number of pictures drawn

  constructor(
    private readonly fitted: FittedBody,
    private readonly rig: CameraRig,
    label: string,
  ) {
    this.element.append(this.screen.canvas, this.screen.overlay.canvas, this.screen.message);
    this.element.setAttribute("role", "img");
    this.element.setAttribute("aria-label", label);
    this.screen.stage?.place({ lower: fitted.lower, upper: fitted.upper, up: fitted.up });
    rig.on("changed", () => this.redraw());
    new ResizeObserver(() => this.applyDisplay()).observe(this.element); // the element's colors come from the page
    onLook(() => this.applyDisplay());
    this.listen();
    this.rebuild();
  }

  show(shown: Shown | null): void {
    this.shown = shown;
    this.recolor();
  }

  slice(cut: Cut | null): void {
    this.cut = cut;
    this.rebuild();
  }

  showWires(wires: boolean): void {
    this.wires = wires;
    this.applyDisplay();
  }

  // Replaces the previous marks.
  mark(objects: THREE.Object3D[], notes: Note[]): void {
    for (const object of this.objects) disposeOf(object);
    [this.objects, this.notes] = [objects, notes];
    this.screen.stage?.extras.clear();
    for (const object of objects) this.screen.stage?.extras.add(object);
    this.redraw();
  }

  redraw(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.draw());
  }

  // Builds the body for a new cut. No two triangles share corners.
  private rebuild(): void {
    this.soup = bodyBelow(this.fitted.mesh, this.fitted.boundary, this.fitted.plane(this.cut));
    const { positions, normals, tet, edges } = this.soup;
    const corners = positions.length / 3;
    const triangles = Uint32Array.from({ length: corners }, (_, i) => i);
    const vertex = new Uint32Array(corners).fill(kSkinPoint);
    this.body = new Body({ side: "a", generation: 1, rest: positions, triangles, edges, tet, vertex });
    this.screen.stage?.show(this.body);
    this.body.show({ positions, normals, values: null });
    this.screen.stage?.moved();
    this.applyDisplay();
    this.recolor();
  }

  private recolor(): void {
    const { body, soup, shown } = this;
    if (!body || !soup) return;
    if (shown) {
      const values = new Float32Array(soup.corner.length);
      for (let i = 0; i < values.length; ++i) values[i] = shown.values[soup.tet[Math.floor(i / 3)]];
      body.show({ positions: body.current, normals: body.shading, values });
    }
    body.color(shown && this.range(shown), shown?.map ?? "viridis");
    this.redraw();
  }

  private range(shown: Shown): ColorRange {
    const [low, high] = shown.range;
    const positive = shown.log ? logRange(low, high) : null;
    return positive ? { ...positive, log: true } : { low, high, log: false };
  }

  private applyDisplay(): void {
    const style = readStyle(this.element, kDefaults, null);
    this.body?.apply({ ...kDefaults, wires: this.wires, bodyColor: "#b9c3d0", inside: "same" });
    this.screen.stage?.apply(kDefaults, style);
    this.redraw();
  }

  private draw(): void {
    this.frame = 0;
    const { clientWidth: width, clientHeight: height } = this.element;
    if (!this.screen.stage || width === 0 || height === 0) return;
    const { shown } = this;
    const style = readStyle(this.element, kDefaults, null);
    const lens = this.rig.lens(Math.max(1, width - (shown ? kBarWidth * style.em : 0)), height);
    this.screen.draw(lens, width, Math.min(2, devicePixelRatio), style, {
      axes: true,
      bar: shown && { field: shown, range: this.range(shown), map: shown.map },
      highlights: this.notes.map(({ at, words }) => ({ positions: [at], text: words })),
    });
    ++this.drawn;
    this.element.dataset.drawn = String(this.drawn);
  }

  private listen(): void {
    const host = this.element;
    host.addEventListener("pointerdown", (event) => host.setPointerCapture(event.pointerId));
    host.addEventListener("pointermove", (event) => {
      if (!host.hasPointerCapture(event.pointerId)) return;
      if (event.shiftKey || (event.buttons & 2) !== 0) this.rig.pan(event.movementX, event.movementY, host.clientHeight);
      else this.rig.turn(event.movementX, event.movementY);
    });
    host.addEventListener("contextmenu", (event) => event.preventDefault());
    host.addEventListener("dblclick", () => this.rig.center(this.fitted.lower, this.fitted.upper));
    // Zooms with Ctrl only: the wheel alone scrolls the page.
    const wheel = (event: WheelEvent): void => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      const box = host.getBoundingClientRect();
      const [x, y] = [event.clientX - box.left - box.width / 2, box.height / 2 - (event.clientY - box.top)];
      this.rig.zoom(Math.exp(kWheel * event.deltaY), x, y, box.height);
    };
    host.addEventListener("wheel", wheel, { passive: false });
  }
}

// The body of one side on the stage, according to its scene, its newest picture and the display.
import type { Field, SideName, StepRow } from "../protocol";
import type { Side, Store } from "../store";
import { bodyColors } from "./bodies";
import { Body } from "./body";
import { largestPressure } from "./contacts";
import { differenceOf, kDifference, largestShown } from "./difference";
import type { Display } from "./display";
import type { Style } from "./overlay";
import type { Surface } from "./picking";
import { RunningRange, type ColorRange } from "./ranges";
import type { Stage } from "./stage";
import { halfThickness, ThickSheets } from "./thickSheets";

export class Figure {
  body: Body | null = null; // null without a stage
  private valuesOf = ""; // field of the body's values
  private difference: Float32Array | null = null; // distance from the other side [m]
  private lost = false;
  private isThick = false; // the body has sheets as solids
  private readonly pressures = new RunningRange(); // of the contact points [Pa]

  constructor(
    private readonly store: Store,
    private readonly name: SideName,
    private readonly display: Display,
    private readonly stage: Stage | null,
  ) {}

  get side(): Side | null {
    return this.store.side(this.name);
  }

  // Returns true if the body is new.
  takeScene(): boolean {
    const scene = this.side?.scene;
    if (!scene) return false;
    this.display.cameras[this.name].show(scene.name, scene.lower, scene.upper, scene.up);
    const isOld = this.body !== null && this.body.geometry.generation !== scene.generation;
    if (isOld) {
      this.stage?.remove();
      this.body = null;
    }
    return this.takeGeometry() || isOld;
  }

  takeGeometry(): boolean {
    const { side, stage } = this;
    const { thickness } = this.display.settings;
    if (!stage || !side?.geometry || (this.body?.geometry === side.geometry && this.isThick === thickness)) return false;
    this.isThick = thickness;
    stage.place(side.scene); // show() below removes the present body
    const half = thickness ? halfThickness(side.geometry, side.scene) : null;
    const solid = half && new ThickSheets(side.geometry.triangles, half);
    this.body = new Body(side.geometry, side.scene.body_tets, side.scene.tets, side.scene.triangles, solid);
    stage.show(this.body);
    this.body.setPins(side.pins);
    this.body.setFibres(side.fibres);
    this.pressures.reset();
    this.takeObstacles();
    this.takePicture();
    return true;
  }

  takeObstacles(): void {
    this.stage?.showObstacles(this.side?.obstacles ?? []);
  }

  takePicture(): void {
    const { side, body } = this;
    if (!body || !side?.picture || side.picture.positions.length !== body.current.length) return;
    body.show(side.picture);
    this.valuesOf = side.picture.values ? side.scene.field : "";
    const field = this.field();
    if (side.picture.values && field && !this.isLost()) this.display.feed(this.name, field, side.picture.min, side.picture.max);
    this.takeDifference();
    this.color();
    const { contacts } = side.picture;
    this.pressures.feed(this.name, 0, largestPressure(contacts));
    this.stage?.contacts.show(contacts, this.largestPressure());
    this.stage?.arrows.show(side.picture.arrows);
    this.stage?.moved();
  }

  // Follows the newest pictures of both sides.
  takeDifference(): void {
    const { a, b } = this.store.sides;
    const isShown = this.display.settings.difference && this.side?.scene.field === "";
    const now = isShown ? differenceOf(a, b) : null;
    if (now === undefined || !this.body) return;
    const largest = now && this.side ? largestShown(now, this.side.scene) : 0;
    this.difference = largest > 0 ? now : null; // equal sides keep the color of the body
    if (!this.difference) return;
    this.body.showValues(this.difference);
    if (!this.isLost()) this.display.feed(this.name, kDifference, 0, largest);
  }

  // A side that has blown up does not contribute to the range of the colors.
  takeState(): void {
    const wasLost = this.lost;
    this.lost = this.isLost();
    if (this.lost && !wasLost) this.display.forget(this.name);
  }

  private isLost(): boolean {
    return this.store.state?.[this.name]?.status === "undefined";
  }

  apply(style: Style): void {
    this.takeGeometry();
    this.takeDifference();
    this.body?.apply(this.display.settings);
    this.stage?.apply(this.display.settings, style);
    this.stage?.clip(this.side && this.display.clip(this.side.scene));
    this.color();
  }

  color(): void {
    const shown = this.colored();
    if (shown) this.body?.color(shown.range, this.display.map(shown.field));
    else this.body?.colorBodies(this.display.settings.bodyColor, this.display.settings.tissue);
  }

  // Names and colors of the bodies if there are several.
  bodies(): { name: string; color: string }[] {
    const names = this.side?.scene.bodies ?? [];
    if (names.length < 2 || !this.body) return [];
    const colors = bodyColors(this.display.settings.bodyColor, names.length, this.display.settings.tissue);
    return names.map((name, i) => ({ name, color: colors[i]! }));
  }

  // Field and range of the body's colors.
  colored(): { field: Field; range: ColorRange } | null {
    const field = this.field();
    const range = field && this.display.range(field);
    return field && range ? { field, range } : null;
  }

  // The contact points of the picture, and the step that it ends; null without any.
  contact(): { largest: number; row: StepRow | null } | null {
    const picture = this.side?.picture;
    if (!this.body || !picture || !this.display.settings.contacts || picture.contacts.length === 0) return null;
    const steps = this.side?.steps ?? [];
    const row = picture.iteration < 0 ? steps[picture.step - (steps[0]?.step ?? 0)] : null;
    return { largest: this.largestPressure(), row: row ?? null };
  }

  surface(): Surface | null {
    if (!this.body?.root.visible || !this.side) return null;
    const { current, geometry } = this.body;
    return { positions: current, triangles: geometry.triangles, clip: this.display.clip(this.side.scene) };
  }

  // The last color has one pressure throughout a recorded run, so that its pictures can be compared.
  private largestPressure(): number {
    return this.store.source.largestPressure ?? this.pressures.get()?.high ?? 0;
  }

  // Values of the colors at the vertices.
  values(): Float32Array | null {
    return this.difference ?? this.side?.picture?.values ?? null;
  }

  private field(): Field | null {
    if (this.difference) return kDifference;
    const scene = this.side?.scene;
    if (!scene || this.valuesOf !== scene.field) return null;
    return scene.fields.find((field) => field.name === scene.field) ?? null;
  }
}

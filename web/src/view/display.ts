// Display settings that the views of both sides share.
import { Emitter } from "../emitter";
import { fieldsOf, type Keeper } from "../page";
import type { Field, Scene, SideName, Vec3 } from "../protocol";
import { CameraRig } from "./cameras";
import type { MapName } from "./colorMaps";
import type { Clip } from "./picking";
import { about, logRange, RunningRange, type ColorRange } from "./ranges";
import type { ViewTool } from "./viewTool";

export const kDefaults = {
  fill: true,
  thickness: false, // draws sheets as solids
  wires: true,
  wiresOnTop: false,
  smooth: true,
  bodyColor: "#4f8fd0",
  lineColor: "#0d1726",
  inside: "own" as "own" | "same" | "hidden",
  insideColor: "#d9a05b",
  invert: false, // swap outside and inside
  shininess: 40,
  tissue: false, // bodies after the first have hues of organs
  skin: false, // light that enters the body reddens its shadows
  ownBackground: false, // otherwise the background of the theme
  background: "#ffffff",
  transparent: false, // no background, for pictures
  obstacles: true,
  obstacleColor: "#a7a39b",
  grid: true, // of the ground
  contacts: true,
  shadows: true,
  axes: true,
  scaleBar: false, // in orthographic views, where a length is the same at every depth
  textSize: 1, // in pictures, relative to the usual size; 0: no texts and marks
  pins: true,
  fibres: true,
  clip: "off" as "off" | "x" | "y" | "z",
  clipAt: 0.5, // position in the box of the scene, 0 to 1
  clipOther: false, // keep the other half
  vertexLabels: false,
  faceLabels: false,
  map: "auto" as "auto" | MapName,
  scale: "auto" as "auto" | "linear" | "log", // auto: the default of the field
  difference: true, // colors both sides of a comparison by their distance, unless a field does
  fixedRange: false,
  low: 0,
  high: 1,
  tool: "drag" as "drag" | "pin" | "read" | "extension",
  brush: 24, // radius [px]
  unpin: false, // the brush unpins
  linked: true, // one camera for both sides
};
export type DisplaySettings = typeof kDefaults;
export type Amount = { [K in keyof DisplaySettings]: DisplaySettings[K] extends number ? K : never }[keyof DisplaySettings];

// Values of the settings that are choices, by their labels.
export const kChoices = {
  inside: { "its own color": "own", "as outside": "same", hidden: "hidden" },
  clip: { no: "off", "across x": "x", "across y": "y", "across z": "z" },
  map: { "by field": "auto", viridis: "viridis", cividis: "cividis", "blue to orange": "blue_orange" },
  scale: { "by field": "auto", linear: "linear", logarithmic: "log" },
  tool: { "drag the body": "drag", "pin by brush": "pin", "read values": "read" } as Record<string, string>,
} as const;
const kLimits: { [K in Amount]?: [number, number] } = { shininess: [0, 200], clipAt: [0, 1], brush: [4, 200] };

export class Display extends Emitter<{ changed: void; camera: void; range: void }> implements Keeper {
  readonly settings: DisplaySettings = { ...kDefaults };
  readonly cameras: { a: CameraRig; b: CameraRig } = { a: new CameraRig(), b: new CameraRig() };
  fields: Field[] = []; // of side a
  field = ""; // field shown; "": none
  bodies = 1; // number of bodies of side a
  tool: ViewTool | null = null; // of an extension
  private wereLinked = true;
  private readonly running = new RunningRange();
  private measured = ""; // field of the running range

  constructor() {
    super();
    this.eachCamera((rig) => rig.on("changed", () => this.emit("camera", undefined)));
  }

  // Offers the tool of an extension; before the controls of the display are made.
  addTool(words: string, tool: ViewTool): void {
    kChoices.tool[words] = "extension";
    this.tool = tool;
  }

  // Camera of a side: that of side a while the cameras are linked.
  camera(side: SideName): CameraRig {
    return this.cameras[this.settings.linked ? "a" : side];
  }

  change(changes: Partial<DisplaySettings>): void {
    Object.assign(this.settings, changes);
    if (this.wereLinked && !this.settings.linked) this.cameras.b.join(this.cameras.a);
    this.wereLinked = this.settings.linked;
    for (const [key, [least, most]] of Object.entries(kLimits) as [Amount, [number, number]][])
      this.settings[key] = Math.min(most, Math.max(least, this.settings[key]));
    this.emit("changed", undefined);
  }

  setFields(fields: Field[], field: string, bodies: number): void {
    [this.fields, this.field, this.bodies] = [fields, field, bodies];
    this.emit("changed", undefined);
  }

  // Fixes the colors to the present range.
  fixRange(): void {
    const field = this.fields.find((candidate) => candidate.name === this.field);
    const range = field && this.range(field);
    if (range) this.change({ fixedRange: true, low: range.low, high: range.high });
  }

  eachCamera = (act: (rig: CameraRig) => void): void => Object.values(this.cameras).forEach(act);

  readonly cameraKeeper: Keeper = {
    save: () => ({ a: this.cameras.a.save(), b: this.cameras.b.save() }),
    restore: (saved) => (["a", "b"] as const).forEach((side) => this.cameras[side].restore(fieldsOf(saved)[side])),
  };

  // Adds the smallest and the largest value of a picture.
  feed(side: SideName, field: Field, min: number, max: number): void {
    if (field.name !== this.measured) this.running.reset();
    this.measured = field.name;
    const before = this.running.get();
    this.running.feed(side, min, max);
    const after = this.running.get();
    if (before?.low !== after?.low || before?.high !== after?.high) this.emit("range", undefined);
  }

  forget(side: SideName): void {
    this.running.forget(side);
    this.emit("range", undefined);
  }

  range(field: Field): ColorRange | null {
    const { fixedRange, scale, low, high } = this.settings;
    const running = this.running.get();
    if (!fixedRange && !running) return null;
    const chosen = fixedRange ? { low: Math.min(low, high), high: Math.max(low, high) } : running!;
    const positive = (scale === "auto" ? field.log : scale === "log") ? logRange(chosen.low, chosen.high) : null;
    if (positive) return { ...positive, log: true };
    return { ...(field.diverging && !fixedRange ? about(field.center, chosen.low, chosen.high) : chosen), log: false };
  }

  // Half space of a scene that the plane keeps.
  clip(scene: Scene): Clip | null {
    const { clip, clipAt, clipOther } = this.settings;
    if (clip === "off") return null;
    const axis = "xyz".indexOf(clip);
    const at = scene.lower[axis] + clipAt * (scene.upper[axis] - scene.lower[axis]);
    const sign = clipOther ? 1 : -1;
    return { normal: [0, 1, 2].map((c) => (c === axis ? sign : 0)) as Vec3, offset: sign * at };
  }

  map(field: Field): MapName {
    if (this.settings.map !== "auto") return this.settings.map;
    return field.diverging ? "blue_orange" : "viridis";
  }

  save(): unknown {
    return { ...this.settings };
  }

  restore(saved: unknown): void {
    const changes: Record<string, unknown> = {};
    for (const [key, value] of Object.entries(fieldsOf(saved))) {
      const known = key as keyof DisplaySettings;
      if (!Object.hasOwn(kDefaults, key) || typeof value !== typeof kDefaults[known]) continue;
      const choices = kChoices[key as keyof typeof kChoices];
      if (choices && !Object.values(choices).some((choice) => choice === value)) continue;
      if (typeof value === "number" && !Number.isFinite(value)) continue;
      const isColor = key.endsWith("Color") || key === "background";
      if (isColor && !/^#[0-9a-f]{6}$/i.test(String(value))) continue;
      changes[key] = value;
    }
    this.change(changes);
  }
}

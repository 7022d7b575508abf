// Folders "Mouse", "Display" and "Camera" of the settings, and their shortcuts.
import type { GUI } from "lil-gui";
import { sideHasBlownUp } from "../gain";
import type { Page } from "../page";
import type { SettingValue } from "../protocol";
import type { Side, Store } from "../store";
import { kCameraModes, kViewNames, type CameraMode, type ViewName } from "../view/cameras";
import { kDifference } from "../view/difference";
import { kChoices, kDefaults, type Amount, type Display, type DisplaySettings } from "../view/display";
import type { View } from "../view/view";
import { NumberRow } from "./rows";

type Key = keyof DisplaySettings;
type Switch = { [K in Key]: DisplaySettings[K] extends boolean ? K : never }[Key];
type Choices = Record<string, string>;

// Rows for what some scenes lack.
const kNeeds: { [K in Key]?: (side: Side, store: Store) => boolean } = {
  thickness: ({ scene }) => scene.thickness?.some((t) => t > 0) ?? false,
  obstacles: ({ obstacles }) => obstacles.length > 0,
  contacts: ({ scene }) => scene.potentials.includes("contact"),
  pins: ({ pins }, { source }) => source.live || pins.length > 0, // a brush can add pins
  fibres: ({ fibres }) => fibres.length > 0,
  linked: (_, { sides }) => sides.b !== null,
};

// A folder whose controls change the display and follow changes from elsewhere.
class Folder {
  constructor(
    private readonly gui: GUI,
    private readonly display: Display,
    private readonly store: Store,
  ) {}

  within(title: string): Folder {
    return new Folder(this.gui.addFolder(title).close(), this.display, this.store);
  }

  // `also`: further settings that a change by the reader implies.
  add(key: Key, label: string, also: Partial<DisplaySettings> = {}): void {
    const { settings } = this.display;
    const choices = kChoices[key as keyof typeof kChoices];
    const isColor = key.endsWith("Color") || key === "background";
    const controller = isColor ? this.gui.addColor(settings, key) : this.gui.add(settings, key, choices);
    controller.name(label).onChange((value: unknown) => this.display.change({ ...also, [key]: value }));
    this.display.on("changed", () => controller.updateDisplay());
    const needs = kNeeds[key];
    if (!needs) return;
    const { sides } = this.store;
    const show = (): void => void controller.show([sides.a, sides.b].some((side) => side && needs(side, this.store)));
    for (const event of ["scene", "gone", "obstacles", "pins", "fibres"] as const) this.store.on(event, show);
  }

  slider(key: Amount, label: string, least: number, most: number, step: number): void {
    const kind = Number.isInteger(step) ? "integer" : "number";
    const row = new NumberRow(this.gui, label, { value: this.display.settings[key] }, { min: least, max: most, log: false, kind });
    const show = (): void => row.display(this.display.settings[key]);
    row.name(label).onChange((value: SettingValue) => {
      if (typeof value === "number") this.display.change({ [key]: value });
      show();
    });
    this.display.on("changed", show);
  }

  button(label: string, press: () => void): void {
    this.gui.add({ press }, "press").name(label);
  }

  // Adds a choice whose value lives elsewhere.
  choice(label: string, choices: () => Choices, read: () => string, write: (value: string) => void): void {
    const held = { get value() { return read(); }, set value(value) { write(value); } };
    const controller = this.gui.add(held, "value", choices()).name(label);
    let listed = "";
    const update = (): void => {
      const now = JSON.stringify(choices());
      if (now === listed) controller.updateDisplay();
      else controller.options(choices());
      listed = now;
    };
    this.display.on("changed", update);
    this.display.on("camera", update);
  }
}

export function addDisplayControls(gui: GUI, display: Display, store: Store, page: Page, views: () => View[]): void {
  page.keep("display", display);
  page.keep("camera", display.cameraKeeper);
  addDisplay(new Folder(gui.addFolder("Display"), display, store), display, views);
  addCamera(new Folder(gui.addFolder("Camera").close(), display, store), display, views);
  addMouse(new Folder(gui.addFolder("Mouse").close(), display, store), store.source.live);
  addDisplayShortcuts(page, display);
  addCameraShortcuts(page, display, views);
}

function addMouse(folder: Folder, live: boolean): void {
  folder.add("tool", "Left button");
  if (!live) return;
  folder.slider("brush", "Brush radius [px]", 4, 200, 1);
  folder.add("unpin", "Brush unpins");
}

function addDisplay(folder: Folder, display: Display, views: () => View[]): void {
  addField(folder, display, views);
  folder.add("wires", "Wires");
  folder.add("fill", "Fill");
  folder.add("thickness", "Thickness of sheets");
  folder.add("obstacles", "Obstacles");
  folder.add("contacts", "Contact points");
  folder.add("shadows", "Shadows");
  folder.add("clip", "Cut");
  folder.slider("clipAt", "Cut at", 0, 1, 0.001);
  folder.add("clipOther", "Flip cut");
  addNumbers(folder.within("Numbers and marks"));
  addAppearance(folder.within("Colors and light"));
  folder.button("Reset display", () => display.change(kDefaults));
}

function addNumbers(folder: Folder): void {
  folder.add("vertexLabels", "Vertex numbers");
  folder.add("faceLabels", "Tet numbers");
  folder.add("pins", "Pins");
  folder.add("fibres", "Fibres");
  folder.add("axes", "Axes");
}

function addAppearance(folder: Folder): void {
  folder.add("smooth", "Smooth shading");
  folder.add("bodyColor", "Body");
  folder.add("lineColor", "Wires");
  folder.add("wiresOnTop", "Wires shine through");
  folder.add("inside", "Inside");
  folder.add("insideColor", "Inside's color");
  folder.add("invert", "Invert normals");
  folder.slider("shininess", "Shininess", 0, 200, 1);
  folder.add("skin", "Translucent skin");
  folder.add("ownBackground", "Own background");
  folder.add("background", "Background");
}

// Adds the field that colors the body and the range of its colors.
function addField(folder: Folder, display: Display, views: () => View[]): void {
  const fields = (): Choices => {
    const shown = comparing() ? [kDifference, ...display.fields] : display.fields;
    return { [display.bodies > 1 ? "body" : "none"]: "", ...Object.fromEntries(shown.map((field) => [field.label, field.name])) };
  };
  const comparing = (): boolean => views().length > 1;
  const read = (): string => (display.field === "" && comparing() && display.settings.difference ? kDifference.name : display.field);
  const choose = (field: string): void => {
    const difference = field === kDifference.name;
    if (difference || field === "") display.change({ difference });
    views()[0]?.store.source.send({ do: "color", field: difference ? "" : field });
  };
  folder.choice("Color by", fields, read, choose);
  const range = folder.within("Color range");
  range.add("map", "Colors");
  range.add("fixedRange", "Fixed range");
  range.add("low", "From", { fixedRange: true });
  range.add("high", "To", { fixedRange: true });
  range.button("Fix at what is shown", () => display.fixRange());
  range.add("scale", "Scale");
}

function addCamera(folder: Folder, display: Display, views: () => View[]): void {
  const modes: Record<string, CameraMode> = { turntable: "turntable", free: "orbit", "2-D": "flat" };
  const each = display.eachCamera;
  const setMode = (mode: string): void => each((rig) => rig.setMode(mode as CameraMode));
  folder.choice("Orbit", () => modes, () => display.cameras.a.mode, setMode);
  const kinds = { perspective: "no", orthographic: "yes" };
  const kind = (): string => (display.cameras.a.orthographic ? "yes" : "no");
  folder.choice("Projection", () => kinds, kind, (value) => each((rig) => rig.setOrthographic(value === "yes")));
  folder.button("Center the body", () => centerBodies(display, views()));
  const buttons = folder.within("Look from");
  for (const name of kViewNames) buttons.button(name, () => each((rig) => rig.setView(name)));
  folder.add("linked", "Link cameras");
}

function addDisplayShortcuts(page: Page, display: Display): void {
  const add = (key: string, does: string, run: () => void): void => page.shortcut({ key, does, group: "Display", run });
  const flip = (key: Switch): void => display.change({ [key]: !display.settings[key] });
  const { settings } = display;
  add("w", "Wires: on the body, alone, none", () => {
    if (!settings.fill) display.change({ fill: true, wires: false });
    else if (settings.wires) display.change({ fill: false });
    else display.change({ wires: true });
  });
  add("x", "Cut: across x, y, z, no cut", () => {
    const axes = ["off", "x", "y", "z"] as const;
    display.change({ clip: axes[(axes.indexOf(settings.clip) + 1) % axes.length] });
  });
  add("h", "Shadows", () => flip("shadows"));
  add("n", "Vertex numbers", () => flip("vertexLabels"));
  add("b", "Brush that pins, or drag", () => display.change({ tool: settings.tool === "pin" ? "drag" : "pin" }));
  add("[", "Smaller brush", () => display.change({ brush: settings.brush / 1.25 }));
  add("]", "Larger brush", () => display.change({ brush: settings.brush * 1.25 }));
}

// Fits the bodies to their views. A camera of both sides shows none that has blown up, unless both have.
function centerBodies(display: Display, views: View[]): void {
  const calm = views.filter(({ store, side }) => !sideHasBlownUp(store, side));
  const shown = display.settings.linked && calm.length > 0 ? calm : views;
  for (const { box, rig } of shown) if (box) rig.center(box.lower, box.upper);
}

function addCameraShortcuts(page: Page, display: Display, views: () => View[]): void {
  const add = (key: string, does: string, run: () => void): void => page.shortcut({ key, does, group: "Camera", run });
  const setView = (name: ViewName): void => display.eachCamera((rig) => rig.setView(name));
  kViewNames.forEach((name, i) => add(String(i + 1), `Look from: ${name}`, () => setView(name)));
  const center = (): void => centerBodies(display, views());
  add("0", "Center the body", center);
  add(".", "Center the body", center);
  add("o", "Orthographic or perspective", () => display.eachCamera((rig) => rig.setOrthographic(!rig.orthographic)));
  add("v", "Camera: turntable, free orbit, 2-D", () => {
    const next = kCameraModes[(kCameraModes.indexOf(display.cameras.a.mode) + 1) % kCameraModes.length];
    display.eachCamera((rig) => rig.setMode(next));
  });
  const turn = (dx: number, dy: number): void => display.eachCamera((rig) => rig.turn(dx, dy));
  add("Shift+ArrowLeft", "Turn left", () => turn(-20, 0));
  add("Shift+ArrowRight", "Turn right", () => turn(20, 0));
  add("Shift+ArrowUp", "Turn up", () => turn(0, -20));
  add("Shift+ArrowDown", "Turn down", () => turn(0, 20));
  add("+", "Closer", () => display.eachCamera((rig) => rig.zoom(0.85, 0, 0, 1)));
  add("-", "Farther", () => display.eachCamera((rig) => rig.zoom(1 / 0.85, 0, 0, 1)));
}

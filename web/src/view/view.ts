// One side in 3-D: draws its newest picture, and only when something has changed.
import type { Highlight, Page } from "../page";
import type { Field, SideName, Vec3 } from "../protocol";
import type { Side, Store } from "../store";
import { Body } from "./body";
import type { CameraRig } from "./cameras";
import type { Display } from "./display";
import type { Lens } from "./lens";
import * as marks from "./marks";
import type { Clip, Hit, Surface } from "./picking";
import { Stage } from "./stage";
import { Touch, type Touched } from "./touch";

const kHiddenPause = 500; // between pictures that nobody sees [ms]

export class View implements Touched {
  private readonly glCanvas = document.createElement("canvas");
  private readonly overlay = document.createElement("canvas");
  private readonly stage: Stage | null;
  private readonly touch: Touch;
  private body: Body | null = null;
  private highlights: Highlight[] = [];
  private undrawn = 0; // pictures that the source waits for
  private frame = 0; // requested
  private fixedSize: [number, number] | null = null;
  private rigStop = (): void => {};
  private readonly stop: (() => void)[] = [];
  private readonly listeners = new AbortController();

  constructor(
    readonly host: HTMLElement,
    readonly store: Store,
    readonly page: Page,
    readonly side: SideName,
    readonly display: Display,
  ) {
    this.build();
    this.stage = this.makeStage();
    this.touch = new Touch(this);
    this.listen();
    this.takeScene();
  }

  get rig(): CameraRig {
    return this.display.camera(this.side);
  }

  lens(): Lens {
    return this.rig.lens(...this.size());
  }

  surface(): Surface | null {
    if (!this.body || !this.source?.picture) return null;
    return { positions: this.body.current, triangles: this.body.geometry.triangles, clip: this.clip() };
  }

  read(_hit: Hit | null): void {}

  showPins(vertices: number[]): void {
    this.body?.setPins(vertices);
    this.redraw();
  }

  // The body as it is now fills the view.
  centre(): void {
    if (this.body?.box) this.rig.centre(this.body.box.lower, this.body.box.upper);
  }

  // Once, in the next frame.
  redraw(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.drawNow());
  }

  drawNow(): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    const [width, height] = this.size();
    if (this.stage && width > 0 && height > 0) {
      this.resize(width, height);
      const lens = this.lens();
      this.stage.render(lens, this.rig.orientation, this.colour("--series-2"));
      this.drawMarks(lens);
    }
    this.settle();
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    this.listeners.abort();
    for (const stop of [...this.stop, this.rigStop]) stop();
    this.touch.dispose();
    this.stage?.dispose();
    this.display.forget(this.side);
    this.host.replaceChildren();
    this.settle();
  }

  private get source(): Side | null {
    return this.store.side(this.side);
  }

  private build(): void {
    this.host.classList.add("view");
    this.host.style.position = "relative";
    this.host.style.touchAction = "none";
    for (const canvas of [this.glCanvas, this.overlay])
      Object.assign(canvas.style, { position: "absolute", inset: "0", width: "100%", height: "100%" });
    this.overlay.style.pointerEvents = "none";
    this.host.replaceChildren(this.glCanvas, this.overlay);
  }

  private makeStage(): Stage | null {
    try {
      return new Stage(this.glCanvas);
    } catch {
      return null;
    }
  }

  private listen(): void {
    const mine = (listener: () => void) => (side: SideName) => side === this.side && listener();
    this.stop.push(this.store.on("scene", mine(() => this.takeScene())));
    this.stop.push(this.store.on("geometry", mine(() => this.takeGeometry())));
    this.stop.push(this.store.on("picture", mine(() => this.takePicture())));
    this.stop.push(this.store.on("pins", mine(() => this.showPins(this.source?.pins ?? []))));
    this.stop.push(this.store.on("state", () => this.redraw()));
    this.stop.push(this.display.on("changed", () => this.applyDisplay()));
    this.stop.push(this.page.on("theme", () => this.applyDisplay()));
    this.stop.push(this.page.on("layout", () => this.redraw()));
    const sizes = new ResizeObserver(() => this.redraw());
    sizes.observe(this.host);
    this.stop.push(() => sizes.disconnect());
  }

  private takeScene(): void {
    const scene = this.source?.scene;
    if (!scene) return;
    this.rig.show(scene.path, scene.lower, scene.upper, scene.up);
    if (this.body && this.body.geometry.generation !== scene.generation) this.dropBody();
    this.takeGeometry();
    if (this.side === "a") this.display.setFields(scene.fields, scene.field);
    else this.applyDisplay();
  }

  private takeGeometry(): void {
    const side = this.source;
    if (!this.stage || !side?.geometry || this.body?.geometry === side.geometry) return;
    this.dropBody();
    this.stage.place(side.scene);
    this.body = new Body(side.geometry);
    this.stage.show(this.body);
    this.body.setPins(side.pins);
    if (side.picture) this.body.show(side.picture);
    this.applyDisplay();
  }

  private dropBody(): void {
    this.stage?.remove();
    this.body = null;
  }

  private takePicture(): void {
    this.undrawn += 1;
    const picture = this.source?.picture;
    const field = this.field();
    if (picture && this.body && picture.positions.length === this.body.current.length) {
      this.body.show(picture);
      if (field && picture.values && this.display.feed(this.side, field, picture.min, picture.max)) this.colourBody();
      this.stage?.moved();
    }
    if (document.hidden) setTimeout(() => this.settle(), kHiddenPause);
    else this.redraw();
  }

  // The source may send the next picture.
  private settle(): void {
    const count = this.undrawn;
    this.undrawn = 0;
    for (let i = 0; i < count; ++i) this.store.source.ready();
  }

  private field(): Field | null {
    const scene = this.source?.scene;
    return scene?.fields.find((field) => field.name === scene.field) ?? null;
  }

  private applyDisplay(): void {
    this.rigStop();
    this.rigStop = this.rig.on("changed", () => this.redraw());
    const settings = this.display.settings;
    this.body?.apply(settings);
    this.stage?.apply(settings, {
      background: settings.ownBackground ? settings.background : this.colour("--background"),
      grid: this.colour("--faint"),
      pin: this.colour("--series-2"),
    });
    this.stage?.clip(this.clip());
    this.colourBody();
    this.redraw();
  }

  private colourBody(): void {
    const field = this.field();
    const range = field && this.source?.picture?.values ? this.display.range(field) : null;
    if (this.body && field) this.body.colour(range, this.display.map(field));
    else this.body?.colour(null, "viridis");
  }

  private clip(): Clip | null {
    const { clip, clipAt, clipOther } = this.display.settings;
    const scene = this.source?.scene;
    if (clip === "off" || !scene) return null;
    const axis = "xyz".indexOf(clip);
    const at = scene.lower[axis] + clipAt * (scene.upper[axis] - scene.lower[axis]);
    const sign = clipOther ? 1 : -1;
    return { normal: [0, 1, 2].map((c) => (c === axis ? sign : 0)) as Vec3, offset: sign * at };
  }

  private size(): [number, number] {
    return this.fixedSize ?? [this.host.clientWidth, this.host.clientHeight];
  }

  private resize(width: number, height: number): void {
    const ratio = this.fixedSize ? 1 : Math.min(3, window.devicePixelRatio || 1);
    const wanted = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.overlay.width === wanted[0] && this.overlay.height === wanted[1]) return;
    this.stage?.renderer.setPixelRatio(ratio);
    this.stage?.renderer.setSize(width, height, false);
    [this.overlay.width, this.overlay.height] = wanted;
  }

  private drawMarks(lens: Lens): void {
    const context = this.overlay.getContext("2d");
    if (!context) return;
    const ratio = this.overlay.width / lens.width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, lens.width, lens.height);
    const em = parseFloat(getComputedStyle(this.host).fontSize);
    context.font = `${em}px ${getComputedStyle(this.host).fontFamily}`;
    const ink = { context, em, text: this.colour("--text"), halo: this.colour("--background"), accent: this.colour("--series-2") };
    this.drawScales(ink, lens);
    const settings = this.display.settings;
    if (this.side === "a") for (const { positions, text } of this.highlights) marks.highlight(ink, lens, positions, text);
    const grab = this.store.state?.[this.side]?.grab;
    if (grab) marks.spring(ink, lens, grab.point, this.touch.target ?? grab.target, grab.force);
    if (settings.tool === "pin" && this.touch.cursor) marks.ring(ink, this.touch.cursor, settings.brush, settings.unpin ? "unpin" : "pin");
  }

  private drawScales(ink: marks.Ink, lens: Lens): void {
    const settings = this.display.settings;
    if (settings.axes) marks.axes(ink, lens);
    if (settings.ground && this.stage && this.body) marks.gridNote(ink, lens, this.stage.gridStep);
    const field = this.field();
    const range = field && this.source?.picture?.values ? this.display.range(field) : null;
    if (field && range) marks.colourBar(ink, lens, field, range, this.display.map(field));
  }

  private colour(variable: string): string {
    return getComputedStyle(this.host).getPropertyValue(variable).trim() || "#808080";
  }
}

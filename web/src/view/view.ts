// 3-D view of one side: draws its newest picture, and only after a change.
import "./view.css";
import type { Highlight, Page } from "../page";
import { sideHasBlownUp } from "../gain";
import type { SideName } from "../protocol";
import type { Store } from "../store";
import { onLook } from "../theme";
import type { Box } from "./body";
import type { CameraRig } from "./cameras";
import { Card } from "./card";
import type { Display } from "./display";
import { Figure } from "./figure";
import { chooseLabels, type Label } from "./labels";
import type { Lens } from "./lens";
import { kBarWidth } from "./marks";
import { readStyle, type Marks, type Style } from "./overlay";
import { Pace } from "./pace";
import { interpolated, nearestVertex, type Hit, type Surface } from "./picking";
import { Screen } from "./screen";
import { Touch } from "./touch";
import { valueText } from "./values";

export class View {
  private readonly screen = new Screen();
  private readonly touch: Touch;
  private readonly card: Card;
  private style!: Style;
  private readonly figure: Figure;
  private reportedUnnumbered = false;
  private highlights: Highlight[] = [];
  private readonly pace: Pace;
  private frame = 0; // id of the requested frame
  private fixedSize: [number, number] | null = null;
  private readonly listeners = new AbortController();

  constructor(
    readonly host: HTMLElement,
    readonly store: Store,
    readonly page: Page,
    readonly side: SideName,
    readonly display: Display,
  ) {
    this.card = new Card(store, side, () => this.redraw());
    this.pace = new Pace(store.source, () => this.redraw());
    this.host.classList.add("view");
    this.host.replaceChildren(this.screen.canvas, this.screen.overlay.canvas, this.screen.message, this.card.element);
    this.figure = new Figure(store, side, display, this.screen.stage);
    if (display.tool) this.screen.stage?.addTool(display.tool.makeShape());
    this.touch = new Touch(this);
    this.listen();
    this.applyDisplay();
    this.takeScene();
  }

  get rig(): CameraRig {
    return this.display.camera(this.side);
  }

  lens(): Lens {
    const [width, height] = this.size();
    return this.rig.lens(Math.max(1, width - this.strip()), height);
  }

  surface(): Surface | null {
    return this.figure.surface();
  }

  screenshot(): Promise<Blob> {
    this.drawNow();
    return this.screen.picture();
  }

  // In soft light: the mean of `samples` pictures.
  softScreenshot(samples: number): Promise<Blob> {
    this.drawNow();
    return this.screen.softPicture(this.lens(), this.style, samples);
  }

  // Fixes the size in pixels, independent of the page's layout, for pictures without a screen.
  renderSize(width: number, height: number): void {
    this.fixedSize = [width, height];
    this.applyDisplay();
    this.drawNow();
  }

  // Box around the present body.
  get box(): Box | null {
    return this.figure.body?.box ?? null;
  }

  // Shows the values at a clicked point.
  read(hit: Hit | null): void {
    if (hit && this.figure.body) this.card.open(hit, nearestVertex(hit, this.figure.body.geometry.triangles));
    else this.card.close();
  }

  showPins(vertices: number[]): void {
    this.figure.body?.setPins(vertices);
    this.redraw();
  }

  redraw(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.drawNow());
  }

  drawNow(): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    const [width, height] = this.size();
    const lens = this.lens();
    if (width > 0 && height > 0) this.screen.draw(lens, width, this.pixelRatio(), this.style, this.marks(lens));
    this.pace.drawn();
  }

  dispose(): void {
    this.listeners.abort();
    this.touch.dispose();
    this.card.close();
    cancelAnimationFrame(this.frame);
    this.screen.stage?.dispose();
    this.display.forget(this.side);
    this.host.replaceChildren();
    this.pace.drawn();
  }

  private listen(): void {
    const { store, display, page } = this;
    const { signal } = this.listeners;
    const { canvas } = this.screen;
    canvas.addEventListener("webglcontextlost", () => this.screen.showMessage("The graphics card is busy; the picture will return."), { signal });
    const restored = (): void => {
      if (signal.aborted) return;
      this.screen.showMessage("");
      this.applyDisplay();
    };
    canvas.addEventListener("webglcontextrestored", () => setTimeout(restored), { signal }); // after three.js, which listens, too
    const mine = (listener: () => void) => (side: SideName) => side === this.side && listener();
    store.on("scene", mine(() => this.takeScene()), signal);
    store.on("geometry", mine(() => this.takeGeometry()), signal);
    const takeObstacles = (): void => {
      this.figure.takeObstacles();
      this.applyDisplay();
    };
    store.on("obstacles", mine(takeObstacles), signal);
    store.on("picture", (side) => (side === this.side ? this.takePicture() : this.takeDifference()), signal);
    store.on("gone", () => this.applyDisplay(), signal);
    store.on("pins", mine(() => this.showPins(this.figure.side?.pins ?? [])), signal);
    const takeFibres = (): void => {
      this.figure.body?.setFibres(this.figure.side?.fibres ?? []);
      this.redraw();
    };
    store.on("fibres", mine(takeFibres), signal);
    store.on("state", () => this.takeState(), signal);
    display.on("changed", () => this.applyDisplay(), signal);
    display.on("camera", () => this.redraw(), signal);
    const recolor = (): void => {
      this.figure.color();
      this.redraw();
    };
    display.on("range", recolor, signal);
    onLook(() => this.applyDisplay(), signal);
    const highlight = (highlights: Highlight[]): void => {
      this.highlights = highlights;
      this.redraw();
    };
    if (this.side === "a") page.on("highlight", highlight, signal);
    const sizes = new ResizeObserver(() => this.redraw());
    sizes.observe(this.host);
    signal.addEventListener("abort", () => sizes.disconnect());
    document.addEventListener("visibilitychange", () => this.pace.go(), { signal });
  }

  private takeState(): void {
    this.figure.takeState();
    this.screen.stage?.showTool(this.store.state?.[this.side]?.tool ?? null, this.style.accent);
    this.redraw();
  }

  private takeScene(): void {
    if (this.figure.takeScene()) this.card.close();
    const scene = this.figure.side?.scene;
    // Side a sends the fields to the display, which then notifies all views.
    if (scene && this.side === "a") this.display.setFields(scene.fields, scene.field, scene.bodies.length);
    else this.applyDisplay();
  }

  private takeGeometry(): void {
    if (!this.figure.takeGeometry()) return;
    this.card.close();
    this.applyDisplay();
  }

  private takePicture(): void {
    this.figure.takePicture();
    this.card.refresh();
    this.pace.came();
  }

  private takeDifference(): void {
    this.figure.takeDifference();
    this.figure.color();
    this.redraw();
  }

  private applyDisplay(): void {
    this.style = readStyle(this.host, this.display.settings, this.fixedSize);
    this.figure.apply(this.style);
    this.reportUnnumbered();
    this.redraw();
  }

  // Reports once that the fine skin has no numbers for the requested labels.
  private reportUnnumbered(): void {
    const missing = this.display.settings.vertexLabels && this.figure.body?.numbered === false;
    if (missing && !this.reportedUnnumbered)
      this.page.notice("Points of the fine skin have no numbers; choose the cage of tets to see numbers.");
    this.reportedUnnumbered = missing;
  }

  private size(): [number, number] {
    return this.fixedSize ?? [this.host.clientWidth, this.host.clientHeight];
  }

  // Width of the strip beside the body for the color bar.
  private strip(): number {
    return this.figure.colored() && this.display.settings.textSize > 0 ? Math.round(kBarWidth * this.style.em) : 0;
  }

  private pixelRatio(): number {
    return this.fixedSize ? 1 : Math.min(3, window.devicePixelRatio || 1);
  }

  private marks(lens: Lens): Marks {
    const settings = this.display.settings;
    if (settings.textSize === 0) return {};
    const shown = this.figure.colored();
    const grab = this.store.state?.[this.side]?.grab;
    const { cursor, target } = this.touch;
    const brushes = settings.tool === "pin" && cursor;
    return {
      axes: settings.axes,
      scaleBar: settings.scaleBar,
      gridStep: settings.grid && this.figure.body && this.screen.stage?.obstacles.hasGround ? this.screen.stage.gridStep : 0,
      bar: shown && { ...shown, map: this.display.map(shown.field) },
      contact: this.figure.contact(),
      bodies: shown ? [] : this.figure.bodies(),
      labels: this.labels(lens),
      highlights: [...this.highlights, ...this.card.marks],
      spring: grab ? { ...grab, target: target ?? grab.target } : null,
      brush: brushes ? { at: cursor, radius: settings.brush, words: this.touch.pins ? "pin" : "unpin" } : null,
      tip: this.tip(),
    };
  }

  private labels(lens: Lens): Label[] {
    const { vertexLabels: vertices, faceLabels: tets } = this.display.settings;
    const surface = this.surface();
    if (!surface || !this.figure.body || !(vertices || tets)) return [];
    return chooseLabels(lens, surface, this.figure.body.geometry, { vertices, tets, em: this.style.em, cursor: this.touch.cursor });
  }

  // Value under the cursor in reading mode.
  private tip(): Marks["tip"] {
    if (this.screen.stage?.isFar || this.screen.stage?.hasLeft) return { at: [0, this.size()[1] / 2], words: this.whereItIs() };
    const { hover, cursor } = this.touch;
    if (cursor && this.touch.target && this.store.state && !this.store.state.playing)
      return { at: cursor, words: "Paused: press Space to play" };
    const [shown, values] = [this.figure.colored(), this.figure.values()];
    const triangles = this.figure.body?.geometry.triangles;
    if (!hover || !cursor || !shown || !values || !triangles || this.display.settings.tool !== "read") return null;
    return { at: cursor, words: valueText(interpolated(hover, triangles, values), shown.field.unit) };
  }

  // Describes where the body is if it is out of sight.
  private whereItIs(): string {
    if (!sideHasBlownUp(this.store, this.side)) return "The body has left the view. Press 0 to see it.";
    const what = "The motion has blown up: it has gained energy";
    const other = this.side === "a" ? "b" : "a";
    if (!this.display.settings.linked || !this.store.side(other) || sideHasBlownUp(this.store, other)) return `${what}. Press 0 to see it.`;
    const away = this.box ? Math.hypot(...[0, 1, 2].map((c) => (this.box!.lower[c]! + this.box!.upper[c]!) / 2 - this.rig.target.getComponent(c))) : NaN;
    return `${what}, and is ${valueText(away, "m", 2)} away. Press 0 to see side ${other.toUpperCase()}.`;
  }
}

// Pointer actions in a view: turn the camera, drag the body by a spring, pin it with a brush, read values.
import type { Page } from "../page";
import type { Vec3 } from "../protocol";
import type { CameraRig } from "./cameras";
import type { Display } from "./display";
import { isFinite3, onFacingPlane, rayThrough } from "./lens";
import { pick, verticesInStroke, type Hit } from "./picking";
import type { ToolGesture, TouchedView } from "./viewTool";

type Gesture =
  | { kind: "turn" | "pan"; moved: number; hit: Hit | null; reads: boolean }
  | { kind: "grab"; anchor: Vec3; target: Vec3 }
  | { kind: "brush"; pinned: boolean; known: Set<number>; path: [number, number][] } // path since the last frame
  | { kind: "pinch"; distance: number }
  | { kind: "tool"; tool: ToolGesture };

// The view under the pointer.
export interface Touchable extends TouchedView {
  readonly host: HTMLElement;
  readonly page: Page;
  readonly display: Display;
  readonly rig: CameraRig;
  redraw(): void;
  read(hit: Hit | null): void;
  showPins(vertices: number[]): void;
}

const kClick = 4; // shorter movements are clicks [px]

export class Touch {
  cursor: [number, number] | null = null; // position in the view [px]
  hover: Hit | null = null;
  private alt = false;
  private gesture: Gesture | null = null;
  private readonly pointers = new Map<number, [number, number]>();
  private waiting = false; // waiting for the next frame to send the movement
  private readonly listeners = new AbortController();

  constructor(private readonly view: Touchable) {
    const host = view.host;
    const signal = this.listeners.signal;
    host.addEventListener("pointerdown", (event) => this.down(event), { signal });
    host.addEventListener("pointermove", (event) => this.move(event), { signal });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const)
      host.addEventListener(end, (event) => this.up(event), { signal });
    const leave = (): void => {
      this.cursor = this.hover = null;
      view.redraw();
    };
    host.addEventListener("pointerleave", leave, { signal });
    host.addEventListener("wheel", (event) => this.wheel(event), { signal, passive: false });
    host.addEventListener("contextmenu", (event) => event.preventDefault(), { signal });
    window.addEventListener("blur", () => this.end(), { signal });
    window.addEventListener("keydown", (event) => event.key === "Escape" && this.end(), { signal });
    view.store.on("role", (steers) => !steers && this.end(), signal);
    view.store.on("connected", (connected) => !connected && this.end(), signal);
    view.store.on("geometry", (side) => side === view.side && this.end(), signal);
  }

  // Whether the brush pins; Alt inverts it.
  get pins(): boolean {
    return this.view.display.settings.unpin === this.alt;
  }

  // Target of the spring while the mouse holds it.
  get target(): Vec3 | null {
    return this.gesture?.kind === "grab" ? this.gesture.target : null;
  }

  dispose(): void {
    this.end();
    this.listeners.abort();
  }

  private down(event: PointerEvent): void {
    if (event.target instanceof Element && event.target.closest("[data-card]")) return;
    const at = this.position(event);
    this.cursor = at;
    this.alt = event.altKey;
    this.view.host.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, at);
    if (this.pointers.size > 1) {
      this.end();
      this.gesture = this.pointers.size === 2 ? { kind: "pinch", distance: this.spread() } : null;
      return;
    }
    const pans = event.button !== 0 || event.ctrlKey || event.metaKey;
    const hit = pans ? null : this.pick(at);
    const { tool } = this.view.display.settings;
    const reads = !pans && (event.shiftKey || tool === "read");
    const own = tool === "extension" && !pans && !reads && this.mayTouch() ? this.view.display.tool?.begin(this.view, at, hit) : null;
    if (own) this.gesture = { kind: "tool", tool: own };
    else if (hit && !reads && tool !== "extension" && this.mayTouch()) this.gesture = this.touch(hit);
    else this.gesture = { kind: pans ? "pan" : "turn", moved: 0, hit, reads };
    this.schedule();
  }

  private touch(hit: Hit): Gesture {
    const { store, side, display } = this.view;
    if (display.settings.tool === "pin")
      return { kind: "brush", pinned: this.pins, known: new Set(store.side(side)?.pins), path: [this.cursor!] };
    store.source.send({ do: "grab", side, triangle: hit.triangle, weights: hit.weights, target: hit.point });
    return { kind: "grab", anchor: hit.point, target: hit.point };
  }

  private move(event: PointerEvent): void {
    const at = this.position(event);
    this.cursor = at;
    this.alt = event.altKey;
    const before = this.pointers.get(event.pointerId);
    if (before) this.pointers.set(event.pointerId, at);
    if (before && this.gesture) this.drag(this.gesture, at[0] - before[0], at[1] - before[1]);
    this.schedule();
  }

  private drag(gesture: Gesture, dx: number, dy: number): void {
    const { rig, host } = this.view;
    if (gesture.kind === "turn" || gesture.kind === "pan") {
      const clicked = gesture.moved < kClick;
      gesture.moved += Math.abs(dx) + Math.abs(dy);
      if (clicked && gesture.moved >= kClick && gesture.hit && !gesture.reads) this.explainRefusal();
      if (gesture.kind === "pan" || rig.mode === "flat") rig.pan(dx, dy, host.clientHeight);
      else rig.turn(dx, dy);
    } else if (gesture.kind === "pinch") {
      const distance = this.spread();
      rig.pan(dx / 2, dy / 2, host.clientHeight);
      const [x, y] = this.middle();
      if (distance > 0) this.zoom(gesture.distance / distance, x, y);
      gesture.distance = distance;
    } else if (gesture.kind === "tool") {
      gesture.tool.move(dx, dy);
    } else if (gesture.kind === "grab") {
      const target = onFacingPlane(this.view.lens(), rayThrough(this.view.lens(), ...this.cursor!), gesture.anchor);
      if (target && isFinite3(target)) gesture.target = target;
    } else if (gesture.kind === "brush") gesture.path.push(this.cursor!);
  }

  private up(event: PointerEvent): void {
    if (!this.pointers.delete(event.pointerId)) return;
    const gesture = this.gesture;
    const reads = gesture?.kind === "turn" && gesture.reads && gesture.moved < kClick && event.type === "pointerup";
    this.flush();
    this.end();
    if (reads) this.view.read(gesture.hit);
  }

  private wheel(event: WheelEvent): void {
    if (event.target instanceof Element && event.target.closest("[data-card]")) return;
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1);
    const display = this.view.display;
    if (display.settings.tool === "pin" && !event.ctrlKey)
      display.change({ brush: display.settings.brush * Math.exp(-pixels * 0.001) });
    else this.zoom(Math.exp(Math.max(-1, Math.min(1, pixels * (event.ctrlKey ? 0.01 : 0.0012)))), ...this.position(event));
    this.schedule();
  }

  private zoom(factor: number, x: number, y: number): void {
    const { width, height } = this.view.lens();
    this.view.rig.zoom(factor, x - width / 2, height / 2 - y, height);
  }

  // Ends the gesture and releases the spring.
  private end(): void {
    if (this.gesture?.kind === "grab" && this.view.store.steers) this.view.store.source.send({ do: "release" });
    this.gesture = null;
    this.schedule();
  }

  // Notifies the program and updates the object under the cursor, at most once per frame.
  private schedule(): void {
    if (this.waiting || this.listeners.signal.aborted) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      if (this.listeners.signal.aborted) return;
      this.flush();
      if (!this.gesture) this.pointAt();
      this.view.redraw();
    });
  }

  private flush(): void {
    const { store, side } = this.view;
    if (this.gesture?.kind === "grab") store.source.send({ do: "move", target: this.gesture.target });
    if (this.gesture?.kind === "tool") this.gesture.tool.flush();
    const surface = this.view.surface();
    if (this.gesture?.kind !== "brush" || !surface) return;
    const { pinned, known, path } = this.gesture;
    const { brush } = this.view.display.settings;
    const covered = verticesInStroke(this.view.lens(), surface, path, brush); // independent of the frame rate
    path.splice(0, path.length - 1);
    const vertices = covered.filter((vertex) => known.has(vertex) !== pinned);
    if (vertices.length === 0) return;
    for (const vertex of vertices) pinned ? known.add(vertex) : known.delete(vertex);
    store.source.send({ do: "pin", side, vertices, pinned });
    this.view.showPins([...known]); // until the program answers
  }

  private pointAt(): void {
    this.hover = this.cursor ? this.pick(this.cursor) : null;
    const { tool } = this.view.display.settings;
    const touches = tool === "read" ? "help" : tool === "drag" ? "grab" : "crosshair";
    this.view.host.style.cursor = this.hover && (tool === "read" || this.mayTouch()) ? touches : "default";
  }

  private mayTouch(): boolean {
    const { store } = this.view;
    return store.source.live && store.steers && store.side(this.view.side) !== null;
  }

  private explainRefusal(): void {
    const { store, page } = this.view;
    if (this.mayTouch() || this.view.display.settings.tool === "read") return;
    if (!store.source.live) page.notice("This run is recorded; the body cannot be dragged.");
    else page.notice("This page only watches, so dragging turns the camera. Press Steer to drag the body.");
  }

  private pick(at: [number, number]): Hit | null {
    const surface = this.view.surface();
    return surface && pick(rayThrough(this.view.lens(), ...at), surface.positions, surface.triangles, surface.clip);
  }

  private position(event: MouseEvent): [number, number] {
    const box = this.view.host.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  private spread(): number {
    const [a, b] = [...this.pointers.values()];
    return a && b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
  }

  private middle(): [number, number] {
    const [a, b] = [...this.pointers.values()];
    return b ? [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2] : a;
  }
}

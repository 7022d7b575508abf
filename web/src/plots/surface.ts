// 3-D picture of a surface that the reader can turn: values over a plane, the quadratic model, a path and marks.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { onLook } from "../theme";
import { disposeOf } from "../view/dispose";
import { oncePerFrame } from "../controls";
import { element } from "../dom";
import { sample, type Point } from "./grid";
import { legendOf, titled } from "./legend";
import { cssOf, inkOf, palette, samePalette, type Palette } from "./palette";
import { SurfaceBody } from "./surfaceBody";
import type { Mark, SurfaceContent } from "./surfaceContent";
import { axisLabels, placed, type Placed } from "./surfaceLabels";
import "./plots.css";

const kAzimuth = -0.55; // default view
const kArrows: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

// Default polar angle: a flat picture is seen more from the side, so that the surface fills it.
function usualPolar(aspect: number): number {
  return Math.min(1.2, Math.max(1.02, 0.8 + 0.14 * aspect));
}

export class SurfaceView {
  readonly element = element("div", { class: "surface" });
  readonly legend = element("div");
  dragged: ((at: Point, done: boolean) => void) | null = null; // called while the mark "ring" is dragged
  nudged: ((dx: number, dy: number) => void) | null = null; // called for Shift and an arrow key, in hundredths of the axes
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(28, 1, 0.1, 50);
  private readonly lamp = new THREE.DirectionalLight(0xffffff, 2.2);
  private readonly overlay = element("div", { "aria-hidden": "true" });
  private renderer: THREE.WebGLRenderer | null = null;
  private controls: OrbitControls | null = null;
  private shown: SurfaceContent | null = null;
  private body: SurfaceBody | null = null;
  private readonly left: SurfaceBody[] = []; // kept until the next surface is drawn, so that its shaders are already compiled
  private colors: Palette | null = null;
  private stretch = 1; // factor of the width: flat panels show flat boxes
  private fitted = 0; // distance at which the camera shows all
  readonly redraw = oncePerFrame(() => this.draw());

  constructor() {
    this.scene.add(new THREE.AmbientLight(0xffffff, 1.5), this.camera);
    this.camera.add(this.lamp);
    this.lamp.position.set(-1.5, 2, 1);
    new ResizeObserver(() => this.fit()).observe(this.element);
    onLook(() => this.fit());
  }

  // Value above which the surface is cut off; null: not cut.
  get cutAbove(): number | null {
    return this.body?.frame.range.cut ? this.body.frame.range.high : null;
  }

  show(content: SurfaceContent | null): void {
    this.shown = content;
    this.legend.replaceChildren(...(content ? [legendOf(content.signs)] : []));
    this.build();
    this.fit(); // the box may have other proportions
  }

  private build(): void {
    this.clear();
    const content = this.shown;
    this.colors = palette(this.element);
    if (!content || content.grid.x.length < 2 || content.grid.y.length < 2) return this.redraw();
    this.renderer?.domElement.setAttribute("aria-label", `${content.label}. The arrow keys turn it, + and − zoom, 0 resets.`);
    this.stretch = this.wantedStretch();
    this.body = new SurfaceBody(content, this.colors, this.stretch);
    this.scene.add(this.body.group);
    this.redraw();
  }

  // The view with its labels, a title above and the legend below.
  picture(title: string): HTMLCanvasElement | null {
    if (!this.renderer || !this.colors || !this.shown) return null;
    this.draw();
    const source = this.renderer.domElement;
    const scale = source.width / Math.max(1, this.element.clientWidth);
    const canvas = titled(source, title, this.colors, scale, this.shown.signs);
    const pen = canvas.getContext("2d")!;
    for (const { label, x, y } of this.placedLabels()) {
      pen.fillStyle = inkOf(this.colors, label.color);
      pen.fillText(label.text, x * scale, (y + this.colors.fontSize * 2.25) * scale);
    }
    return canvas;
  }

  private start(): void {
    try {
      this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    } catch {
      this.element.textContent = "This browser cannot draw in 3-D: WebGL is disabled.";
      return;
    }
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.clippingPlanes = [[-1, 0.96], [1, 0.05]].map(([y, offset]) => new THREE.Plane(new THREE.Vector3(0, y, 0), offset));
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    this.element.append(canvas, this.overlay);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enablePan = false;
    this.controls.target.set(0, 0.38, 0);
    this.controls.addEventListener("change", this.redraw);
    canvas.addEventListener("keydown", (event) => this.key(event));
    canvas.addEventListener("pointerdown", (event) => this.grab(event), { capture: true });
    this.home();
    this.build();
  }

  private wantedStretch(): number {
    return Math.min(2.2, Math.max(1, this.element.clientWidth / Math.max(1, this.element.clientHeight) / 1.3));
  }

  private home(): void {
    const aspect = this.element.clientWidth / Math.max(1, this.element.clientHeight);
    this.camera.position.setFromSphericalCoords(5, usualPolar(aspect), kAzimuth).add(this.controls!.target);
    this.fitted = 0;
    this.fit();
  }

  private fit(): void {
    const [width, height] = [this.element.clientWidth, this.element.clientHeight];
    if (width < 20 || height < 20) return;
    if (!this.renderer) this.start();
    if (!this.renderer) return;
    this.renderer.setSize(width, height, false);
    const isStretched = Math.abs(this.wantedStretch() - this.stretch) > 0.1;
    if (isStretched || !samePalette(this.colors, palette(this.element))) this.build();
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    const distance = this.distanceThatShowsAll();
    const offset = this.camera.position.clone().sub(this.controls!.target);
    const factor = this.fitted > 0 ? distance / this.fitted : distance / offset.length();
    this.camera.position.copy(this.controls!.target).add(offset.multiplyScalar(factor));
    this.fitted = distance;
    this.controls!.update();
    this.redraw();
  }

  // Distance for the default direction, with room for the numbers at the axes.
  private distanceThatShowsAll(): number {
    const [w, d, h] = [1.15 * (this.body?.frame.width ?? 2) * 0.5, 1.15 * (this.body?.frame.depth ?? 2) * 0.5, 0.95];
    const corners = [-w, w].flatMap((x) => [-d, d].flatMap((z) => [-0.02, h].map((y) => new THREE.Vector3(x, y, z))));
    const margin = 1 - (1.2 * (this.colors?.fontSize ?? 14)) / Math.max(1, this.element.clientHeight);
    const view = new THREE.Spherical(1, usualPolar(this.camera.aspect), kAzimuth);
    const turn = new THREE.Matrix4().lookAt(new THREE.Vector3().setFromSpherical(view), new THREE.Vector3(), this.camera.up).invert();
    const rise = margin * Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2));
    const needed = corners.map((corner) => {
      const { x, y, z } = corner.sub(this.controls!.target).applyMatrix4(turn);
      return z + Math.max(Math.abs(y), Math.abs(x) / this.camera.aspect) / rise;
    });
    return Math.max(1.5, ...needed);
  }

  private clear(): void {
    if (!this.body) return;
    this.scene.remove(this.body.group);
    if (this.element.isConnected && this.renderer) this.left.push(this.body);
    else disposeOf(this.body.group);
    this.body = null;
  }

  private draw(): void {
    if (!this.element.isConnected || !this.renderer) return;
    this.renderer.render(this.scene, this.camera);
    for (const body of this.left.splice(0)) disposeOf(body.group);
    const made = this.placedLabels().map(({ label, x, y }) => {
      const span = element("span", { class: "surface-label" }, label.text);
      span.style.transform = `translate(${x.toFixed(1)}px, calc(${y.toFixed(1)}px - 50%))`;
      span.style.color = cssOf(label.color);
      return span;
    });
    this.overlay.replaceChildren(...made);
  }

  private placedLabels(): Placed[] {
    if (!this.body || !this.shown || !this.colors) return [];
    const axes = axisLabels(this.body.frame, this.shown.axes, this.camera);
    const size = { width: this.element.clientWidth, height: this.element.clientHeight };
    return placed(this.body.labels, axes, this.camera, size, this.colors.fontSize * 0.82);
  }

  private key(event: KeyboardEvent): void {
    const arrow = kArrows[event.key];
    if (arrow && event.shiftKey && this.nudged) this.nudged(...arrow);
    else if (arrow) this.turn(arrow[0] * 0.1, -arrow[1] * 0.07, 1);
    else if (event.key === "+" || event.key === "=") this.turn(0, 0, 0.9);
    else if (event.key === "-") this.turn(0, 0, 1 / 0.9);
    else if (event.key === "0") this.home();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private turn(azimuth: number, polar: number, zoom: number): void {
    this.controls!.rotateLeft(-azimuth);
    this.controls!.rotateUp(-polar);
    this.controls!.dollyIn(zoom);
  }

  private ring(): Mark | undefined {
    return this.shown?.marks.find((mark) => mark.shape === "ring");
  }

  // Drags the ring over the surface if the pointer is on it.
  private grab(event: PointerEvent): void {
    const ring = this.ring();
    if (!this.dragged || !ring || !this.body || event.button !== 0) return;
    const value = ring.value ?? sample(this.shown!.grid, ring.x, ring.y) ?? this.body.frame.range.high;
    const at = this.body.frame.place(ring.x, ring.y, Math.min(value, this.body.frame.range.high)).project(this.camera);
    const box = this.element.getBoundingClientRect();
    const [x, y] = [(at.x * 0.5 + 0.5) * box.width, (-at.y * 0.5 + 0.5) * box.height];
    if (Math.hypot(event.clientX - box.left - x, event.clientY - box.top - y) > 18) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    const canvas = this.renderer!.domElement;
    canvas.setPointerCapture(event.pointerId);
    const move = (moved: PointerEvent): void => this.dragTo(moved, false);
    const end = (ended: PointerEvent): void => {
      canvas.removeEventListener("pointermove", move);
      this.dragTo(ended, true);
    };
    canvas.addEventListener("pointermove", move);
    canvas.addEventListener("pointerup", end, { once: true });
  }

  private dragTo(event: PointerEvent, done: boolean): void {
    if (!this.body) return;
    const box = this.element.getBoundingClientRect();
    const [x, y] = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * x - 1, 1 - 2 * y), this.camera);
    const hit = ray.intersectObject(this.body.surface, false).find((h) => h.point.y <= 0.97);
    const ring = this.ring();
    if (hit) this.dragged?.(this.body.frame.at(hit.point), done);
    else if (done && ring) this.dragged?.(ring, true);
  }
}

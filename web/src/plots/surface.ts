// A surface to be looked at from all sides: values over a plane, the quadratic model beside them, a path and marks.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import type { MaybeNumber } from "../protocol";
import { element, oncePerFrame } from "./dom";
import { clipped, heightRange, isInside, sample, valueAtHeight, type Grid, type Point } from "./grid";
import { legendColumns, paintLegend, type Sign } from "./legend";
import { palette, sameLook, type Colour, type Palette } from "./palette";
import { Frame, gridLines, levelLines, markTexture, surfaceGeometry, type MarkShape } from "./surfaceParts";
import { axisLabels, placed, type Label, type Placed } from "./surfaceLabels";
import "./plots.css";

export interface Mark extends Point {
  value: MaybeNumber; // null: on the surface
  shape: MarkShape;
  colour: Colour;
  size: number; // [CSS px]
  label?: string;
}

export interface SurfaceContent {
  label: string; // for a reader that does not see it
  grid: Grid;
  axes: { x: string; y: string; value: string };
  model: MaybeNumber[] | null; // on the same grid
  path: (Point & { value: MaybeNumber })[];
  draped: boolean; // the path runs on the surface; else straight from point to point
  direction: { from: Point; to: Point } | null;
  marks: Mark[];
  keep: MaybeNumber[]; // values that are not cut off
  log: boolean;
}

const kHome = { azimuth: -0.55, polar: 1.02 };

export class SurfaceView {
  readonly element = element("div", { class: "surface" });
  dragged: ((at: Point, done: boolean) => void) | null = null; // the mark "ring" is dragged
  nudged: ((dx: number, dy: number) => void) | null = null; // Shift and an arrow, in hundredths of the axes
  private readonly scene = new THREE.Scene();
  private readonly content = new THREE.Group();
  private readonly camera = new THREE.PerspectiveCamera(28, 1, 0.1, 50);
  private readonly lamp = new THREE.DirectionalLight(0xffffff, 2.2);
  private readonly overlay = element("div", { "aria-hidden": "true" });
  private renderer: THREE.WebGLRenderer | null = null;
  private controls: OrbitControls | null = null;
  private shown: SurfaceContent | null = null;
  private frame: Frame | null = null;
  private surface: THREE.Mesh | null = null;
  private labels: Label[] = [];
  private colours: Palette | null = null;
  private visible = false;
  private stretch = 1; // of the width: flat panels show flat boxes
  private fitted = 0; // distance of the camera that shows all
  readonly redraw = oncePerFrame(() => this.draw());

  constructor() {
    this.scene.add(this.content, new THREE.AmbientLight(0xffffff, 1.5), this.camera);
    this.camera.add(this.lamp);
    this.lamp.position.set(-1.5, 2, 1);
    new ResizeObserver(() => this.fit()).observe(this.element);
  }

  // What is cut off at the top; null: nothing.
  get cutAbove(): number | null {
    return this.frame?.range.cut ? this.frame.range.high : null;
  }

  setVisible(visible: boolean): void {
    this.visible = visible;
    if (!visible) return;
    this.start();
    this.fit();
  }

  show(content: SurfaceContent | null): void {
    this.shown = content;
    this.build();
  }

  // Colours or the font may be others now.
  retheme(): void {
    if (!sameLook(this.colours, palette(this.element))) this.build();
  }

  private build(): void {
    this.clear();
    const content = this.shown;
    this.colours = palette(this.element);
    if (!content || content.grid.x.length < 2 || content.grid.y.length < 2) return this.redraw();
    if (this.renderer) this.renderer.domElement.setAttribute("aria-label", `${content.label}. The arrow keys turn it, + and − zoom, 0 resets.`);
    const range = heightRange(content.grid.value, content.keep);
    this.stretch = this.wantedStretch();
    this.frame = new Frame(content.grid, range, content.log ? "log" : "linear", this.stretch);
    this.addSurface(content, this.frame, this.colours);
    if (content.model) this.addModel(content.model, this.frame, this.colours);
    this.addBox(this.frame, this.colours);
    this.addPath(content, this.frame, this.colours);
    for (const mark of content.marks) this.addMark(mark, content, this.frame, this.colours);
    this.redraw();
  }

  // The view with its labels on it, a title above and what the signs mean below.
  picture(title: string, legend: readonly Sign[]): HTMLCanvasElement | null {
    if (!this.renderer || !this.colours) return null;
    this.draw();
    const source = this.renderer.domElement;
    const scale = source.width / Math.max(1, this.element.clientWidth);
    const line = this.colours.fontSize * 1.5 * scale;
    const canvas = document.createElement("canvas");
    canvas.width = source.width;
    const rows = Math.ceil(legend.length / legendColumns(canvas.width, line));
    canvas.height = source.height + line * (2 + rows);
    const pen = canvas.getContext("2d")!;
    pen.fillStyle = this.colours.panel;
    pen.fillRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(source, 0, line * 1.5);
    pen.textBaseline = "middle";
    pen.font = `${this.colours.fontSize * 0.82 * scale}px sans-serif`;
    for (const { label, x, y } of this.placedLabels()) {
      pen.fillStyle = this.colours[label.colour];
      pen.fillText(label.text, x * scale, y * scale + line * 1.5);
    }
    pen.fillStyle = this.colours.text;
    paintLegend(pen, legend, this.colours, source.height + line * 1.6, line);
    pen.fillStyle = this.colours.text;
    pen.font = `600 ${this.colours.fontSize * scale}px sans-serif`;
    pen.fillText(title, line * 0.5, line * 0.75);
    return canvas;
  }

  private start(): void {
    if (this.renderer) return;
    try {
      this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    } catch {
      this.element.textContent = "This browser draws no 3-D pictures (WebGL is off).";
      return;
    }
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.clippingPlanes = [new THREE.Plane(new THREE.Vector3(0, -1, 0), 0.96), new THREE.Plane(new THREE.Vector3(0, 1, 0), 0.05)];
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
    return Math.min(1.8, Math.max(1, this.element.clientWidth / Math.max(1, this.element.clientHeight) / 1.3));
  }

  private home(): void {
    this.camera.position.setFromSphericalCoords(5, kHome.polar, kHome.azimuth).add(this.controls!.target);
    this.fitted = 0;
    this.fit();
  }

  private fit(): void {
    const [width, height] = [this.element.clientWidth, this.element.clientHeight];
    if (!this.renderer || !this.visible || width < 20 || height < 20) return;
    this.renderer.setSize(width, height, false);
    if (Math.abs(this.wantedStretch() - this.stretch) > 0.1) this.build();
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

  // From the usual direction, with room for the numbers at the axes.
  private distanceThatShowsAll(): number {
    const probe = this.camera.clone();
    const [w, d, h] = [1.15 * (this.frame?.width ?? 2) * 0.5, 1.15 * (this.frame?.depth ?? 2) * 0.5, 0.95];
    const corners = [-w, w].flatMap((x) => [-d, d].flatMap((z) => [-0.02, h].map((y) => new THREE.Vector3(x, y, z))));
    const margin = 1 - (1.2 * (this.colours?.fontSize ?? 14)) / Math.max(1, this.element.clientHeight);
    let [near, far] = [1.5, 40];
    for (let i = 0; i < 24; ++i) {
      const distance = 0.5 * (near + far);
      probe.position.setFromSphericalCoords(distance, kHome.polar, kHome.azimuth).add(this.controls!.target);
      probe.lookAt(this.controls!.target);
      probe.updateMatrixWorld();
      const fits = corners.every((corner) => {
        const at = corner.clone().project(probe);
        return Math.abs(at.y) <= margin && Math.abs(at.x) <= margin;
      });
      if (fits) far = distance;
      else near = distance;
    }
    return far;
  }

  private clear(): void {
    this.content.traverse((part) => {
      if (!(part instanceof THREE.Mesh || part instanceof THREE.Line || part instanceof THREE.Points)) return;
      part.geometry.dispose();
      for (const material of [part.material].flat()) material.dispose();
    });
    this.content.clear();
    this.labels = [];
    this.frame = null;
    this.surface = null;
  }

  private addSurface(content: SurfaceContent, frame: Frame, colours: Palette): void {
    const material = new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    this.surface = new THREE.Mesh(surfaceGeometry(frame, content.grid.value, true), material);
    const lines = new THREE.LineBasicMaterial({ color: 0x000000, transparent: true, opacity: 0.16 });
    const grid = new THREE.LineSegments(gridLines(frame, content.grid.value, 20), lines);
    const toValue = valueAtHeight(frame.range, frame.scale);
    const levels = Array.from({ length: 11 }, (_, i) => toValue((i + 1) / 12));
    const level = (flat: boolean, colour: string, opacity: number): THREE.LineSegments =>
      new THREE.LineSegments(levelLines(frame, content.grid.value, levels, flat), new THREE.LineBasicMaterial({ color: colour, transparent: true, opacity }));
    this.content.add(this.surface, grid, level(false, "#ffffff", 0.45), level(true, colours.faint, 0.4));
  }

  private addModel(model: MaybeNumber[], frame: Frame, colours: Palette): void {
    const colour = new THREE.Color(colours.series2);
    const material = new THREE.MeshLambertMaterial({ color: colour, side: THREE.DoubleSide, transparent: true, opacity: 0.32, depthWrite: false, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1 });
    const mesh = new THREE.Mesh(surfaceGeometry(frame, model, false), material);
    const lines = new THREE.LineBasicMaterial({ color: colour, transparent: true, opacity: 0.65 });
    mesh.renderOrder = 1;
    this.content.add(mesh, new THREE.LineSegments(gridLines(frame, model, 14), lines));
  }

  private addBox(frame: Frame, colours: Palette): void {
    const [w, d] = [frame.width / 2, frame.depth / 2];
    const corners = [[-w, -d], [w, -d], [w, d], [-w, d], [-w, -d]] as const;
    const base = corners.map(([x, z]) => new THREE.Vector3(x, -0.02, z));
    const material = new THREE.LineBasicMaterial({ color: colours.faint });
    this.content.add(new THREE.Line(new THREE.BufferGeometry().setFromPoints(base), material));
    const posts = corners.slice(0, 4).flatMap(([x, z]) => [new THREE.Vector3(x, -0.02, z), new THREE.Vector3(x, frame.tall, z)]);
    this.content.add(new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(posts), new THREE.LineBasicMaterial({ color: colours.line })));
  }

  private lineThrough(points: THREE.Vector3[], colour: string, width: number, dashed = false): void {
    if (points.length < 2) return;
    const geometry = new LineGeometry();
    geometry.setPositions(points.flatMap((p) => p.toArray()));
    for (const hidden of [true, false]) {
      const material = new LineMaterial({ color: new THREE.Color(colour).getHex(), linewidth: width, transparent: true, opacity: hidden ? 0.35 : 1, depthTest: !hidden, dashed, dashSize: 0.05, gapSize: 0.03 });
      const line = new Line2(geometry, material);
      if (dashed) line.computeLineDistances();
      line.renderOrder = hidden ? 2 : 3;
      this.content.add(line);
    }
  }

  // Along the surface between two points of the plane.
  private drape(content: SurfaceContent, frame: Frame, p: Point, q: Point): THREE.Vector3[] {
    const ends = clipped(content.grid, p, q);
    if (!ends) return [];
    const points: THREE.Vector3[] = [];
    const [dx, dy] = [ends[1].x - ends[0].x, ends[1].y - ends[0].y];
    const pieces = Math.min(48, Math.ceil(Math.hypot(frame.across(dx) - frame.across(0), frame.away(dy) - frame.away(0)) / 0.03) + 1);
    for (let i = 0; i <= pieces; ++i) {
      const [x, y] = [ends[0].x + (i / pieces) * dx, ends[0].y + (i / pieces) * dy];
      const value = sample(content.grid, x, y);
      if (value !== null) points.push(frame.place(x, y, value, 0.008));
    }
    return points;
  }

  private addPath(content: SurfaceContent, frame: Frame, colours: Palette): void {
    if (content.direction) this.lineThrough(this.drape(content, frame, content.direction.from, content.direction.to), colours.accent, 2.5, true);
    const pieces: THREE.Vector3[][] = [];
    for (let i = 0; i + 1 < content.path.length; ++i) {
      const [p, q] = [content.path[i]!, content.path[i + 1]!];
      pieces.push(content.draped ? this.drape(content, frame, p, q) : this.straight(content, frame, p, q));
    }
    // Pieces that touch are one line.
    let line: THREE.Vector3[] = [];
    for (const piece of pieces) {
      const joins = line.length > 0 && piece.length > 0 && line[line.length - 1]!.distanceTo(piece[0]!) < 1e-6;
      if (!joins) {
        this.lineThrough(line, colours.text, 2.5);
        line = [];
      }
      line.push(...piece);
    }
    this.lineThrough(line, colours.text, 2.5);
    this.addDots(content, frame, colours);
  }

  private straight(content: SurfaceContent, frame: Frame, p: Point & { value: MaybeNumber }, q: Point & { value: MaybeNumber }): THREE.Vector3[] {
    if (p.value === null || q.value === null || !isInside(content.grid, p) || !isInside(content.grid, q)) return [];
    return [frame.place(p.x, p.y, p.value, 0.008), frame.place(q.x, q.y, q.value, 0.008)];
  }

  private addDots(content: SurfaceContent, frame: Frame, colours: Palette): void {
    const places: THREE.Vector3[] = [];
    content.path.forEach((point, i) => {
      if (point.value === null || !isInside(content.grid, point)) return;
      const place = frame.place(point.x, point.y, Math.min(point.value, frame.range.high), 0.008);
      places.push(place);
      this.labels.push({ text: String(i), place, colour: "text", important: false });
    });
    this.addPoints(places, "dot", colours.text, colours.panel, 7);
  }

  private addMark(mark: Mark, content: SurfaceContent, frame: Frame, colours: Palette): void {
    const value = mark.value ?? sample(content.grid, mark.x, mark.y) ?? frame.range.high;
    if (!isInside(content.grid, mark)) return;
    const above = value > frame.range.high;
    const place = frame.place(mark.x, mark.y, Math.max(Math.min(value, frame.range.high), frame.range.low), 0.008);
    this.addPoints([place], mark.shape, colours[mark.colour], colours.panel, mark.size);
    if (mark.label) this.labels.push({ text: (above ? "↑ " : "") + mark.label, place, colour: mark.colour, important: true });
  }

  private addPoints(places: THREE.Vector3[], shape: MarkShape, colour: string, halo: string, size: number): void {
    if (places.length === 0) return;
    const material = new THREE.PointsMaterial({ map: markTexture(shape, colour, halo), size: size * 1.5, sizeAttenuation: false, transparent: true, alphaTest: 0.2, depthTest: false });
    const points = new THREE.Points(new THREE.BufferGeometry().setFromPoints(places), material);
    points.renderOrder = 4;
    this.content.add(points);
  }

  private draw(): void {
    if (!this.visible || !this.renderer) return;
    this.renderer.render(this.scene, this.camera);
    const made = this.placedLabels().map(({ label, x, y }) => {
      const span = element("span", { class: "surface-label" }, label.text);
      span.style.transform = `translate(${x.toFixed(1)}px, calc(${y.toFixed(1)}px - 50%))`;
      span.style.color = `var(--${label.colour.replace(/(\d)/, "-$1")})`;
      return span;
    });
    this.overlay.replaceChildren(...made);
  }

  private placedLabels(): Placed[] {
    if (!this.frame || !this.shown || !this.colours) return [];
    const axes = axisLabels(this.frame, this.shown.axes, this.camera);
    const size = { width: this.element.clientWidth, height: this.element.clientHeight };
    return placed(this.labels, axes, this.camera, size, this.colours.fontSize * 0.82);
  }

  private key(event: KeyboardEvent): void {
    const arrows: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const arrow = arrows[event.key];
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
    const target = this.controls!.target;
    const at = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(target));
    at.theta += azimuth;
    at.phi = Math.min(Math.PI - 0.05, Math.max(0.05, at.phi + polar));
    at.radius *= zoom;
    this.camera.position.setFromSpherical(at).add(target);
    this.controls!.update();
    this.redraw();
  }

  // Takes the ring, if the pointer is on it, and moves it over the surface.
  private grab(event: PointerEvent): void {
    const ring = this.shown?.marks.find((mark) => mark.shape === "ring");
    if (!this.dragged || !ring || !this.frame || event.button !== 0) return;
    const value = ring.value ?? sample(this.shown!.grid, ring.x, ring.y) ?? this.frame.range.high;
    const at = this.frame.place(ring.x, ring.y, Math.min(value, this.frame.range.high)).project(this.camera);
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
    if (!this.surface || !this.frame) return;
    const box = this.element.getBoundingClientRect();
    const pointer = new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(pointer, this.camera);
    const hit = ray.intersectObject(this.surface, false).find((h) => h.point.y <= 0.97);
    if (hit) this.dragged?.(this.frame.at(hit.point), done);
    else if (done && this.shown) {
      const ring = this.shown.marks.find((mark) => mark.shape === "ring");
      if (ring) this.dragged?.(ring, true);
    }
  }
}

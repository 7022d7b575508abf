// Objects in the picture of a surface: the surface with its lines, the quadratic model, the path and the marks.
import * as THREE from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import type { MaybeNumber } from "../protocol";
import { clipped, heightRange, isInside, sample, valueAtHeight, type Point } from "./grid";
import { inkOf, type Palette } from "./palette";
import type { Mark, SurfaceContent } from "./surfaceContent";
import type { Label } from "./surfaceLabels";
import { blockedGeometry, Frame, gridLines, levelLines, markTexture, surfaceGeometry } from "./surfaceParts";

const kNumbered = 40; // iterates with numbers, besides the last one

export class SurfaceBody {
  readonly group = new THREE.Group();
  readonly frame: Frame;
  readonly surface: THREE.Mesh;
  readonly labels: Label[] = [];

  constructor(
    private readonly content: SurfaceContent,
    private readonly colors: Palette,
    stretch: number, // factor of the width
  ) {
    const range = heightRange(content.grid.value, content.keep);
    this.frame = new Frame(content.grid, range, content.log ? "log" : "linear", stretch);
    this.surface = this.addSurface();
    if (content.model) this.addModel(content.model);
    if (content.blocked?.length) this.addBlocked(content.blocked);
    this.addBox();
    this.addPath();
    for (const mark of content.marks) this.addMark(mark);
  }

  private addSurface(): THREE.Mesh {
    const material = new THREE.MeshLambertMaterial({
      vertexColors: true,
      side: THREE.DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    const surface = new THREE.Mesh(surfaceGeometry(this.frame, this.content.grid.value, true), material);
    const lines = new THREE.LineBasicMaterial({ color: 0x000000, transparent: true, opacity: 0.16 });
    const grid = new THREE.LineSegments(gridLines(this.frame, this.content.grid.value, 20), lines);
    const toValue = valueAtHeight(this.frame.range, this.frame.scale);
    const levels = Array.from({ length: 11 }, (_, i) => toValue((i + 1) / 12));
    this.group.add(surface, grid);
    for (const [flat, color, opacity] of [[false, "#ffffff", 0.45], [true, this.colors.faint, 0.4]] as const) {
      const contours = levelLines(this.frame, this.content.grid.value, levels, flat);
      this.group.add(new THREE.LineSegments(contours, new THREE.LineBasicMaterial({ color, transparent: true, opacity })));
    }
    return surface;
  }

  private addModel(model: MaybeNumber[]): void {
    const color = new THREE.Color(this.colors.series2);
    const material = new THREE.MeshLambertMaterial({
      color: color,
      side: THREE.DoubleSide,
      transparent: true,
      opacity: 0.32,
      depthWrite: false,
      polygonOffset: true,
      polygonOffsetFactor: -1,
      polygonOffsetUnits: -1,
    });
    const mesh = new THREE.Mesh(surfaceGeometry(this.frame, model, false), material);
    const lines = new THREE.LineBasicMaterial({ color: color, transparent: true, opacity: 0.65 });
    mesh.renderOrder = 1;
    this.group.add(mesh, new THREE.LineSegments(gridLines(this.frame, model, 14), lines));
  }

  private addBlocked(samples: readonly number[]): void {
    const material = new THREE.MeshBasicMaterial({ color: this.colors.bad, side: THREE.DoubleSide, transparent: true, opacity: 0.3 });
    this.group.add(new THREE.Mesh(blockedGeometry(this.frame, samples), material));
  }

  private addBox(): void {
    const base = this.frame.corners.map((corner) => corner.setY(-0.02));
    const lines = (points: THREE.Vector3[], color: string) =>
      [new THREE.BufferGeometry().setFromPoints(points), new THREE.LineBasicMaterial({ color })] as const;
    const posts = base.flatMap((corner) => [corner, corner.clone().setY(this.frame.tall)]);
    this.group.add(
      new THREE.LineLoop(...lines(base, this.colors.faint)),
      new THREE.LineSegments(...lines(posts, this.colors.line)),
    );
  }

  private lineThrough(points: THREE.Vector3[], color: string, dashed = false): void {
    if (points.length < 2) return;
    const geometry = new LineGeometry();
    geometry.setPositions(points.flatMap((p) => p.toArray()));
    for (const hidden of [true, false]) {
      const material = new LineMaterial({
        color: new THREE.Color(color).getHex(),
        linewidth: 2.5, // [CSS px]
        transparent: true,
        opacity: hidden ? 0.35 : 1,
        depthTest: !hidden,
        dashed,
        dashSize: 0.05,
        gapSize: 0.03,
      });
      const line = new Line2(geometry, material);
      if (dashed) line.computeLineDistances();
      line.renderOrder = hidden ? 2 : 3;
      this.group.add(line);
    }
  }

  // Curve on the surface between two points of the plane.
  private drape(p: Point, q: Point): THREE.Vector3[] {
    const ends = clipped(this.content.grid, p, q);
    if (!ends) return [];
    const [from, to] = ends;
    const [across, away] = [this.frame.across(to.x) - this.frame.across(from.x), this.frame.away(to.y) - this.frame.away(from.y)];
    const pieces = Math.min(48, Math.ceil(Math.hypot(across, away) / 0.03) + 1);
    const points: THREE.Vector3[] = [];
    for (let i = 0; i <= pieces; ++i) {
      const [x, y] = [from.x + (i / pieces) * (to.x - from.x), from.y + (i / pieces) * (to.y - from.y)];
      const value = sample(this.content.grid, x, y);
      if (value !== null) points.push(this.frame.place(x, y, value, 0.008));
    }
    return points;
  }

  private addPath(): void {
    const { direction, path, draped } = this.content;
    if (direction) this.lineThrough(this.drape(direction.from, direction.to), this.colors.accent, true);
    // Segments that touch form one line.
    let line: THREE.Vector3[] = [];
    for (const [i, q] of path.slice(1).entries()) {
      const piece = draped ? this.drape(path[i], q) : this.straight(path[i], q);
      const joins = line.length > 0 && piece.length > 0 && line[line.length - 1].distanceTo(piece[0]) < 1e-6;
      if (!joins) {
        this.lineThrough(line, this.colors.text);
        line = [];
      }
      line.push(...piece);
    }
    this.lineThrough(line, this.colors.text);
    this.addDots();
  }

  private straight(p: Point & { value: MaybeNumber }, q: Point & { value: MaybeNumber }): THREE.Vector3[] {
    if (p.value === null || q.value === null || !isInside(this.content.grid, p) || !isInside(this.content.grid, q))
      return [];
    return [this.frame.place(p.x, p.y, p.value, 0.008), this.frame.place(q.x, q.y, q.value, 0.008)];
  }

  private addDots(): void {
    const places: THREE.Vector3[] = [];
    this.content.path.forEach((point, i) => {
      if (point.value === null || !isInside(this.content.grid, point)) return;
      const place = this.frame.place(point.x, point.y, Math.min(point.value, this.frame.range.high), 0.008);
      places.push(place);
      if (i < kNumbered || i === this.content.path.length - 1)
        this.labels.push({ text: String(i), place, color: "text", important: false });
    });
    this.addPoints(places, "dot", this.colors.text, this.colors.panel, places.length > 60 ? 4 : 7);
  }

  private addMark(mark: Mark): void {
    const value = mark.value ?? sample(this.content.grid, mark.x, mark.y) ?? this.frame.range.high;
    if (!isInside(this.content.grid, mark)) return;
    const { low, high } = this.frame.range;
    const place = this.frame.place(mark.x, mark.y, Math.max(low, Math.min(high, value)), 0.008);
    this.addPoints([place], mark.shape, inkOf(this.colors, mark.color), this.colors.panel, mark.size);
    if (mark.label)
      this.labels.push({ text: (value > high ? "↑ " : "") + mark.label, place, color: mark.color, important: true });
  }

  private addPoints(places: THREE.Vector3[], shape: Mark["shape"], color: string, halo: string, size: number): void {
    if (places.length === 0) return;
    const material = new THREE.PointsMaterial({
      map: markTexture(shape, color, halo),
      size: size * 1.5,
      sizeAttenuation: false,
      transparent: true,
      alphaTest: 0.2,
      depthTest: false,
    });
    const points = new THREE.Points(new THREE.BufferGeometry().setFromPoints(places), material);
    points.renderOrder = 4;
    this.group.add(points);
  }
}

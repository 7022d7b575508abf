// Geometry of the picture of a surface: triangles, grid lines and contour lines in the box of `Frame`.
import * as THREE from "three";
import type { MaybeNumber, Vec3 } from "../protocol";
import { colorAt } from "../view/colorMaps";
import { heightOf, type Grid, type Range, type Scale } from "./grid";
import type { Mark } from "./surfaceContent";

// x to the right, y away from the reader, values up. The longer side of the plane has length 2 before stretching.
export class Frame {
  readonly width: number;
  readonly depth: number;
  readonly tall = 0.95;
  readonly height: (value: number) => number; // in [0, 1]; also the color

  constructor(
    readonly grid: Grid,
    readonly range: Range,
    readonly scale: Scale,
    stretch: number, // factor of the width
  ) {
    const [dx, dy] = [span(grid.x), span(grid.y)];
    const ratio = Math.min(1.6, Math.max(1 / 1.6, dx / dy)); // a narrow strip would be invisible
    this.width = (ratio >= 1 ? 2 : 2 * ratio) * stretch;
    this.depth = ratio >= 1 ? 2 / ratio : 2;
    this.height = heightOf(range, scale);
  }

  // Corners of the plane.
  get corners(): THREE.Vector3[] {
    const [w, d] = [this.width / 2, this.depth / 2];
    return [[-w, -d], [w, -d], [w, d], [-w, d]].map(([x, z]) => new THREE.Vector3(x, 0, z));
  }

  place(x: number, y: number, value: number, lift = 0): THREE.Vector3 {
    const h = Math.min(1.5, Math.max(-0.5, this.height(value)));
    return new THREE.Vector3(this.across(x), h * this.tall + lift, this.away(y));
  }

  across(x: number): number {
    return ((x - this.grid.x[0]!) / span(this.grid.x) - 0.5) * this.width;
  }

  away(y: number): number {
    return -((y - this.grid.y[0]!) / span(this.grid.y) - 0.5) * this.depth;
  }

  // Inverse: from a place in the picture to the plane.
  at(place: THREE.Vector3): { x: number; y: number } {
    return {
      x: this.grid.x[0]! + (place.x / this.width + 0.5) * span(this.grid.x),
      y: this.grid.y[0]! + (-place.z / this.depth + 0.5) * span(this.grid.y),
    };
  }
}

function span(axis: readonly number[]): number {
  return axis[axis.length - 1]! - axis[0]! || 1;
}

// Samples at the corners of each cell, counter-clockwise.
function cells({ x, y }: Grid): [number, number, number, number][] {
  const rows = Array.from({ length: y.length - 1 }, (_, j) => j * x.length);
  return rows.flatMap((row) =>
    Array.from({ length: x.length - 1 }, (_, i): [number, number, number, number] => {
      const a = row + i;
      return [a, a + 1, a + x.length + 1, a + x.length];
    }),
  );
}

function isHole(value: MaybeNumber | undefined): value is null | undefined {
  return value === null || value === undefined;
}

// Surface of the grid. Cells with a corner that is not finite are holes.
export function surfaceGeometry(frame: Frame, values: readonly MaybeNumber[], colored: boolean): THREE.BufferGeometry {
  const { x, y } = frame.grid;
  const positions = new Float32Array(3 * x.length * y.length);
  const colors = new Float32Array(colored ? positions.length : 0);
  const color = new THREE.Color();
  values.forEach((value, k) => {
    const place = frame.place(x[k % x.length]!, y[Math.floor(k / x.length)]!, value ?? frame.range.low);
    place.toArray(positions, 3 * k);
    if (colored) {
      const [r, g, b] = colorAt("viridis", frame.height(value ?? frame.range.low));
      color.setRGB(r / 255, g / 255, b / 255, THREE.SRGBColorSpace).toArray(colors, 3 * k);
    }
  });
  const index = cells(frame.grid).flatMap(([a, b, c, d]) => ([a, b, c, d].some((k) => isHole(values[k])) ? [] : [a, b, c, a, c, d]));
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  if (colored) geometry.setAttribute("color", new THREE.BufferAttribute(colors, 3));
  geometry.setIndex(index);
  geometry.computeVertexNormals();
  return geometry;
}

// Cells with one of these samples at a corner, in the plane below the surface.
export function blockedGeometry(frame: Frame, samples: readonly number[]): THREE.BufferGeometry {
  const blocked = new Set(samples);
  const { x, y } = frame.grid;
  const below = (k: number): THREE.Vector3 => new THREE.Vector3(frame.across(x[k % x.length]), -0.02, frame.away(y[Math.floor(k / x.length)]));
  const shown = cells(frame.grid).filter((corners) => corners.some((k) => blocked.has(k)));
  return new THREE.BufferGeometry().setFromPoints(shown.flatMap(([a, b, c, d]) => [a, b, c, a, c, d].map(below)));
}

// Grid lines, about `lines` in each direction.
export function gridLines(frame: Frame, values: readonly MaybeNumber[], lines: number): THREE.BufferGeometry {
  const { x, y } = frame.grid;
  const points: number[] = [];
  const add = (k: number, l: number): void => {
    if (isHole(values[k]) || isHole(values[l])) return;
    for (const n of [k, l]) points.push(...frame.place(x[n % x.length], y[Math.floor(n / x.length)], values[n]!, 0.002).toArray());
  };
  const [everyX, everyY] = [x, y].map(({ length }) => Math.max(1, Math.round((length - 1) / lines)));
  for (let j = 0; j < y.length; ++j)
    for (let i = 0; i < x.length; ++i) {
      const k = j * x.length + i;
      if (i + 1 < x.length && (j % everyY === 0 || j === y.length - 1)) add(k, k + 1);
      if (j + 1 < y.length && (i % everyX === 0 || i === x.length - 1)) add(k, k + x.length);
    }
  return lineGeometry(points);
}

// Contour lines on the surface and in the plane below it: each triangle of a cell is cut at every level.
export function levelLines(frame: Frame, values: readonly MaybeNumber[], levels: readonly number[], flat: boolean): THREE.BufferGeometry {
  const { x, y } = frame.grid;
  const points: number[] = [];
  const corner = (k: number): Vec3 => [x[k % x.length], y[Math.floor(k / x.length)], values[k] as number];
  for (const [a, b, c, d] of cells(frame.grid))
    for (const triangle of [[a, b, c], [a, c, d]]) {
      if (triangle.some((k) => isHole(values[k]))) continue;
      for (const level of levels) cut(triangle.map(corner), level, frame, flat, points);
    }
  return lineGeometry(points);
}

function cut(corners: Vec3[], level: number, frame: Frame, flat: boolean, points: number[]): void {
  const ends: THREE.Vector3[] = [];
  for (let k = 0; k < 3; ++k) {
    const [p, q] = [corners[k]!, corners[(k + 1) % 3]!];
    if (p[2] < level === q[2] < level) continue;
    const f = (level - p[2]) / (q[2] - p[2]);
    const [x, y] = [p[0] + f * (q[0] - p[0]), p[1] + f * (q[1] - p[1])];
    ends.push(flat ? new THREE.Vector3(frame.across(x), -0.02, frame.away(y)) : frame.place(x, y, level, 0.003));
  }
  if (ends.length === 2) for (const end of ends) points.push(end.x, end.y, end.z);
}

function lineGeometry(points: number[]): THREE.BufferGeometry {
  return new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
}

const kOutlines: Record<Mark["shape"], string> = {
  dot: "M48 32a16 16 0 1 1-32 0a16 16 0 1 1 32 0Z",
  ring: "M50 32a18 18 0 1 1-36 0a18 18 0 1 1 36 0Z",
  diamond: "M32 12L52 32L32 52L12 32Z",
  cross: "M16 16L48 48M16 48L48 16",
};
const textures = new Map<string, THREE.Texture>();

// Small picture of a mark with a light rim, visible on any surface.
export function markTexture(shape: Mark["shape"], color: string, halo: string): THREE.Texture {
  const key = `${shape} ${color} ${halo}`;
  const known = textures.get(key);
  if (known) return known;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const pen = canvas.getContext("2d")!;
  const outline = new Path2D(kOutlines[shape]);
  for (const [style, width] of [[halo, 22], [color, 10]] as const) {
    pen.strokeStyle = pen.fillStyle = style;
    pen.lineWidth = width;
    pen.stroke(outline);
  }
  if (shape === "dot" || shape === "diamond") pen.fill(outline);
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  textures.set(key, texture);
  return texture;
}

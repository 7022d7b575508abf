// Projection of points to the screen, and the ray behind a pixel. In meters and CSS pixels, in double precision,
// independent of the renderer.
import type { Vec3 } from "../protocol";

export interface Lens {
  eye: Vec3;
  right: Vec3; // right and the next two are orthonormal
  up: Vec3;
  forward: Vec3;
  slope: number; // half the visible height per distance; 0 when orthographic
  extent: number; // half the visible height when orthographic
  width: number; // width of the screen [px]
  height: number;
}

export interface Ray {
  origin: Vec3;
  direction: Vec3; // a unit vector
  from: number; // points before it are behind the camera; -inf for an orthographic camera
}

export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const minus = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const along = (a: Vec3, t: number, d: Vec3): Vec3 => [a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]];
export const length = (a: Vec3): number => Math.hypot(a[0], a[1], a[2]);
export const isFinite3 = (a: Vec3): boolean => a.every(Number.isFinite);

// Entry i of a list with three coordinates per entry.
export function vectorAt(list: ArrayLike<number>, i: number): Vec3 {
  return [list[3 * i], list[3 * i + 1], list[3 * i + 2]];
}

export function cross(a: Vec3, b: Vec3): Vec3 {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

export function unit(a: Vec3): Vec3 {
  const size = length(a);
  return size > 0 ? [a[0] / size, a[1] / size, a[2] / size] : [0, 0, 0];
}

export function pixelsPerMeter(lens: Lens, depth: number): number {
  const half = lens.extent > 0 ? lens.extent : lens.slope * depth;
  return lens.height / 2 / half;
}

// Pixel and depth of a point; a point at depth <= 0 is behind a perspective camera.
export function project(lens: Lens, p: Vec3): Vec3 {
  const d = minus(p, lens.eye);
  const depth = dot(d, lens.forward);
  const scale = pixelsPerMeter(lens, depth);
  return [lens.width / 2 + scale * dot(d, lens.right), lens.height / 2 - scale * dot(d, lens.up), depth];
}

export function isBehind(lens: Lens, depth: number): boolean {
  return lens.extent === 0 && !(depth > 0);
}

export function rayThrough(lens: Lens, x: number, y: number): Ray {
  const half = lens.extent > 0 ? lens.extent : lens.slope;
  const scale = (2 * half) / lens.height;
  const [u, v] = [scale * (x - lens.width / 2), scale * (lens.height / 2 - y)];
  if (lens.extent > 0)
    return { origin: along(along(lens.eye, u, lens.right), v, lens.up), direction: lens.forward, from: -Infinity };
  return { origin: lens.eye, direction: unit(along(along(lens.forward, u, lens.right), v, lens.up)), from: 0 };
}

// Intersection of the ray with the camera-facing plane through a point; null if there is none.
export function onFacingPlane(lens: Lens, ray: Ray, point: Vec3): Vec3 | null {
  const slant = dot(ray.direction, lens.forward);
  if (!(Math.abs(slant) > 1e-9)) return null;
  return along(ray.origin, dot(minus(point, ray.origin), lens.forward) / slant, ray.direction);
}

export function isInside(lens: Lens, point: Vec3): boolean {
  const [x, y, depth] = project(lens, point);
  return !isBehind(lens, depth) && x >= 0 && x <= lens.width && y >= 0 && y <= lens.height;
}

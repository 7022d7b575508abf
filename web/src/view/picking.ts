// Objects under a pixel, computed on demand from the present positions. There is no search tree because positions
// change constantly.
import type { Vec3 } from "../protocol";
import { isBehind, pixelsPerMeter, type Lens, type Ray } from "./lens";

// Visible half space: normal . x >= offset.
export interface Clip {
  normal: Vec3;
  offset: number;
}

export interface Hit {
  triangle: number;
  weights: Vec3; // weights of the triangle's corners
  point: Vec3;
  distance: number;
}

export const isClipped = (clip: Clip | null, x: number, y: number, z: number): boolean =>
  clip !== null && clip.normal[0] * x + clip.normal[1] * y + clip.normal[2] * z < clip.offset;

// First triangle that the ray hits from either side [Möller and Trumbore 1997].
export function pick(ray: Ray, positions: Float32Array, triangles: Uint32Array, clip: Clip | null): Hit | null {
  const [ox, oy, oz] = ray.origin;
  const [dx, dy, dz] = ray.direction;
  let best = Infinity;
  let [found, u0, v0] = [-1, 0, 0];
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ax = positions[a], ay = positions[a + 1], az = positions[a + 2];
    const ux = positions[b] - ax, uy = positions[b + 1] - ay, uz = positions[b + 2] - az;
    const vx = positions[c] - ax, vy = positions[c + 1] - ay, vz = positions[c + 2] - az;
    const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx;
    const det = ux * px + uy * py + uz * pz;
    if (det === 0) continue;
    const sx = ox - ax, sy = oy - ay, sz = oz - az;
    const u = (sx * px + sy * py + sz * pz) / det;
    if (!(u >= 0 && u <= 1)) continue;
    const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
    const v = (dx * qx + dy * qy + dz * qz) / det;
    if (!(v >= 0 && u + v <= 1)) continue;
    const at = (vx * qx + vy * qy + vz * qz) / det;
    if (!(at > ray.from && at < best)) continue;
    if (isClipped(clip, ox + at * dx, oy + at * dy, oz + at * dz)) continue;
    [best, found, u0, v0] = [at, t / 3, u, v];
  }
  if (found < 0) return null;
  const point: Vec3 = [ox + best * dx, oy + best * dy, oz + best * dz];
  return { triangle: found, weights: [1 - u0 - v0, u0, v0], point, distance: best };
}

// Corner of the triangle nearest to the hit.
export function nearestVertex(hit: Hit, triangles: Uint32Array): number {
  return triangles[3 * hit.triangle + hit.weights.indexOf(Math.max(...hit.weights))];
}

// Value at the hit, interpolated from the corners.
export function interpolated(hit: Hit, triangles: Uint32Array, values: Float32Array): number {
  return hit.weights.reduce((sum, weight, k) => sum + weight * values[triangles[3 * hit.triangle + k]], 0);
}

// Coarse depth map of a rectangle of the screen, to find hidden vertices.
export class DepthGrid {
  private readonly depth: Float32Array;

  constructor(
    private readonly left: number,
    private readonly top: number,
    private readonly cell: number, // cell size [px]
    private readonly columns: number,
    private readonly rows: number,
  ) {
    this.depth = new Float32Array(columns * rows).fill(Infinity);
  }

  // Adds triangles. `screen`: pixel and depth of every vertex.
  add(screen: Float32Array, triangles: Uint32Array): void {
    const right = this.left + this.cell * this.columns;
    const bottom = this.top + this.cell * this.rows;
    for (let t = 0; t < triangles.length; t += 3) {
      const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
      const ax = screen[a], bx = screen[b], cx = screen[c];
      if ((ax < this.left && bx < this.left && cx < this.left) || (ax > right && bx > right && cx > right)) continue;
      const ay = screen[a + 1], by = screen[b + 1], cy = screen[c + 1];
      if ((ay < this.top && by < this.top && cy < this.top) || (ay > bottom && by > bottom && cy > bottom)) continue;
      const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
      if (area === 0 || !Number.isFinite(area)) continue;
      this.fill(screen, a, b, c, area);
    }
  }

  // Whether a point at a pixel and depth is visible: at most `slack` behind the nearest surface.
  isVisible(x: number, y: number, depth: number, slack: number): boolean {
    const i = Math.floor((x - this.left) / this.cell);
    const j = Math.floor((y - this.top) / this.cell);
    if (!(i >= 0 && i < this.columns && j >= 0 && j < this.rows)) return false;
    return depth <= this.depth[j * this.columns + i] + slack;
  }

  // Stores the depth at the middle of each cell that the triangle covers.
  private fill(screen: Float32Array, a: number, b: number, c: number, area: number): void {
    const ax = screen[a], ay = screen[a + 1], bx = screen[b], by = screen[b + 1], cx = screen[c], cy = screen[c + 1];
    const first = (low: number, origin: number): number => Math.max(0, Math.ceil((low - origin) / this.cell - 0.5));
    const last = (high: number, origin: number, count: number): number =>
      Math.min(count - 1, Math.floor((high - origin) / this.cell - 0.5));
    const [i0, i1] = [first(Math.min(ax, bx, cx), this.left), last(Math.max(ax, bx, cx), this.left, this.columns)];
    const [j0, j1] = [first(Math.min(ay, by, cy), this.top), last(Math.max(ay, by, cy), this.top, this.rows)];
    for (let j = j0; j <= j1; ++j)
      for (let i = i0; i <= i1; ++i) {
        const x = this.left + (i + 0.5) * this.cell - ax;
        const y = this.top + (j + 0.5) * this.cell - ay;
        const u = (x * (cy - ay) - y * (cx - ax)) / area;
        const v = (y * (bx - ax) - x * (by - ay)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const depth = screen[a + 2] + u * (screen[b + 2] - screen[a + 2]) + v * (screen[c + 2] - screen[a + 2]);
        const k = j * this.columns + i;
        if (depth < this.depth[k]) this.depth[k] = depth;
      }
  }
}

// Pixel and depth of every vertex; NaN for vertices behind the camera or clipped away. Equals project() in lens.ts
// without its allocations.
export function screenPositions(lens: Lens, positions: Float32Array, clip: Clip | null): Float32Array {
  const screen = new Float32Array(positions.length);
  const { eye, right, up, forward } = lens;
  for (let i = 0; i < positions.length; i += 3) {
    const x = positions[i], y = positions[i + 1], z = positions[i + 2];
    const dx = x - eye[0], dy = y - eye[1], dz = z - eye[2];
    const depth = dx * forward[0] + dy * forward[1] + dz * forward[2];
    const hidden = isBehind(lens, depth) || isClipped(clip, x, y, z);
    const scale = hidden ? NaN : pixelsPerMeter(lens, depth);
    screen[i] = lens.width / 2 + scale * (dx * right[0] + dy * right[1] + dz * right[2]);
    screen[i + 1] = lens.height / 2 - scale * (dx * up[0] + dy * up[1] + dz * up[2]);
    screen[i + 2] = depth;
  }
  return screen;
}

export interface Surface {
  positions: Float32Array;
  triangles: Uint32Array;
  clip: Clip | null;
}

export const kSteepest = 8; // steepest slope at which a surface does not hide its own vertices

// Distance from a polyline on the screen.
function distanceToWay(way: readonly [number, number][], x: number, y: number): number {
  let least = Math.hypot(x - way[0][0], y - way[0][1]);
  for (let i = 1; i < way.length; ++i) {
    const [[ax, ay], [bx, by]] = [way[i - 1], way[i]];
    const [ux, uy] = [bx - ax, by - ay];
    const t = Math.min(1, Math.max(0, ((x - ax) * ux + (y - ay) * uy) / Math.max(ux * ux + uy * uy, 1e-12)));
    least = Math.min(least, Math.hypot(x - ax - t * ux, y - ay - t * uy));
  }
  return least;
}

// Visible vertices that a disc covers on its way across the screen.
export function verticesInStroke(lens: Lens, surface: Surface, way: readonly [number, number][], radius: number): number[] {
  const screen = screenPositions(lens, surface.positions, surface.clip);
  const [lower, upper] = [Math.min, Math.max].map((end) => [0, 1].map((c) => end(...way.map((place) => place[c]))));
  const longest = Math.max(upper[0] - lower[0], upper[1] - lower[1]) + 2 * radius;
  const cell = Math.max((2 * radius) / 64, longest / 1024);
  // The cells of the screen are aligned, so that visibility does not depend on the start of the stroke.
  const [left, top] = lower.map((least) => Math.floor((least - radius) / cell));
  const [right, bottom] = upper.map((most) => Math.ceil((most + radius) / cell));
  const grid = new DepthGrid(left * cell, top * cell, cell, right - left, bottom - top);
  grid.add(screen, surface.triangles);
  const found: number[] = [];
  for (let i = 0; i < screen.length; i += 3) {
    if (!(distanceToWay(way, screen[i], screen[i + 1]) <= radius)) continue;
    const slack = (kSteepest * cell) / pixelsPerMeter(lens, screen[i + 2]);
    if (grid.isVisible(screen[i], screen[i + 1], screen[i + 2], slack)) found.push(i / 3);
  }
  return found;
}

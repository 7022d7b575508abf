// How the mouse presses a tip in: the direction on the screen that leads into the body, and the depth per pixel.
import type { Vec3 } from "../../../web/src/protocol";
import { along, cross, minus, pixelsPerMeter, project, unit, vectorAt, type Lens } from "../../../web/src/view/lens";

export interface Way {
  direction: [number, number]; // on the screen
  meters: number; // depth per pixel
}

const kSlant = 0.3; // sine of the angle between the tip's axis and the line of sight below which dragging down presses in

export function inwardNormal(positions: ArrayLike<number>, triangles: ArrayLike<number>, triangle: number): Vec3 {
  const [a, b, c] = [0, 1, 2].map((k) => vectorAt(positions, triangles[3 * triangle + k]));
  return unit(cross(minus(c, a), minus(b, a)));
}

export function wayIn(lens: Lens, point: Vec3, axis: Vec3): Way {
  const [x, y, depth] = project(lens, point);
  const pixels = pixelsPerMeter(lens, depth);
  const step = 1 / pixels; // one pixel without foreshortening
  const [u, v] = project(lens, along(point, step, axis));
  const seen = Math.hypot(u - x, v - y);
  if (!(seen > kSlant)) return { direction: [0, 1], meters: step };
  return { direction: [(u - x) / seen, (v - y) / seen], meters: step / seen };
}

export function depthOf(way: Way, [dx, dy]: [number, number]): number {
  return way.meters * (dx * way.direction[0] + dy * way.direction[1]);
}

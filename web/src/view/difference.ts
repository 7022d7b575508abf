// The distance between the sides of a comparison as a field, where both show the same surface.
import type { Field, Scene } from "../protocol";
import type { Side } from "../store";
import { extremes } from "./ranges";

export const kDifference: Field = { name: "difference", label: "distance between A and B", unit: "m", diverging: false, center: 0, log: false };

type Compared = Pick<Side, "geometry" | "picture"> | null;

// Distance of each vertex from its twin [m]. null: the sides cannot be compared. undefined: they show different times, so
// that the previous values remain.
export function differenceOf(a: Compared, b: Compared): Float32Array | null | undefined {
  const [p, q] = [a?.picture, b?.picture];
  const areAlike = a?.geometry?.triangles.length === b?.geometry?.triangles.length && p?.positions.length === q?.positions.length;
  if (!p || !q || !areAlike) return null;
  if (Math.abs(p.time - q.time) > 1e-9 * Math.max(p.time, q.time)) return undefined;
  const distances = new Float32Array(p.positions.length / 3);
  for (let v = 0; v < distances.length; ++v) {
    const [x, y, z] = [0, 1, 2].map((c) => p.positions[3 * v + c]! - q.positions[3 * v + c]!);
    distances[v] = Math.hypot(x!, y!, z!);
  }
  return distances;
}

const kFarthest = 10; // sizes of the scene

// Upper end of the colors: a side that has blown up does not turn the other one black.
export function largestShown(distances: Float32Array, { lower, upper }: Pick<Scene, "lower" | "upper">): number {
  const size = Math.hypot(...upper.map((high, c) => high - lower[c]!));
  return Math.min(extremes(distances)?.[1] ?? 0, kFarthest * size);
}

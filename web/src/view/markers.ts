// Positions of the markers on the present surface.
import type { Capture, Vec3 } from "../protocol";
import { along, length, minus, vectorAt } from "./lens";
import type { Dot } from "./overlay";
import type { Surface } from "./picking";
import { inwardNormal } from "./pressing";

export function markersOn(surface: Pick<Surface, "positions" | "triangles">, { triangles, weights }: Capture["markers"]): Dot[] {
  const { positions, triangles: corners } = surface;
  return triangles.flatMap((triangle, i) => {
    if (3 * triangle + 2 >= corners.length) return []; // the markers belong to another surface, which is about to arrive
    let at: Vec3 = [0, 0, 0];
    for (let c = 0; c < 3; ++c) at = along(at, weights[3 * i + c], vectorAt(positions, corners[3 * triangle + c]));
    return [{ at, normal: minus([0, 0, 0], inwardNormal(positions, corners, triangle)) }];
  });
}

// A dot at the given place, with the normal of the nearest marker.
export function nearestOn(dots: Dot[], at: Vec3): Dot {
  let best: Dot | null = null;
  for (const dot of dots) if (!best || length(minus(dot.at, at)) < length(minus(best.at, at))) best = dot;
  return { at, normal: best?.normal ?? [0, 0, 0] };
}

// Body of each vertex of a surface, and the colors of bodies.
import type { Geometry } from "../protocol";

// Colors after the reader's color of the first body; distinguishable with any kind of color vision, and not the color
// of the inside.
const kFurther = ["#56a35a", "#c9699f", "#d8c23f", "#7a68c4", "#3fb0b5", "#b5543f", "#8a929e"];
const kTissue = ["#a9503f", "#dcae8c", "#8e3f47", "#cf9a9c"]; // hues of organs

export function bodyOfTet(tet: number, bodyTets: readonly number[]): number {
  let body = -1;
  bodyTets.forEach((first, other) => {
    if (first <= tet && (body < 0 || first >= bodyTets[body])) body = other;
  });
  return Math.max(0, body);
}

// Body index of each vertex. Bodies share no surface vertex, and the tets of a body are consecutive.
export function bodiesOf(geometry: Pick<Geometry, "rest" | "triangles" | "tet">, bodyTets: readonly number[]): Float32Array {
  const bodies = new Float32Array(geometry.rest.length / 3);
  geometry.tet.forEach((tet, t) => {
    const body = bodyOfTet(tet, bodyTets);
    for (let c = 0; c < 3; ++c) bodies[geometry.triangles[3 * t + c]] = body;
  });
  return bodies;
}

export function bodyColors(own: string, count: number, isTissue = false): string[] {
  const further = isTissue ? kTissue : kFurther;
  return Array.from({ length: count }, (_, i) => (i === 0 ? own : further[(i - 1) % further.length]));
}

// Texels of a map with one color per body, RGBA.
export function bodyTexels(colors: readonly string[]): Uint8Array {
  const texels = new Uint8Array(4 * colors.length);
  colors.forEach((color, i) => {
    const channels = [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
    texels.set([...channels, 255], 4 * i);
  });
  return texels;
}

// Sheets as solids of their thickness: two surfaces, joined by walls along open borders.
import type { Geometry, Picture, Scene } from "../protocol";
import { bodiesOf } from "./bodies";

type Surface = Pick<Picture, "positions" | "normals">;
type Elements = Pick<Scene, "body_tets" | "tets" | "triangles" | "thickness">;

// Half the thickness at each vertex [m], 0 outside sheets; null without sheets of known thickness.
export function halfThickness(geometry: Geometry, { body_tets, tets, triangles = Infinity, thickness }: Elements): Float32Array | null {
  if (!thickness?.some((t) => t > 0)) return null;
  const body = bodiesOf(geometry, body_tets);
  const half = new Float32Array(body.length);
  geometry.tet.forEach((element, t) => {
    if (element < tets || element >= tets + triangles) return;
    for (const v of geometry.triangles.subarray(3 * t, 3 * t + 3)) half[v] = thickness[body[v]] / 2;
  });
  return half;
}

// Edges of triangles that no other triangle has, in the direction of their triangle.
export function borderOf(triangles: ArrayLike<number>, n: number): [number, number][] {
  const once = new Map<number, [number, number] | null>();
  for (let i = 0; i < triangles.length; ++i) {
    const [a, b] = [triangles[i], triangles[i % 3 === 2 ? i - 2 : i + 1]];
    const key = Math.min(a, b) * n + Math.max(a, b);
    once.set(key, once.has(key) ? null : [a, b]);
  }
  return [...once.values()].filter((edge) => edge !== null);
}

export class ThickSheets {
  readonly triangles: Uint32Array; // of points: first the vertices of the geometry, then the other sides, then four per wall
  readonly thickness: number; // the largest [m]
  readonly positions: Float32Array;
  readonly normals: Int8Array; // times 127, four per point
  private readonly source: Uint32Array; // vertex of each point
  private readonly offset: Float32Array; // of each point from its vertex along the normal [m]
  private readonly opposite: Uint32Array; // point on the other side of each vertex; the vertex itself outside sheets
  private readonly firstWall: number;

  // `half`: of halfThickness().
  constructor(triangles: Uint32Array, half: Float32Array) {
    const source = Array.from(half.keys());
    this.opposite = Uint32Array.from(source);
    const onSheet = source.filter((v) => half[v] > 0);
    onSheet.forEach((v, i) => (this.opposite[v] = half.length + i));
    const sheet = triangles.filter((_, i) => half[triangles[i - (i % 3)]] > 0);
    const border = borderOf(sheet, half.length);
    this.firstWall = half.length + onSheet.length;
    this.source = Uint32Array.from([...source, ...onSheet, ...border.flatMap(([a, b]) => [a, a, b, b])]);
    const below = onSheet.map((v) => -half[v]);
    this.offset = Float32Array.from([...half, ...below, ...border.flatMap(([a, b]) => [half[a], -half[a], -half[b], half[b]])]);
    const otherSide = sheet.map((_, i) => this.opposite[sheet[i - (i % 3) + [0, 2, 1][i % 3]]]);
    const walls = border.flatMap((_, i) => [0, 1, 2, 0, 2, 3].map((corner) => this.firstWall + 4 * i + corner));
    this.triangles = Uint32Array.from([...triangles, ...otherSide, ...walls]);
    this.thickness = 2 * half.reduce((most, h) => Math.max(most, h), 0);
    this.positions = new Float32Array(3 * this.source.length);
    this.normals = new Int8Array(4 * this.source.length);
  }

  // Edges of the geometry, those of sheets on both sides.
  bothSides(edges: Uint32Array): Uint32Array {
    const others = edges.map((v) => this.opposite[v]).filter((_, i) => this.opposite[edges[i]] !== edges[i]);
    return Uint32Array.from([...edges, ...others]);
  }

  // Moves the points. Positions that are not finite stay so; a normal of length 0 moves none.
  show({ positions, normals }: Surface): void {
    for (let i = 0; i < this.source.length; ++i) {
      const [p, n] = [3 * this.source[i], 4 * this.source[i]];
      const sign = this.offset[i] < 0 ? -1 : 1;
      const along = this.offset[i] / (Math.hypot(normals[n], normals[n + 1], normals[n + 2]) || 1);
      for (let c = 0; c < 3; ++c) {
        this.positions[3 * i + c] = positions[p + c] + along * normals[n + c];
        this.normals[4 * i + c] = sign * normals[n + c];
      }
    }
    for (let i = this.firstWall; i < this.source.length; i += 4) this.turnWall(i, positions);
  }

  // One value per point from one per vertex.
  values(values: Float32Array): Float32Array {
    return Float32Array.from(this.source, (v) => values[v]);
  }

  // Gives a wall its normal, which points away from the sheet.
  private turnWall(first: number, positions: Float32Array): void {
    const [a, b] = [3 * this.source[first], 3 * this.source[first + 2]];
    const [x, y, z] = [0, 1, 2].map((c) => positions[b + c] - positions[a + c]);
    const [nx, ny, nz] = this.normals.subarray(4 * first, 4 * first + 3);
    const normal = [y * nz - z * ny, z * nx - x * nz, x * ny - y * nx];
    const scale = 127 / (Math.hypot(...normal) || 1);
    for (let i = first; i < first + 4; ++i) this.normals.set(normal.map((d) => d * scale), 4 * i);
  }
}

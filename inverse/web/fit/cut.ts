// The body as a map shows it: the surface on one side of a plane, and the cut through its tets. No two triangles share
// corners, so each has the value of its tet.
import type { Vec3 } from "../../../web/src/protocol";
import { along, cross, dot, minus, unit, vectorAt } from "../../../web/src/view/lens";

export interface TetMesh {
  points: Float32Array; // 3 coordinates per vertex [m]
  tets: Uint32Array; // 4 vertices per tet
}

// Half space that is kept: normal . x <= offset.
export interface Plane {
  normal: Vec3;
  offset: number;
}

export interface Boundary {
  triangles: Uint32Array; // 3 vertices per triangle, counter-clockwise from outside
  tet: Uint32Array; // tet of each triangle
  normals: Float32Array; // 3 per vertex of the mesh: boundary normal, averaged by area
}

export interface Soup {
  positions: Float32Array; // 9 coordinates per triangle
  normals: Int8Array; // 12 numbers per triangle, as in Picture
  tet: Uint32Array; // tet of each triangle
  corner: Int32Array; // mesh vertex of each corner; -1 where an edge was cut
  edges: Uint32Array; // 2 corners per line
}

const kFaces = [
  [1, 2, 3],
  [0, 3, 2],
  [0, 1, 3],
  [0, 2, 1],
];

// Faces that belong to exactly one tet.
export function boundaryOf({ points, tets }: TetMesh): Boundary {
  const count = points.length / 3;
  const open = new Map<number, number>(); // corner triple -> face
  for (let t = 0; t < tets.length / 4; ++t)
    kFaces.forEach((face, f) => {
      const [a, b, c] = face.map((k) => tets[4 * t + k]).sort((p, q) => p - q);
      const key = (a * count + b) * count + c; // exact below 2^53: up to 200 000 vertices
      if (!open.delete(key)) open.set(key, 4 * t + f);
    });
  const faces = [...open.values()];
  const triangles = new Uint32Array(3 * faces.length);
  const tet = new Uint32Array(faces.length);
  const normals = new Float32Array(points.length);
  faces.forEach((id, i) => {
    const t = Math.floor(id / 4);
    const corners = kFaces[id % 4].map((k) => tets[4 * t + k]);
    triangles.set(corners, 3 * i);
    tet[i] = t;
    const n = areaVector(points, corners[0], corners[1], corners[2]);
    for (const v of corners) for (let k = 0; k < 3; ++k) normals[3 * v + k] += n[k];
  });
  return { triangles, tet, normals };
}

function areaVector(x: Float32Array, a: number, b: number, c: number): Vec3 {
  const at = vectorAt(x, a);
  return cross(minus(vectorAt(x, b), at), minus(vectorAt(x, c), at));
}

class SoupMaker {
  private readonly x: number[] = [];
  private readonly n: number[] = [];
  private readonly tet: number[] = [];
  private readonly corner: number[] = [];
  private readonly edges: number[] = [];

  // Adds a polygon of one tet as a fan of triangles. `isEdge` marks its visible sides.
  add(polygon: Corner[], tet: number): void {
    if (polygon.length < 3) return;
    const first = this.corner.length;
    const index: number[] = [];
    for (let i = 1; i + 1 < polygon.length; ++i) {
      const here = this.corner.length;
      for (const c of [polygon[0], polygon[i], polygon[i + 1]]) {
        this.x.push(...c.x);
        this.n.push(...c.n.map((x) => Math.round(127 * x)), 0);
        this.corner.push(c.vertex);
      }
      this.tet.push(tet);
      if (i === 1) index.push(first, here + 1);
      index.push(here + 2);
    }
    for (let i = 0; i < index.length; ++i) this.edges.push(index[i], index[(i + 1) % index.length]);
  }

  soup(): Soup {
    return {
      positions: Float32Array.from(this.x),
      normals: Int8Array.from(this.n),
      tet: Uint32Array.from(this.tet),
      corner: Int32Array.from(this.corner),
      edges: Uint32Array.from(this.edges),
    };
  }
}

interface Corner {
  x: Vec3;
  n: Vec3;
  vertex: number;
}

const mixed = (a: Vec3, b: Vec3, t: number): Vec3 => along(a, t, minus(b, a));

// Faces around a vertex that differ by more than this form an edge and are not shaded smoothly.
const kCrease = Math.cos((30 * Math.PI) / 180);
const isCrease = (n: Vec3, face: Vec3): boolean => dot(n, face) < kCrease;

// Part of a polygon on the kept side [Sutherland and Hodgman 1974].
function clipped(polygon: Corner[], height: (x: Vec3) => number): Corner[] {
  const kept: Corner[] = [];
  polygon.forEach((a, i) => {
    const b = polygon[(i + 1) % polygon.length];
    const [ha, hb] = [height(a.x), height(b.x)];
    if (ha <= 0) kept.push(a);
    if (ha < 0 !== hb < 0 && ha !== 0 && hb !== 0) {
      const t = ha / (ha - hb);
      kept.push({ x: mixed(a.x, b.x, t), n: unit(mixed(a.n, b.n, t)), vertex: -1 });
    }
  });
  return kept;
}

// Intersection of a plane with a tet, from the heights of the tet's corners above the plane. The polygon is
// counter-clockwise as seen from above the plane, and empty where the tet only touches it.
export function section(corners: readonly Vec3[], heights: readonly number[], normal: Vec3): Vec3[] {
  const [b, a] = [[0, 1, 2, 3].filter((k) => heights[k] <= 0), [0, 1, 2, 3].filter((k) => heights[k] > 0)]; // below, above
  if (b.length === 0 || a.length === 0) return [];
  const at = (p: number, q: number): Vec3 => mixed(corners[p], corners[q], heights[p] / (heights[p] - heights[q]));
  let polygon: Vec3[];
  if (b.length === 1) polygon = a.map((k) => at(b[0], k));
  else if (a.length === 1) polygon = b.map((k) => at(k, a[0]));
  else polygon = [at(b[0], a[0]), at(b[0], a[1]), at(b[1], a[1]), at(b[1], a[0])];
  const [p, q, r] = polygon;
  return dot(cross(minus(q, p), minus(r, p)), normal) < 0 ? polygon.reverse() : polygon;
}

// Part of the body below a plane, closed by the cut; null: the whole body.
export function bodyBelow(mesh: TetMesh, boundary: Boundary, plane: Plane | null): Soup {
  const { points, tets } = mesh;
  const height = (x: Vec3): number => (plane ? dot(x, plane.normal) - plane.offset : -1);
  const maker = new SoupMaker();
  for (let f = 0; f < boundary.tet.length; ++f) {
    const [a, b, c] = boundary.triangles.subarray(3 * f, 3 * f + 3);
    const face = unit(areaVector(points, a, b, c));
    const corners = [a, b, c].map((vertex) => {
      const n = unit(vectorAt(boundary.normals, vertex));
      return { x: vectorAt(points, vertex), n: isCrease(n, face) ? face : n, vertex };
    });
    maker.add(plane ? clipped(corners, height) : corners, boundary.tet[f]);
  }
  if (!plane) return maker.soup();
  for (let t = 0; t < tets.length / 4; ++t) {
    const corners = [0, 1, 2, 3].map((k) => vectorAt(points, tets[4 * t + k]));
    const polygon = section(corners, corners.map(height), plane.normal);
    maker.add(
      polygon.map((x) => ({ x, n: plane.normal, vertex: -1 })),
      t,
    );
  }
  return maker.soup();
}

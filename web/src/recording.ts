// Reads a recorded run, as apps/viewer/recording.h writes it. The page's element "recording" contains base64 of gzip of
// a pack of arrays.
import { Pack } from "./pack";
import { nearest } from "./plots/table";
import type { Geometry, Hello, Obstacle, Scene, StepRow, Vec3 } from "./protocol";
import { extremes } from "./view/ranges";

export interface RecordingHead {
  format: 1;
  hello: Hello;
  scenes: Scene[]; // one scene per surface; the first is shown initially
  obstacles?: Obstacle[]; // missing in recordings of earlier versions
  fibres?: number[][]; // lines of each surface, as in the message "fibres"
  toml: string; // the complete scene
  steps: StepRow[];
  // contacts: numbers of contact points; obstacles: of each frame, if any move
  // arrows: their numbers in a figure of arrays (bindings/python/aspic/figures.py), which has no simulation
  frames: { step: number[]; time: number[]; contacts: number[]; obstacles?: Obstacle[][]; arrows?: number[] };
  lower: Vec3; // bounding box of all positions of all frames
  size: Vec3;
}

// Surface over the recorded points: each vertex is one of them, or a weighted mean of four. Values belong to recorded
// points, which vertices share.
export interface RecordedSurface {
  scene: Scene;
  geometry: Geometry;
  corners: Uint32Array;
  weights: Float32Array | null; // null: one corner per vertex
  place: Uint32Array;
}

// Code of a value that is not a number. Other codes are 0 to 254 within the range of their frame, in which zero has a
// code of its own.
const kNoNumber = 255;
const kLargestCode = 254;

export class Recording extends Pack<RecordingHead> {
  readonly surfaces: RecordedSurface[];
  readonly pointCount: number;
  readonly largestPressure: number; // of the contact points in all frames [Pa]
  private readonly rest: Float32Array;
  private readonly codes: Uint16Array; // 3 codes per point and frame

  constructor(bytes: ArrayBuffer) {
    super(bytes);
    if (this.head.format !== 1) throw new Error(`the recording has format ${String(this.head.format)}; this page reads format 1`);
    this.pointCount = this.floats("point.rest").length / 3;
    this.largestPressure = extremes(this.floats("contact.at").filter((_, i) => i % 4 === 3))?.[1] ?? 0;
    this.rest = this.roundedRest();
    this.codes = unpredicted(this.array("positions") as Uint8Array, 3 * this.pointCount);
    for (const [name, stored] of this.arrays) if (name.startsWith("field.") && stored instanceof Uint8Array) this.add(stored);
    this.surfaces = this.head.scenes.map((scene) => this.surface(scene));
  }

  // Whether this is a figure of arrays.
  get isFigure(): boolean {
    return this.head.frames.arrows !== undefined;
  }

  get frameCount(): number {
    return this.head.frames.step.length;
  }

  nearestFrame(step: number): number {
    return nearest(this.head.frames.step, step);
  }

  // Positions, 3 coordinates per point [m].
  positions(frame: number): Float32Array {
    const n = 3 * this.pointCount;
    return this.decoded((i) => this.codes[frame * n + i]);
  }

  private decoded(code: (i: number) => number): Float32Array {
    const { lower, size } = this.head;
    const x = new Float32Array(3 * this.pointCount);
    for (let axis = 0; axis < 3; ++axis) {
      const scale = size[axis] / 65535;
      for (let i = axis; i < x.length; i += 3) x[i] = lower[axis] + scale * code(i);
    }
    return x;
  }

  // Rest positions rounded like the positions, so that points at rest have no displacement.
  private roundedRest(): Float32Array {
    const { lower, size } = this.head;
    const rest = this.floats("point.rest");
    return this.decoded((i) => (size[i % 3] > 0 ? Math.round(65535 * ((rest[i] - lower[i % 3]) / size[i % 3])) : 0));
  }

  // Contact points as in Picture, with the recorded point that each one belongs to; 0xffffffff: none.
  contacts(frame: number): { at: Float32Array; point: Uint32Array } {
    const [first, end] = rangeOf(this.head.frames.contacts, frame);
    return { at: this.floats("contact.at").slice(4 * first, 4 * end), point: this.indices("contact.point").subarray(first, end) };
  }

  // Arrows as in Picture.
  arrows(frame: number): Float32Array | undefined {
    if (!this.head.frames.arrows) return undefined;
    const [first, end] = rangeOf(this.head.frames.arrows, frame);
    return this.floats("arrows").subarray(6 * first, 6 * end);
  }

  // Values of a field at the vertices of a surface; NaN where there is none.
  values(field: string, frame: number, surface: RecordedSurface, positions: Float32Array): Float32Array {
    if (field === "displacement") return distances(positions, carried(surface, this.rest));
    if (field === "contact_pressure") return this.pressure(frame, surface);
    const stored = this.array(`field.${field}`);
    if (stored instanceof Float32Array) return Float32Array.from(surface.place, (place) => stored[place]);
    const [min, max] = this.floats(`field.${field}.range`).subarray(2 * frame, 2 * frame + 2);
    const step = (max - min) / kLargestCode;
    const zero = Math.round(-min / step);
    const value = (code: number): number => (zero >= 0 && zero <= kLargestCode ? (code - zero) * step : min + code * step);
    const first = (stored.length / this.frameCount) * frame;
    return Float32Array.from(surface.place, (place) => {
      const code = stored[first + place];
      return code === kNoNumber ? NaN : value(code);
    });
  }

  private pressure(frame: number, surface: RecordedSurface): Float32Array {
    const { at, point } = this.contacts(frame);
    const ofPoints = new Float32Array(3 * this.pointCount); // along the first axis
    point.forEach((touching, i) => touching < this.pointCount && (ofPoints[3 * touching] = at[4 * i + 3]));
    return carried(surface, ofPoints).filter((_, i) => i % 3 === 0);
  }

  // Adds a frame, stored as its difference to the previous one modulo 256.
  private add(values: Uint8Array): void {
    const n = values.length / this.frameCount;
    for (let i = n; i < values.length; ++i) values[i] += values[i - n];
  }

  private surface(scene: Scene): RecordedSurface {
    const part = scene.surface;
    const triangles = this.indices(`${part}.triangles`);
    const weights = this.arrays.has(`${part}.weights`) ? this.floats(`${part}.weights`) : null;
    return {
      scene,
      geometry: {
        side: "a",
        generation: scene.generation,
        rest: this.floats(`${part}.rest`),
        triangles,
        edges: edgesOf(triangles),
        tet: this.indices(`${part}.tet`),
        vertex: this.indices(`${part}.vertex`),
      },
      corners: this.indices(`${part}.corners`),
      weights,
      place: this.arrays.has(`${part}.place`) ? this.indices(`${part}.place`) : new Uint32Array(0),
    };
  }
}

// First and last + 1 of the items of a frame.
function rangeOf(counts: number[], frame: number): [number, number] {
  const first = counts.slice(0, frame).reduce((sum, count) => sum + count, 0);
  return [first, first + counts[frame]];
}

// Codes of the positions. Each frame is stored as the difference to the linear extrapolation of the two previous
// frames: the low bytes of all, then the high bytes. Small differences of either sign are small numbers.
function unpredicted(bytes: Uint8Array, n: number): Uint16Array {
  const codes = new Uint16Array(bytes.length / 2);
  for (let frame = 0; frame * n < codes.length; ++frame) {
    const here = frame * n;
    for (let i = 0; i < n; ++i) {
      const folded = bytes[2 * here + i] | (bytes[2 * here + n + i] << 8);
      const difference = (folded >> 1) ^ -(folded & 1);
      const before = frame > 0 ? codes[here - n + i] : 0;
      const earlier = frame > 1 ? codes[here - 2 * n + i] : before;
      codes[here + i] = 2 * before - earlier + difference; // modulo 65536
    }
  }
  return codes;
}

function distances(a: Float32Array, b: Float32Array): Float32Array {
  const result = new Float32Array(a.length / 3);
  for (let i = 0; i < result.length; ++i)
    result[i] = Math.hypot(a[3 * i] - b[3 * i], a[3 * i + 1] - b[3 * i + 1], a[3 * i + 2] - b[3 * i + 2]);
  return result;
}

// Edges of the triangles, each once.
export function edgesOf(triangles: Uint32Array): Uint32Array {
  const seen = new Set<number>();
  const edges: number[] = [];
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; ++k) {
      const [a, b] = [triangles[t + k], triangles[t + ((k + 1) % 3)]];
      const key = Math.min(a, b) * 0x4000000 + Math.max(a, b);
      if (seen.has(key)) continue;
      seen.add(key);
      edges.push(a, b);
    }
  }
  return Uint32Array.from(edges);
}

// Positions of the surface's vertices. This and the functions below run for every picture and allocate no array per
// vertex.
export function carried(surface: RecordedSurface, points: Float32Array): Float32Array {
  const { corners, weights, geometry } = surface;
  const positions = new Float32Array(geometry.rest.length);
  const perVertex = (3 * corners.length) / geometry.rest.length;
  for (let c = 0; c < corners.length; ++c) {
    const to = 3 * Math.floor(c / perVertex);
    const from = 3 * corners[c];
    const weight = weights ? weights[c] : 1;
    positions[to] += weight * points[from];
    positions[to + 1] += weight * points[from + 1];
    positions[to + 2] += weight * points[from + 2];
  }
  return positions;
}

// Unit normals times 127, four numbers per vertex, weighted by the areas of the triangles.
export function normalsOf(x: Float32Array, triangles: Uint32Array): Int8Array {
  const sums = new Float64Array(x.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ux = x[b] - x[a], uy = x[b + 1] - x[a + 1], uz = x[b + 2] - x[a + 2];
    const vx = x[c] - x[a], vy = x[c + 1] - x[a + 1], vz = x[c + 2] - x[a + 2];
    for (let k = 0; k < 3; ++k) {
      const corner = k === 0 ? a : k === 1 ? b : c;
      sums[corner] += uy * vz - uz * vy;
      sums[corner + 1] += uz * vx - ux * vz;
      sums[corner + 2] += ux * vy - uy * vx;
    }
  }
  const normals = new Int8Array((x.length / 3) * 4);
  for (let i = 0; 3 * i < sums.length; ++i) {
    const length = Math.sqrt(sums[3 * i] ** 2 + sums[3 * i + 1] ** 2 + sums[3 * i + 2] ** 2) || 1;
    for (let k = 0; k < 3; ++k) normals[4 * i + k] = Math.round((127 * sums[3 * i + k]) / length);
  }
  return normals;
}

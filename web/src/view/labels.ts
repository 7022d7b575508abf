// Selects the vertices and tets that get number labels: visible ones, spread so that no two texts overlap.
import type { Geometry } from "../protocol";
import { pixelsPerMeter, type Lens } from "./lens";
import { DepthGrid, kSteepest, screenPositions, type Surface } from "./picking";

export interface Label extends Pick<Box, "x" | "y"> {
  text: string;
}

const kMost = 300;
export const kSkinPoint = 0xffffffff; // vertex number of a point of a fine skin
const kCell = 6; // cell size of the grid for hidden vertices [px]

interface LabelOptions {
  vertices: boolean;
  tets: boolean;
  em: number; // height of text [px]
  cursor: [number, number] | null; // if there are too many labels, those near it come first
}

export function chooseLabels(lens: Lens, surface: Surface, geometry: Geometry, options: LabelOptions): Label[] {
  const screen = screenPositions(lens, surface.positions, surface.clip);
  const grid = new DepthGrid(0, 0, kCell, Math.ceil(lens.width / kCell), Math.ceil(lens.height / kCell));
  grid.add(screen, surface.triangles);
  const chosen = new Spread(lens, grid, options.em);
  if (options.vertices)
    for (let i = 0; i < geometry.vertex.length; ++i)
      if (geometry.vertex[i] !== kSkinPoint)
        chosen.offer(screen[3 * i], screen[3 * i + 1], screen[3 * i + 2], () => String(geometry.vertex[i]));
  if (options.tets)
    for (let t = 0; t < geometry.tet.length; ++t) {
      const middle = (c: number): number =>
        [0, 1, 2].reduce((sum, k) => sum + screen[3 * surface.triangles[3 * t + k] + c], 0) / 3;
      chosen.offer(middle(0), middle(1), middle(2), () => `[${geometry.tet[t]}]`);
    }
  return chosen.labels(options.cursor ?? [lens.width / 2, lens.height / 2]);
}

// A text; x is its left end, y the middle of its height.
export interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

// Moves texts that overlap an earlier one down as far as necessary, or up if there is no room below.
export function apart<Text extends Box>(boxes: readonly Text[], top: number, bottom: number): Text[] {
  const placed: Text[] = [];
  for (const box of [...boxes].sort((p, q) => p.y - q.y)) {
    const first = Math.max(top, Math.min(bottom, box.y));
    placed.push({ ...box, y: free(box, first, 1, placed, bottom) ?? free(box, first, -1, placed, top) ?? first });
  }
  return placed;
}

function free(box: Box, from: number, direction: 1 | -1, placed: readonly Box[], end: number): number | null {
  let y = from;
  for (let tries = 0; tries <= placed.length; ++tries) {
    if (direction * (end - y) < 0) return null;
    const hit = placed.find((other) => overlap({ ...box, y }, other));
    if (!hit) return y;
    y = hit.y + direction * (1.001 * (box.height + hit.height)) / 2;
  }
  return null;
}

function overlap(p: Box, q: Box): boolean {
  const apartAcross = p.x >= q.x + q.width || q.x >= p.x + p.width;
  return !apartAcross && Math.abs(p.y - q.y) < (p.height + q.height) / 2;
}

interface Candidate extends Pick<Box, "x" | "y"> {
  depth: number;
  text: () => string;
}

// Keeps one candidate per label-sized cell, the nearest to the eye, then removes overlaps.
class Spread {
  private readonly cells = new Map<number, Candidate>();
  private readonly width: number;
  private readonly height: number;

  constructor(
    private readonly lens: Lens,
    private readonly grid: DepthGrid,
    em: number,
  ) {
    this.width = 3.2 * em;
    this.height = 1.3 * em;
  }

  offer(x: number, y: number, depth: number, text: () => string): void {
    if (!(x >= 0 && x < this.lens.width && y >= 0 && y < this.lens.height)) return;
    const cell = this.cell(x, y);
    const held = this.cells.get(cell);
    if (held && held.depth <= depth) return;
    const slack = (kSteepest * kCell) / pixelsPerMeter(this.lens, depth);
    if (this.grid.isVisible(x, y, depth, slack)) this.cells.set(cell, { x, y, depth, text });
  }

  labels([cx, cy]: [number, number]): Label[] {
    const away = ({ x, y }: Candidate): number => Math.hypot(x - cx, y - cy);
    const kept = new Map<number, Candidate>();
    for (const candidate of [...this.cells.values()].sort((a, b) => away(a) - away(b))) {
      if (kept.size >= kMost) break;
      if (!this.overlaps(candidate, kept)) kept.set(this.cell(candidate.x, candidate.y), candidate);
    }
    return [...kept.values()].map(({ x, y, text }) => ({ x, y, text: text() }));
  }

  private cell(x: number, y: number): number {
    return Math.floor(y / this.height) * 65536 + Math.floor(x / this.width);
  }

  private overlaps({ x, y }: Candidate, kept: Map<number, Candidate>): boolean {
    for (const dx of [-this.width, 0, this.width])
      for (const dy of [-this.height, 0, this.height]) {
        const other = kept.get(this.cell(x + dx, y + dy));
        if (other && Math.abs(other.x - x) < this.width && Math.abs(other.y - y) < this.height) return true;
      }
    return false;
  }
}

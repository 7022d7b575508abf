// Values on a plane grid: the heights of their picture, and the quadratic function through samples.
import type { FunctionReply, IterationReply, MaybeNumber } from "../protocol";
import { finite } from "../numbers";
import { lowerBound } from "./table";

export interface Grid {
  x: number[]; // ascending
  y: number[];
  value: MaybeNumber[]; // x.length times y.length values, x fastest; null: not finite
}

export interface Point {
  x: number;
  y: number;
}

export function uniform(from: number, to: number, samples: number): number[] {
  return Array.from({ length: samples }, (_, i) => from + ((to - from) * i) / (samples - 1));
}

// Grid of a slice, whose coordinates are given per line or per sample.
export function gridOf(slice: IterationReply["slice"]): Grid {
  const { columns, rows, s, t, value } = slice;
  const x = s.length === columns ? s : s.slice(0, columns);
  const y = t.length === rows ? t : Array.from({ length: rows }, (_, row) => t[row * columns]!);
  return { x, y, value };
}

export interface Range {
  low: number;
  high: number;
  cut: boolean; // some values are above `high`
}

// Range of heights to show: all of them, unless a wall would flatten the valley. Includes the values in `keep`.
export function heightRange(values: readonly MaybeNumber[], keep: readonly MaybeNumber[] = []): Range {
  const known = finite(values).sort((p, q) => p - q);
  const kept = finite(keep);
  if (known.length === 0) return { low: 0, high: 1, cut: false };
  const low = Math.min(known[0]!, ...kept);
  const highest = known[known.length - 1]!;
  const quantile = known[Math.floor(0.75 * (known.length - 1))]!;
  const tall = highest - low > 4 * (quantile - low) && quantile > low;
  const shown = Math.max(low + 2 * (quantile - low), ...kept.map((v) => v + 0.05 * (v - low)));
  const high = tall ? Math.min(highest, shown) : highest;
  return high > low ? { low, high, cut: high < highest } : { low, high: low + (Math.abs(low) * 1e-9 || 1), cut: false };
}

export type Scale = "linear" | "log";
const kLogFloor = 1e-4; // relative to the range; smaller differences look flat

// Maps values to heights, `low` to 0 and `high` to 1, and the inverse.
export function heightOf({ low, high }: Range, scale: Scale): (value: number) => number {
  if (scale === "linear") return (value) => (value - low) / (high - low);
  const floor = kLogFloor * (high - low);
  const whole = Math.log1p(1 / kLogFloor);
  return (value) => (value >= low ? Math.log1p((value - low) / floor) / whole : (value - low) / floor / whole);
}

export function valueAtHeight({ low, high }: Range, scale: Scale): (height: number) => number {
  if (scale === "linear") return (height) => low + height * (high - low);
  return (height) => low + kLogFloor * (high - low) * Math.expm1(height * Math.log1p(1 / kLogFloor));
}

// Bilinear interpolation; null outside of the grid and beside holes.
export function sample(grid: Grid, x: number, y: number): MaybeNumber {
  const [i, fx] = cell(grid.x, x);
  const [j, fy] = cell(grid.y, y);
  if (i < 0 || j < 0) return null;
  const n = grid.x.length;
  const at = (di: number, dj: number): MaybeNumber => grid.value[(j + dj) * n + i + di] ?? null;
  const [a, b, c, d] = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
  if (a === null || b === null || c === null || d === null) return null;
  return (1 - fy) * ((1 - fx) * a + fx * b) + fy * ((1 - fx) * c + fx * d);
}

function cell(axis: readonly number[], at: number): [index: number, fraction: number] {
  if (!(at >= axis[0] && at <= axis[axis.length - 1]) || axis.length < 2) return [-1, 0];
  const high = Math.max(1, lowerBound(axis, at));
  return [high - 1, (at - axis[high - 1]) / (axis[high] - axis[high - 1])];
}

// value + gradient . p + 1/2 p' H p, with p from `center`.
export type Quadratic = FunctionReply["model"];

export function quadraticAt(q: Quadratic, x: number, y: number): number {
  const [px, py] = [x - q.center[0], y - q.center[1]];
  return (
    q.value + q.gradient[0] * px + q.gradient[1] * py + 0.5 * (q.xx * px * px + 2 * q.xy * px * py + q.yy * py * py)
  );
}

// Minimizer of the quadratic; null if it has no minimum.
export function minimizerOf(q: Quadratic): Point | null {
  const determinant = q.xx * q.yy - q.xy * q.xy;
  if (!(q.xx > 0) || !(determinant > 1e-14 * q.xx * q.yy)) return null;
  const [gx, gy] = q.gradient;
  return {
    x: q.center[0] - (q.yy * gx - q.xy * gy) / determinant,
    y: q.center[1] - (q.xx * gy - q.xy * gx) / determinant,
  };
}

// Quadratic through samples of a uniform grid, about its middle, by differences over half of the grid.
export function quadraticFrom(grid: Grid): Quadratic | null {
  const [n, m] = [grid.x.length, grid.y.length];
  const [i, j] = [(n - 1) >> 1, (m - 1) >> 1];
  if (i < 1 || j < 1) return null;
  const [hx, hy] = [grid.x[2 * i]! - grid.x[i]!, grid.y[2 * j]! - grid.y[j]!];
  const at = (a: number, b: number): number => grid.value[b * j * n + a * i] ?? Number.NaN;
  const value = at(1, 1);
  const quadratic: Quadratic = {
    center: [grid.x[i], grid.y[j]],
    value,
    gradient: [(at(2, 1) - at(0, 1)) / (2 * hx), (at(1, 2) - at(1, 0)) / (2 * hy)],
    xx: (at(2, 1) - 2 * value + at(0, 1)) / (hx * hx),
    yy: (at(1, 2) - 2 * value + at(1, 0)) / (hy * hy),
    xy: (at(2, 2) - at(2, 0) - at(0, 2) + at(0, 0)) / (4 * hx * hy),
  };
  return Object.values(quadratic).flat().every(Number.isFinite) ? quadratic : null;
}

// Part of a segment inside the grid's rectangle; null if there is none. [Liang, Barsky 1984]
export function clipped(grid: Grid, p: Point, q: Point): [Point, Point] | null {
  let [from, to] = [0, 1];
  const [dx, dy] = [q.x - p.x, q.y - p.y];
  const { left, right, bottom, top } = edgesOf(grid);
  for (const [slope, room] of [
    [-dx, p.x - left],
    [dx, right - p.x],
    [-dy, p.y - bottom],
    [dy, top - p.y],
  ] as const) {
    if (slope === 0 && room < 0) return null;
    if (slope < 0) from = Math.max(from, room / slope);
    if (slope > 0) to = Math.min(to, room / slope);
  }
  if (!(from <= to)) return null;
  const at = (f: number): Point => ({ x: p.x + f * dx, y: p.y + f * dy });
  return [at(from), at(to)];
}

export function isInside(grid: Grid, { x, y }: Point): boolean {
  const { left, right, bottom, top } = edgesOf(grid);
  return x >= left && x <= right && y >= bottom && y <= top;
}

function edgesOf({ x, y }: Grid): Record<"left" | "right" | "bottom" | "top", number> {
  return { left: x[0], right: x[x.length - 1], bottom: y[0], top: y[y.length - 1] };
}

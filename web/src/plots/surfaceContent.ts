// Content of the picture of a surface.
import type { MaybeNumber } from "../protocol";
import { isInside, minimizerOf, quadraticAt, type Grid, type Point, type Quadratic } from "./grid";
import type { Sign } from "./legend";
import { plural } from "../numbers";
import type { Color } from "./palette";

export interface Mark extends Point {
  value: MaybeNumber; // null: on the surface
  shape: "dot" | "ring" | "diamond" | "cross";
  color: Color;
  size: number; // size [CSS px]
  label?: string;
}

export interface SurfaceContent {
  label: string; // name for screen readers
  grid: Grid;
  axes: { x: string; y: string; value: string };
  model: MaybeNumber[] | null; // on the same grid
  path: (Point & { value: MaybeNumber })[];
  blocked?: readonly number[]; // samples of the grid that cannot be reached
  draped: boolean; // the path follows the surface; otherwise it is straight from point to point
  direction: { from: Point; to: Point } | null;
  marks: Mark[];
  signs: Sign[]; // legend
  keep: MaybeNumber[]; // values that must not be cut off
  log: boolean;
}

export function addRejected(content: SurfaceContent, trials: readonly (Point & { value: MaybeNumber })[]): void {
  for (const trial of trials) content.marks.push({ ...trial, shape: "cross", color: "bad", size: 10 });
  if (trials.length > 0) content.signs.push({ sign: "✕", color: "bad", text: plural(trials.length, "rejected trial") });
}

// Marks the minimum of the quadratic model. `place` formats a point outside of the grid.
export function addModelMinimum(content: SurfaceContent, model: Quadratic | null, place: (p: Point) => string): void {
  const lowest = model && minimizerOf(model);
  const outside = lowest && !isInside(content.grid, lowest) ? `, outside at ${place(lowest)}` : "";
  const text = lowest ? `the model's minimum${outside}` : "the model has no minimum here";
  content.signs.push({ sign: "◆", color: "series4", text });
  if (!model || !lowest) return;
  const value = quadraticAt(model, lowest.x, lowest.y);
  content.marks.push({ ...lowest, value, shape: "diamond", color: "series4", size: 12, label: "model's minimum" });
}

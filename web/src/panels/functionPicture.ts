// Picture of the functions panel: the surface, the path on it, and the quadratic model of the chosen iteration.
import type { FunctionReply } from "../protocol";
import { isInside, minimizerOf, quadraticAt, uniform, type Grid } from "../plots/grid";
import type { Sign } from "../plots/legend";
import { plural, short } from "../plots/numbers";
import type { Mark, SurfaceContent } from "../plots/surfaceBody";

export interface FunctionPicture {
  content: SurfaceContent;
  signs: Sign[]; // meaning of its marks
}

export interface FunctionLook {
  iteration: number;
  wholePath: boolean; // draw the path beyond that iteration
  start: [number, number];
  model: boolean;
  log: boolean;
}

export function pictureOf(reply: FunctionReply, look: FunctionLook): FunctionPicture {
  const grid: Grid = {
    x: uniform(reply.lower[0], reply.upper[0], reply.samples),
    y: uniform(reply.lower[1], reply.upper[1], reply.samples),
    value: reply.value,
  };
  const model = look.model && reply.iterations.length > 0;
  const marks: Mark[] = [];
  const signs: Sign[] = [{ sign: "▇", color: "series3", text: `f = ${reply.formula}` }];
  addTrials(reply, look.iteration, marks, signs);
  if (model) addModel(reply, grid, marks, signs);
  addMinimum(reply, marks, signs);
  addEnds(reply, look, marks, signs);
  const content: SurfaceContent = {
    label: `f = ${reply.formula}, with the path of ${plural(reply.iterations.length, "iteration")}`,
    grid,
    axes: { x: "x", y: "y", value: "f" },
    model: model ? modelOn(grid, reply) : null,
    path: reply.path.slice(0, look.wholePath ? undefined : look.iteration + 2),
    draped: true,
    direction: null,
    marks,
    keep: [reply.path[look.iteration]?.value ?? null],
    log: look.log,
  };
  return { content, signs };
}

function modelOn(grid: Grid, { model, samples }: FunctionReply): number[] {
  return grid.value.map((_, k) => quadraticAt(model, grid.x[k % samples]!, grid.y[Math.floor(k / samples)]!));
}

function addTrials(reply: FunctionReply, iteration: number, marks: Mark[], signs: Sign[]): void {
  const from = reply.path[iteration];
  const to = reply.path[iteration + 1];
  const alpha = reply.iterations[iteration]?.alpha ?? 0;
  if (!from || !to || !(alpha > 0)) return;
  const rejected = reply.trials.filter((trial) => !trial.accepted);
  for (const { alpha: tried, value } of rejected) {
    const [x, y] = [from.x + (tried / alpha) * (to.x - from.x), from.y + (tried / alpha) * (to.y - from.y)];
    marks.push({ x, y, value, shape: "cross", color: "bad", size: 10 });
  }
  if (rejected.length > 0) signs.push({ sign: "✕", color: "bad", text: plural(rejected.length, "rejected trial") });
}

function addModel(reply: FunctionReply, grid: Grid, marks: Mark[], signs: Sign[]): void {
  signs.push({ sign: "▇", color: "series2", text: "quadratic model of this iteration" });
  const lowest = minimizerOf(reply.model);
  if (!lowest) return void signs.push({ sign: "◆", color: "series4", text: "the model has no minimum" });
  const value = quadraticAt(reply.model, lowest.x, lowest.y);
  marks.push({ ...lowest, value, shape: "diamond", color: "series4", size: 12 });
  const place = isInside(grid, lowest) ? "" : `, outside at (${short(lowest.x, 3)}, ${short(lowest.y, 3)})`;
  signs.push({ sign: "◆", color: "series4", text: `the model's minimum${place}` });
}

function addMinimum({ minimizer }: FunctionReply, marks: Mark[], signs: Sign[]): void {
  if (!minimizer) return;
  const [x, y] = minimizer;
  marks.push({ x, y, value: null, shape: "cross", color: "series8", size: 11, label: "minimum" });
  signs.push({ sign: "✕", color: "series8", text: "the minimum of f" });
}

// Adds the ends of the iteration and the initial point.
function addEnds(reply: FunctionReply, look: FunctionLook, marks: Mark[], signs: Sign[]): void {
  const from = reply.path[look.iteration];
  const to = reply.path[look.iteration + 1];
  if (from) marks.push({ ...from, shape: "dot", color: "accent", size: 12 });
  if (to) marks.push({ ...to, shape: "dot", color: "good", size: 12 });
  const [x, y] = look.start;
  marks.push({ x, y, value: null, shape: "ring", color: "bad", size: 13, label: "start: drag me" });
  signs.push({ sign: "●", color: "accent", text: "this iteration begins here" });
  signs.push({ sign: "●", color: "good", text: "this iteration ends here" });
  signs.push({ sign: "•─", color: "text", text: "iterates so far" });
}

// Picture of the functions panel: the surface, the path on it, and the quadratic model of the chosen iteration.
import type { FunctionReply } from "../protocol";
import { quadraticAt, uniform, type Grid } from "../plots/grid";
import { plural, short } from "../numbers";
import { addModelMinimum, addRejected, type SurfaceContent } from "../plots/surfaceContent";

interface FunctionDisplay {
  iteration: number;
  wholePath: boolean; // draw the path beyond that iteration
  start: [number, number];
  model: boolean;
  log: boolean;
}

export function pictureOf(reply: FunctionReply, display: FunctionDisplay): SurfaceContent {
  const grid: Grid = {
    x: uniform(reply.lower[0], reply.upper[0], reply.samples),
    y: uniform(reply.lower[1], reply.upper[1], reply.samples),
    value: reply.value,
  };
  const model = display.model && reply.iterations.length > 0;
  const content: SurfaceContent = {
    label: `f = ${reply.formula}, with the path of ${plural(reply.iterations.length, "iteration")}`,
    grid,
    axes: { x: "x", y: "y", value: "f" },
    model: model ? modelOn(grid, reply) : null,
    path: reply.path.slice(0, display.wholePath ? undefined : display.iteration + 2),
    draped: true,
    direction: null,
    marks: [],
    signs: [{ sign: "▇", color: "series3", text: `f = ${reply.formula}` }],
    keep: [reply.path[display.iteration]?.value ?? null],
    log: display.log,
  };
  addTrials(content, reply, display.iteration);
  if (model) {
    content.signs.push({ sign: "▇", color: "series2", text: "quadratic model of this iteration" });
    addModelMinimum(content, reply.model, ({ x, y }) => `(${short(x, 3)}, ${short(y, 3)})`);
  }
  addMinimum(content, reply);
  addEnds(content, reply, display);
  return content;
}

function modelOn(grid: Grid, { model, samples }: FunctionReply): number[] {
  return grid.value.map((_, k) => quadraticAt(model, grid.x[k % samples]!, grid.y[Math.floor(k / samples)]!));
}

function addTrials(content: SurfaceContent, reply: FunctionReply, iteration: number): void {
  const [from, to] = [reply.path[iteration], reply.path[iteration + 1]];
  const alpha = reply.iterations[iteration]?.alpha ?? 0;
  if (!from || !to || !(alpha > 0)) return;
  const rejected = reply.trials.filter((trial) => !trial.accepted);
  const along = (part: number, a: number, b: number): number => a + (part / alpha) * (b - a);
  addRejected(content, rejected.map((t) => ({ x: along(t.alpha, from.x, to.x), y: along(t.alpha, from.y, to.y), value: t.value })));
}

function addMinimum({ marks, signs }: SurfaceContent, { minimizer }: FunctionReply): void {
  if (!minimizer) return;
  const [x, y] = minimizer;
  marks.push({ x, y, value: null, shape: "cross", color: "series8", size: 11, label: "minimum" });
  signs.push({ sign: "✕", color: "series8", text: "the minimum of f" });
}

// Adds the ends of the iteration and the initial point.
function addEnds({ marks, signs }: SurfaceContent, reply: FunctionReply, display: FunctionDisplay): void {
  const [from, to] = [reply.path[display.iteration], reply.path[display.iteration + 1]];
  if (from) marks.push({ ...from, shape: "dot", color: "accent", size: 12 });
  if (to) marks.push({ ...to, shape: "dot", color: "good", size: 12 });
  const [x, y] = display.start;
  marks.push({ x, y, value: null, shape: "ring", color: "bad", size: 13, label: "start: drag me" });
  signs.push({ sign: "●", color: "accent", text: "this iteration begins here" });
  signs.push({ sign: "●", color: "good", text: "this iteration ends here" });
  signs.push({ sign: "•─", color: "text", text: "iterates so far" });
}

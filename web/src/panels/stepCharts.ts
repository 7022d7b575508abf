// Charts of the microscope: over the iterations of one step, and over the steps.
import type { Chosen } from "../plots/chosen";
import { Chart, type ChartOptions, type Curve } from "../plots/chart";
import { choice } from "../controls";
import { element } from "../dom";
import { short, withUnit } from "../plots/numbers";
import type { Palette } from "../plots/palette";
import { SearchChart, type Search } from "../plots/search";
import { nearest, thinned } from "../plots/table";
import { paintVerticalLine } from "../plots/painting";
import { aboveLowest } from "../plots/summaries";
import type { IterationRow, MaybeNumber, StepRow } from "../protocol";
import type uPlot from "uplot";

export const kCharts = [
  ["search", "Line search: E along d"],
  ["convergence", "Convergence over the iterations"],
  ["alpha", "Step length α over the iterations"],
  ["time", "Time by stage over the iterations"],
  ["inner", "Inner iterations of the linear solver"],
  ["projected", "Projected elements over the iterations"],
  ["steps", "Iterations per step"],
] as const;
export type ChartName = (typeof kCharts)[number][0];

const kStages = ["hessian", "factorize", "solve", "line_search", "gradient"] as const;
const kStageColors = ["series1", "series2", "series3", "series4", "series5"] as const;

const kIteration = { label: "iteration", integer: true };

interface Plan {
  options: Pick<ChartOptions, "label" | "x" | "y"> & { curves: Curve[] };
  x: number[];
  columns: MaybeNumber[][];
  text: (column: number, row: number) => string;
}

function curve(
  key: string,
  label: string,
  meaning: string,
  color: Curve["color"],
  shape: Curve["shape"] = "both",
): Curve {
  return { key, label, meaning, color, shape, width: 1.75 };
}

function convergence(rows: readonly IterationRow[]): Plan {
  const positive = (values: MaybeNumber[]): MaybeNumber[] => values.map((v) => (v !== null && v > 0 ? v : null));
  const columns = [
    positive(rows.map((r) => r.gradient_norm)),
    aboveLowest(rows.map((r) => r.value)),
    positive(rows.map((r) => r.decrement)),
  ];
  return {
    options: {
      label: "Convergence over the iterations",
      x: kIteration,
      y: { label: "", log: true },
      curves: [
        curve("gradient", "|g|", "norm of the gradient before the iteration", "series1"),
        curve("energy", "E − lowest E", "objective before the iteration, above its lowest value in this step", "series2"),
        curve("decrement", "decrement", "−g·d / 2: decrease that the quadratic model predicts", "series3"),
      ],
    },
    x: rows.map((_, i) => i),
    columns,
    text: (column, row) => short(columns[column]![row]),
  };
}

function counted(
  rows: readonly IterationRow[],
  label: string,
  meaning: string,
  value: (row: IterationRow) => MaybeNumber,
  shape: Curve["shape"],
): Plan {
  const column = rows.map(value);
  return {
    options: {
      label: `${label} over the iterations`,
      x: kIteration,
      y: { label: "" },
      curves: [curve("value", label, meaning, "series1", shape)],
    },
    x: rows.map((_, i) => i),
    columns: [column],
    text: (_column, row) => short(column[row]),
  };
}

// Stacked bars: a later bar is drawn over the sum with the stages below it.
function stages(rows: readonly IterationRow[]): Plan {
  const order = [...kStages].reverse();
  const columns = order.map((_, i) =>
    rows.map((row) => kStages.slice(0, kStages.length - i).reduce((sum, stage) => sum + row.seconds[stage], 0)),
  );
  return {
    options: {
      label: "Time by stage over the iterations",
      x: kIteration,
      y: { label: "time", unit: "s" },
      curves: order.map((stage) => {
        const color = kStageColors[kStages.indexOf(stage)]!;
        return curve(stage, stage.replace("_", " "), "wall time of this stage", color, "bars");
      }),
    },
    x: rows.map((_, i) => i),
    columns,
    text: (column, row) => withUnit(rows[row]?.seconds[order[column]!], "s", 3),
  };
}

function overSteps(steps: readonly StepRow[], width: number): Plan {
  const whole = {
    x: steps.map((s) => s.step),
    columns: [steps.map((s) => s.iterations.length), steps.map((s) => (s.converged ? null : s.iterations.length))],
  };
  const table = thinned(whole, 0, steps.length, Math.max(100, width));
  return {
    options: {
      label: "Iterations per step",
      x: { label: "step", integer: true },
      y: { label: "iterations" },
      curves: [
        curve("iterations", "iterations", "of the minimizer, per step", "series1", "line"),
        curve("failed", "not converged", "steps that did not converge", "bad", "points"),
      ],
    },
    x: table.x,
    columns: table.columns,
    text: (column, row) => short(table.columns[column]![row]),
  };
}

function planOf(name: Exclude<ChartName, "search">, chosen: Chosen, steps: readonly StepRow[], width: number): Plan {
  const rows = chosen.row()?.iterations ?? [];
  switch (name) {
    case "convergence":
      return convergence(rows);
    case "alpha":
      return counted(rows, "α", "accepted step length; 0: no acceptable step", (r) => r.alpha, "both");
    case "time":
      return stages(rows);
    case "inner":
      return counted(rows, "inner iterations", "of the iterative linear solver", (r) => r.linear_iterations, "bars");
    case "projected":
      return counted(rows, "projected elements", "elements with a modified Hessian", (r) => r.projected_elements, "bars");
    case "steps":
      return overSteps(steps, width);
  }
}

// A chart with a selection of its content.
export class StepChart {
  readonly element = element("div", { class: "microscope-cell" });
  private readonly fill = element("div", { class: "plot-fill" });
  private readonly empty = element("div", { class: "plot-note" });
  private readonly chart = new Chart();
  private readonly search = new SearchChart();
  private readonly select;
  private configured = "";
  private plan: Plan | null = null;

  constructor(
    name: ChartName,
    private readonly chosen: Chosen,
    private readonly steps: () => readonly StepRow[],
    changed: () => void,
  ) {
    this.select = choice("", "Content of this chart", kCharts, name, changed);
    this.element.append(this.select.element, this.empty, this.fill);
  }

  get name(): ChartName {
    return this.select.select.value as ChartName;
  }

  set name(name: ChartName) {
    this.select.select.value = name;
  }

  // `search`: the line search of the chosen iteration, or the reason why it is missing.
  show(search: Search | string): void {
    const shown = this.name === "search" ? this.search.element : this.chart.element;
    if (this.fill.firstChild !== shown) this.fill.replaceChildren(shown);
    this.empty.textContent = "";
    if (this.name !== "search") return this.showPlan();
    this.empty.textContent = typeof search === "string" ? search : (search.about ?? "");
    this.search.show(typeof search === "string" ? null : search);
  }

  private showPlan(): void {
    const name = this.name as Exclude<ChartName, "search">;
    const plan = planOf(name, this.chosen, this.steps(), this.chart.width);
    this.plan = plan;
    this.empty.textContent = plan.x.length === 0 ? "No iteration of a minimizer is available." : "";
    this.chart.element.hidden = plan.x.length === 0;
    if (this.configured !== name) {
      this.configured = name;
      const read = (key: string, x: number | null): string[] => this.read(key, x);
      const paint = (u: uPlot, colors: Palette): void => this.paintChosen(u, colors);
      const xRange = (): [number, number] | null => this.xRange();
      this.chart.configure({ ...plan.options, read, paint, xRange, clicked: (x) => this.clicked(x) });
    }
    this.chart.show(plan.x, plan.columns);
  }

  private read(key: string, x: number | null): string[] {
    const plan = this.plan;
    if (!plan || x === null || plan.x.length === 0) return [];
    const column = plan.options.curves.findIndex((c) => c.key === key);
    return [plan.text(column, nearest(plan.x, x))];
  }

  private xRange(): [number, number] | null {
    const x = this.plan?.x ?? [];
    return x.length > 0 ? [x[0]! - 0.5, x[x.length - 1]! + 0.5] : null;
  }

  private clicked(x: number): void {
    const index = Math.round(x);
    const { side, step } = this.chosen;
    if (this.name === "steps") {
      const numbers = this.steps().map((s) => s.step);
      if (numbers.length > 0) this.chosen.choose(side, numbers[nearest(numbers, index)]!, 0);
    } else if (index >= 0 && index < (this.chosen.row()?.iterations.length ?? 0)) this.chosen.choose(side, step, index);
  }

  // Draws a line at the chosen iteration or step.
  private paintChosen(u: uPlot, colors: Palette): void {
    paintVerticalLine(u, this.name === "steps" ? this.chosen.step : this.chosen.iteration, colors.accent, 0.6);
  }
}

// Charts of the microscope: over the iterations of one step, and over the steps.
import type { Chosen } from "../plots/chosen";
import { Chart, type ChartOptions, type Curve, type FilledCurve } from "../plots/chart";
import { choice } from "../controls";
import { element } from "../dom";
import { withUnit } from "../numbers";
import { SearchChart, type Search } from "../plots/search";
import { nearest, thinned } from "../plots/table";
import { paintVerticalLine } from "../plots/painting";
import { aboveLowest } from "../plots/summaries";
import type { IterationRow, MaybeNumber, StepRow } from "../protocol";

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
type Stage = (typeof kStages)[number];
const kStageColors = ["series1", "series2", "series3", "series4", "series5"] as const;

interface Plan {
  options: Pick<ChartOptions, "label" | "x" | "y">;
  x: number[];
  curves: FilledCurve[];
}

function curve(
  key: string,
  label: string,
  meaning: string,
  color: Curve["color"],
  values: MaybeNumber[],
  shape: Curve["shape"] = "both",
): FilledCurve {
  return { key, label, meaning, color, values, shape, width: 1.75 };
}

function overIterations(label: string, y: ChartOptions["y"], curves: FilledCurve[]): Plan {
  const x = curves[0].values.map((_, i) => i);
  return { options: { label: `${label} over the iterations`, x: { label: "iteration", integer: true }, y }, x, curves };
}

function convergence(rows: readonly IterationRow[]): Plan {
  const positive = (values: MaybeNumber[]): MaybeNumber[] => values.map((v) => (v !== null && v > 0 ? v : null));
  const gradient = positive(rows.map((r) => r.gradient_norm));
  const energy = aboveLowest(rows.map((r) => r.value));
  const decrement = positive(rows.map((r) => r.decrement));
  return overIterations("Convergence", { label: "", log: true }, [
    curve("gradient", "|g|", "norm of the gradient before the iteration", "series1", gradient),
    curve("energy", "E − lowest E", "objective before the iteration, above its lowest value in this step", "series2", energy),
    curve("decrement", "decrement", "−g·d / 2: decrease that the quadratic model predicts", "series3", decrement),
  ]);
}

function counted(label: string, meaning: string, values: MaybeNumber[], shape: Curve["shape"]): Plan {
  return overIterations(label, { label: "" }, [curve("value", label, meaning, "series1", values, shape)]);
}

// Stacked bars: a later bar is drawn over the sum with the stages below it.
function stages(rows: readonly IterationRow[]): Plan {
  const curves = kStages.map((stage, i) => {
    const sums = rows.map((row) => kStages.slice(0, i + 1).reduce((sum, below) => sum + row.seconds[below], 0));
    return curve(stage, stage.replace("_", " "), "wall time of this stage", kStageColors[i], sums, "bars");
  });
  return overIterations("Time by stage", { label: "time", unit: "s" }, curves.reverse());
}

function overSteps(steps: readonly StepRow[], width: number): Plan {
  const counts = steps.map((s) => s.iterations.length);
  const whole = { x: steps.map((s) => s.step), columns: [counts, counts.map((count, i) => (steps[i].converged ? null : count))] };
  const { x, columns } = thinned(whole, 0, steps.length, Math.max(100, width));
  return {
    options: { label: "Iterations per step", x: { label: "step", integer: true }, y: { label: "iterations" } },
    x,
    curves: [
      curve("iterations", "iterations", "of the minimizer, per step", "series1", columns[0], "line"),
      curve("failed", "not converged", "steps that did not converge", "bad", columns[1], "points"),
    ],
  };
}

function planOf(name: Exclude<ChartName, "search">, chosen: Chosen, width: number): Plan {
  const rows = chosen.row()?.iterations ?? [];
  switch (name) {
    case "convergence":
      return convergence(rows);
    case "alpha":
      return counted("α", "accepted step length; 0: no acceptable step", rows.map((r) => r.alpha), "both");
    case "time":
      return stages(rows);
    case "inner":
      return counted("inner iterations", "of the iterative linear solver", rows.map((r) => r.linear_iterations), "bars");
    case "projected":
      return counted("projected elements", "elements with a modified Hessian", rows.map((r) => r.projected_elements), "bars");
    case "steps":
      return overSteps(chosen.rows(), width);
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
  private x: number[] = [];

  constructor(
    name: ChartName,
    private readonly chosen: Chosen,
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
    const { options, x, curves } = planOf(name, this.chosen, this.chart.width);
    this.x = x;
    this.empty.textContent = x.length === 0 ? "No iteration of a minimizer is available." : "";
    this.chart.element.hidden = x.length === 0;
    if (this.configured !== name) {
      this.configured = name;
      this.chart.configure({
        ...options,
        curves,
        read: name === "time" ? (key, at) => this.stageText(key as Stage, at) : undefined,
        paint: (u, colors) => paintVerticalLine(u, name === "steps" ? this.chosen.step : this.chosen.iteration, colors.accent, 0.6),
        xRange: () => (this.x.length > 0 ? [this.x[0] - 0.5, this.x[this.x.length - 1] + 0.5] : null),
        clicked: (at) => this.clicked(at),
      });
    }
    this.chart.show(x, curves.map(({ values }) => values));
  }

  private stageText(stage: Stage, at: number | null): string[] {
    const rows = this.chosen.row()?.iterations ?? [];
    return at === null ? [] : [withUnit(rows[nearest(this.x, at)]?.seconds[stage], "s", 3)];
  }

  private clicked(x: number): void {
    const index = Math.round(x);
    const { side, step } = this.chosen;
    if (this.name === "steps") {
      const numbers = this.chosen.rows().map((s) => s.step);
      if (numbers.length > 0) this.chosen.choose(side, numbers[nearest(numbers, index)]!, 0);
    } else if (index >= 0 && index < (this.chosen.row()?.iterations.length ?? 0)) this.chosen.choose(side, step, index);
  }
}

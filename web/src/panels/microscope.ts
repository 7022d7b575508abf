// The minimization in detail: steps, iterations of one step, and line search of one iteration.
import { statusName } from "../names";
import { fieldsOf, type Page, type Panel } from "../page";
import type { IterationRow, SideName, StepRow, WorstReply } from "../protocol";
import type { Store } from "../store";
import type { Chosen } from "../plots/chosen";
import { checkbox, choice, oncePerFrame } from "../controls";
import { button, element } from "../dom";
import { plural, short, withUnit } from "../numbers";
import { Rows, type RowColumn } from "../plots/rows";
import type { Search } from "../plots/search";
import { stepText, totalSeconds } from "../plots/summaries";
import { excess } from "./certificate";
import { kCharts, StepChart, type ChartName } from "./stepCharts";

const kOrder: ChartName[] = ["search", "convergence", "time", "steps", "alpha", "inner"];

export class MicroscopePanel implements Panel {
  readonly name = "microscope";
  readonly title = "Microscope";
  readonly element = element("div", { class: "plot-panel", role: "group", "aria-label": "Solver microscope" });
  private readonly sides = choice("", "Which side of the comparison", [], "a", (side) =>
    this.chosen.chooseSide(side as SideName),
  );
  private readonly follow = checkbox("follow", "Follow the newest step", true, (on) => this.chosen.follow(on));
  private readonly words = element("div", { class: "plot-note", role: "status" });
  private readonly worst = element("ol", { class: "worst", hidden: "" });
  private readonly steps = new Rows({
    label: "Steps",
    columns: this.stepColumns(),
    rowClass: (row) => this.stepClass(row),
    choose: (row) => this.chooseStep(row),
  });
  private readonly iterations = new Rows({
    label: "Iterations of the chosen step",
    columns: this.iterationColumns(),
    rowClass: (row) => (this.iterationAt(row)?.alpha === 0 ? "failed whole" : ""),
    choose: (row) => this.chosen.choose(this.chosen.side, this.chosen.step, row),
  });
  private readonly grid = element("div", { class: "microscope-charts" });
  private charts: StepChart[] = [];
  private names: ChartName[] = [...kOrder];
  private readonly redraw = oncePerFrame(() => this.element.isConnected && this.draw());
  readonly show = this.redraw;

  constructor(
    private readonly store: Store,
    private readonly page: Page,
    private readonly chosen: Chosen,
  ) {
    const title = "List the tets with the worst values and mark them on the body";
    const worst = button({ text: "Worst elements", title }, () => void this.findWorst());
    const bar = element("div", { class: "plot-bar" }, this.sides.element, this.follow.element, worst, this.words);
    const tables = element("div", { class: "microscope-tables" }, this.steps.element, this.iterations.element);
    this.element.append(bar, this.worst, element("div", { class: "microscope plot-fill" }, tables, this.grid));
    for (const event of ["changed", "rows", "answered"] as const) this.chosen.on(event, this.redraw);
    for (const event of ["scene", "gone"] as const) store.on(event, this.redraw);
    page.keep("microscope", { save: () => ({ charts: this.names }), restore: (saved) => this.restore(saved) });
    new ResizeObserver(() => this.arrange()).observe(this.grid);
  }

  // Step in a row of the table, the newest first.
  private stepAt(row: number): StepRow | undefined {
    const rows = this.chosen.rows();
    return rows[rows.length - 1 - row];
  }

  private iterationAt(row: number): IterationRow | undefined {
    return this.chosen.row()?.iterations[row];
  }

  private stepClass(row: number): string {
    const step = this.stepAt(row);
    return !step || step.status === "under way" ? "" : step.converged ? "success" : "failed";
  }

  private stepColumns(): RowColumn[] {
    const of = (text: (step: StepRow) => string) => (row: number) => textOf(this.stepAt(row), text);
    return [
      column("step", "number of the time step; the newest is first", of((s) => String(s.step))),
      column("status", "status of the minimization", of(statusText), "status left"),
      column("it.", "iterations of the minimizer", of((s) => String(s.iterations.length))),
      column("resid.", "residual relative to its threshold", of(residualText)),
      column("took", "wall time", of((s) => withUnit(s.seconds, "s", 3)), "spare"),
    ];
  }

  private iterationColumns(): RowColumn[] {
    const of = (text: (it: IterationRow) => string) => (row: number) => textOf(this.iterationAt(row), text);
    return [
      column("#", "iteration of the step", (row) => this.mark(row)),
      column("E", "the objective before the iteration", of((it) => short(it.value, 5))),
      column("|g|", "norm of its gradient", of((it) => short(it.gradient_norm, 3))),
      column("decr.", "−g·d / 2: decrease that the quadratic model predicts", of((it) => short(it.decrement, 3))),
      column("α", "accepted step length; 0: no acceptable step", of((it) => (it.alpha === 0 ? "none" : short(it.alpha, 3)))),
      column("trials", "of the line search", of((it) => (it.trials.length > 0 ? String(it.trials.length) : "–"))),
      column("proj.", "elements with a modified Hessian", of((it) => String(it.projected_elements)), "spare"),
      column("inner", "iterations of the linear solver", of((it) => String(it.linear_iterations)), "spare"),
      column("took", "wall time", of((it) => withUnit(totalSeconds(it), "s", 3)), "spare"),
    ];
  }

  private mark(row: number): string {
    const count = this.chosen.row()?.iterations.length ?? 0;
    return row === count - 1 && !this.chosen.isUnderWay() ? `end ${row}` : String(row);
  }

  private chooseStep(row: number): void {
    const step = this.stepAt(row);
    const last = Math.max(0, (step?.iterations.length ?? 0) - 1);
    if (step) this.chosen.choose(this.chosen.side, step.step, Math.min(this.chosen.iteration, last));
  }

  private draw(): void {
    const rows = this.chosen.rows();
    const index = rows.findIndex((row) => row.step === this.chosen.step);
    this.follow.input.checked = this.chosen.following;
    this.showSides();
    this.steps.show(rows.length, index < 0 ? -1 : rows.length - 1 - index);
    this.iterations.show(this.chosen.row()?.iterations.length ?? 0, this.chosen.iteration);
    this.describe();
    const search = this.searchNow();
    for (const chart of this.charts) chart.show(search);
  }

  private showSides(): void {
    const two = this.store.side("b") !== null;
    this.sides.element.hidden = !two;
    if (!two) return;
    const options = (["a", "b"] as const).map((side) => new Option(this.store.title(side), side));
    const text = options.map((option) => option.text).join();
    if (this.sides.element.dataset.text !== text) this.sides.select.replaceChildren(...options);
    this.sides.element.dataset.text = text;
    this.sides.select.value = this.chosen.side;
  }

  private describe(): void {
    const row = this.chosen.row();
    const implicit = this.chosen.isImplicit();
    const none = implicit ? "No step has been computed yet." : "This integrator does not minimize; no step has been computed yet.";
    if (!row) this.words.textContent = none;
    else if (this.chosen.isUnderWay()) this.words.textContent = `Step ${row.step} is under way: ${plural(row.iterations.length, "iteration")}.`;
    else this.words.textContent = `Step ${row.step}. ${stepText(row, implicit, this.store.side(this.chosen.side)?.scene.settings ?? [])}`;
    this.words.dataset.kind = row && !row.converged ? "bad" : "";
  }

  // E along d at the chosen iteration, requested when a chart shows it; or the reason why it is missing.
  private searchNow(): Search | string {
    if (!this.charts.some((chart) => chart.name === "search")) return "";
    if (!this.chosen.iterationRow())
      return this.chosen.isImplicit() ? "No iteration is chosen." : "This integrator does not minimize, so there is no line search.";
    this.chosen.request();
    const seen = this.chosen.seen;
    if (!seen) return "Computing E along d ...";
    if (!seen.reply) return `E along d is not available: ${seen.why}`;
    const settings = this.store.side(seen.at.side)?.scene.settings ?? [];
    const test = settings.find((setting) => setting.key.endsWith("line_search.test"))?.value;
    const about = this.chosen.isSeen() ? "" : `of step ${seen.at.step}, iteration ${seen.at.iteration}`;
    return { ...seen.reply, test: typeof test === "string" ? test : "textbook", about };
  }

  // Shows as many charts as fit, on a slide two beside each other.
  private arrange(): void {
    const font = Number.parseFloat(getComputedStyle(this.grid).fontSize) || 14;
    const across = Math.max(1, Math.min(this.grid.closest(".slides") ? 2 : 3, Math.floor(this.grid.clientWidth / (14.5 * font))));
    const down = Math.max(1, Math.min(2, Math.floor(this.grid.clientHeight / (11 * font))));
    this.grid.style.gridTemplate = `repeat(${down}, minmax(0, 1fr)) / repeat(${across}, minmax(0, 1fr))`;
    const count = across * down;
    while (this.charts.length < count) this.charts.push(this.makeChart(this.charts.length));
    this.grid.replaceChildren(...this.charts.slice(0, count).map((chart) => chart.element));
    this.redraw();
  }

  private makeChart(place: number): StepChart {
    const chart: StepChart = new StepChart(this.names[place] ?? "steps", this.chosen, () => {
      this.names[place] = chart.name;
      this.redraw();
    });
    return chart;
  }

  private async findWorst(): Promise<void> {
    try {
      const reply = await this.store.source.ask<WorstReply>({ ask: "worst", side: this.chosen.side });
      const marks = reply.items.map(({ what, value, unit, positions }) => ({ positions, text: `${what}: ${unit ? withUnit(value, unit) : short(value)}` }));
      const items = marks.map((mark) => button({ text: mark.text, title: "Mark it on the body" }, () => this.page.emit("highlight", [mark])));
      this.worst.replaceChildren(...items.map((item) => element("li", {}, item)));
      this.worst.hidden = items.length === 0;
      this.page.emit("highlight", marks);
    } catch (reason) {
      this.page.report(reason);
    }
  }

  private restore(saved: unknown): void {
    const { charts } = fieldsOf(saved);
    if (!Array.isArray(charts)) return;
    this.names = kOrder.map((name, i) => kCharts.find(([known]) => known === charts[i])?.[0] ?? name);
    this.charts.forEach((chart, i) => (chart.name = this.names[i]!));
    this.redraw();
  }
}

const textOf = <T>(item: T | undefined, text: (item: T) => string): string => (item ? text(item) : "");

function column(title: string, meaning: string, text: (row: number) => string, className?: string): RowColumn {
  return { title, meaning, text, class: className };
}

function residualText(step: StepRow): string {
  const relative = excess(step);
  return relative === null ? withUnit(step.residual, "N", 3) : `${short(relative, 2)} ×`;
}

function statusText(step: StepRow): string {
  if (step.status === "under way") return "… under way";
  return `${step.converged ? "✓" : "✗"} ${statusName(step.status)}`;
}

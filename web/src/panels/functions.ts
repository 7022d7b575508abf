// Functions of two variables, minimised by the simulation's own methods: the lecture's surfaces, from any start.
import { Newest } from "../newest";
import type { Page, Panel } from "../page";
import type { FunctionQuestion, FunctionReply } from "../protocol";
import type { Store } from "../store";
import { button, checkbox, downloadCanvas, element, fileName } from "../plots/dom";
import { isInside, minimizerOf, quadraticAt, uniform, type Grid } from "../plots/grid";
import { legendOf, type Sign } from "../plots/legend";
import { plural, short } from "../plots/numbers";
import { sentence } from "../plots/words";
import { SearchChart } from "../plots/search";
import { SurfaceView } from "../plots/surface";
import type { Mark, SurfaceContent } from "../plots/surfaceBody";
import { FunctionForm, kPresets, type Preset } from "./functionForm";

const kSamples = 81;
const kPlayEvery = 700; // [ms]

export interface FunctionsPanel extends Panel {
  open(question: FunctionQuestion): void;
}

export function makeFunctionsPanel(store: Store, page: Page): FunctionsPanel {
  return new PlanarPanel(store, page);
}

class PlanarPanel implements FunctionsPanel {
  readonly name = "functions";
  readonly title = "Functions";
  readonly share = 0.58; // a surface needs room
  readonly element = element("div", {
    class: "plot-panel",
    role: "group",
    "aria-label": "Minimising a function of two variables",
  });
  private readonly form = new FunctionForm(() => this.formChanged());
  private readonly view = new SurfaceView();
  private readonly search = new SearchChart("f");
  private readonly slider = element("input", {
    type: "range",
    min: "0",
    max: "0",
    value: "0",
    "aria-label": "Iteration",
  });
  private readonly where = element("strong");
  private readonly playButton = button("▶ play", "Goes through the iterations", () => this.togglePlay());
  private readonly model = checkbox("quadratic model", "Shows the model that this iteration minimised", true, () =>
    this.draw(),
  );
  private readonly log = checkbox(
    "log height",
    "Heights by the logarithm of f above its lowest value here",
    false,
    () => this.draw(),
  );
  private readonly words = element("div", { class: "plot-note", role: "status" });
  private readonly about = element("div", { class: "plot-note" });
  private readonly legend = element("div");
  private reply: FunctionReply | null = null;
  private signs: Sign[] = [];
  private iteration = 0;
  private shows = ""; // of the preset
  private readonly questions = new Newest<FunctionQuestion>(
    (question) => this.send(question),
    (reason) => this.fail(reason instanceof Error ? reason.message : String(reason)),
  );
  private asked = false; // at least once
  private visible = false;
  private timer: ReturnType<typeof setInterval> | null = null;

  constructor(
    private readonly store: Store,
    page: Page,
  ) {
    const presets = element("div", { class: "pair", role: "group", "aria-label": "Examples" });
    for (const preset of kPresets) presets.append(button(preset.title, preset.shows, () => this.openPreset(preset)));
    this.form.element.prepend(presets);
    const walk = element(
      "div",
      { class: "plot-bar" },
      this.playButton,
      this.slider,
      this.where,
      this.model.element,
      this.log.element,
    );
    walk.append(
      button("PNG", "Save the picture", () => this.savePng()),
      this.words,
    );
    const chart = element("div", { class: "functions-chart" }, this.search.element);
    const right = element("div", { class: "functions-side" }, this.about, chart, this.legend);
    this.element.append(
      walk,
      element(
        "div",
        { class: "plot-columns plot-fill" },
        this.form.element,
        element("div", { class: "plot-fill" }, this.view.element),
        right,
      ),
    );
    this.slider.addEventListener("input", () => {
      this.stop();
      this.goTo(this.slider.valueAsNumber);
    });
    this.view.dragged = (at, done) => this.drag(at.x, at.y, done);
    this.view.nudged = (dx, dy) => this.nudge(dx, dy);
    page.on("theme", () => this.retheme());
    page.on("layout", () => this.retheme());
    page.keep("functions", {
      save: () => this.form.question(this.iteration, kSamples),
      restore: (saved) => this.restore(saved),
    });
  }

  show(visible: boolean): void {
    this.visible = visible;
    this.view.setVisible(visible);
    if (!visible) this.stop();
    else if (!this.asked) this.formChanged();
  }

  open(question: FunctionQuestion): void {
    this.shows = "";
    this.stop();
    this.form.fill(question);
    this.iteration = question.iteration;
    this.ask();
  }

  private openPreset(preset: Preset): void {
    this.log.input.checked = preset.log;
    this.model.input.checked = preset.model;
    this.open({ ...preset, samples: kSamples });
    this.shows = preset.shows;
  }

  private formChanged(): void {
    this.shows = "";
    this.stop();
    this.iteration = 0;
    this.ask();
  }

  private ask(): void {
    this.asked = true;
    this.questions.push(this.form.question(this.iteration, kSamples));
  }

  private async send(question: FunctionQuestion): Promise<void> {
    this.take(await this.store.source.ask<FunctionReply>({ ask: "function", ...question }), question);
  }

  private take(reply: FunctionReply, question: FunctionQuestion): void {
    this.reply = reply;
    this.form.error.textContent = "";
    const last = Math.max(0, reply.iterations.length - 1);
    this.slider.max = String(last);
    if (question.iteration === this.iteration) this.iteration = Math.min(this.iteration, last);
    this.slider.value = String(this.iteration);
    this.draw();
  }

  private fail(why: string): void {
    this.stop();
    this.form.error.textContent = this.store.source.live ? why : `A recorded run cannot compute: ${why}`;
  }

  private goTo(iteration: number): void {
    const last = Math.max(0, (this.reply?.iterations.length ?? 1) - 1);
    this.iteration = Math.min(last, Math.max(0, iteration));
    this.slider.value = String(this.iteration);
    this.ask();
  }

  private togglePlay(): void {
    if (this.timer !== null) return this.stop();
    if (this.iteration >= Number(this.slider.max)) this.goTo(0);
    this.playButton.textContent = "❚❚ pause";
    this.timer = setInterval(() => {
      if (this.questions.busy) return;
      if (this.iteration >= Number(this.slider.max)) this.stop();
      else this.goTo(this.iteration + 1);
    }, kPlayEvery);
  }

  private stop(): void {
    if (this.timer !== null) clearInterval(this.timer);
    this.timer = null;
    this.playButton.textContent = "▶ play";
  }

  private drag(x: number, y: number, done: boolean): void {
    this.shows = "";
    this.stop();
    this.iteration = 0;
    this.form.setStart(x, y);
    if (done) this.view.redraw();
  }

  private nudge(dx: number, dy: number): void {
    const reply = this.reply;
    if (!reply) return;
    const [x, y] = this.form.start;
    this.drag(
      x + (dx * (reply.upper[0] - reply.lower[0])) / 100,
      y + (dy * (reply.upper[1] - reply.lower[1])) / 100,
      true,
    );
  }

  private retheme(): void {
    this.view.retheme();
    this.search.chart.retheme();
  }

  private draw(): void {
    const reply = this.reply;
    if (!reply) return;
    const content = this.content(reply);
    this.view.show(content);
    this.legend.replaceChildren(legendOf(this.signs));
    const row = reply.iterations[this.iteration];
    this.where.textContent = row ? `iteration ${this.iteration} of ${reply.iterations.length}` : "no iteration";
    const test = this.form.question(0, 2).settings["line_search.test"];
    this.search.show(row ? { curve: reply.curve, trials: reply.trials, test: String(test) } : null);
    this.about.textContent = this.shows;
    this.words.textContent = [sentence(reply.text), this.cutText()].filter((text) => text !== "").join(" ");
    this.words.dataset.kind = reply.status === "converged" || reply.status === "round_off" ? "" : "bad";
  }

  private cutText(): string {
    const cut = this.view.cutAbove;
    return cut === null ? "" : `Walls above f = ${short(cut, 3)} are cut off.`;
  }

  private content(reply: FunctionReply): SurfaceContent {
    const grid: Grid = {
      x: uniform(reply.lower[0], reply.upper[0], reply.samples),
      y: uniform(reply.lower[1], reply.upper[1], reply.samples),
      value: reply.value,
    };
    const showModel = this.model.input.checked && reply.iterations.length > 0;
    const from = reply.path[this.iteration];
    const to = reply.path[this.iteration + 1];
    const marks: Mark[] = [];
    this.signs = [{ sign: "▇", colour: "series3", text: `f = ${reply.formula}` }];
    this.addTrials(reply, marks);
    if (showModel) this.addModel(reply, grid, marks);
    if (reply.minimizer) {
      marks.push({
        x: reply.minimizer[0],
        y: reply.minimizer[1],
        value: null,
        shape: "cross",
        colour: "good",
        size: 11,
        label: "minimum",
      });
      this.signs.push({ sign: "✕", colour: "good", text: "the minimum of f" });
    }
    if (from) marks.push({ x: from.x, y: from.y, value: from.value, shape: "dot", colour: "accent", size: 12 });
    if (to) marks.push({ x: to.x, y: to.y, value: to.value, shape: "dot", colour: "good", size: 12 });
    const [x, y] = this.form.start;
    marks.push({ x, y, value: null, shape: "ring", colour: "bad", size: 13, label: "start: drag me" });
    this.signs.push(
      { sign: "●", colour: "accent", text: "this iteration begins here" },
      { sign: "●", colour: "good", text: "and ends here" },
    );
    this.signs.push({ sign: "•─", colour: "text", text: "iterates so far" });
    return {
      label: `f = ${reply.formula}, with the path of ${plural(reply.iterations.length, "iteration")}`,
      grid,
      axes: { x: "x", y: "y", value: "f" },
      model: showModel
        ? grid.value.map((_, k) =>
            quadraticAt(reply.model, grid.x[k % reply.samples]!, grid.y[Math.floor(k / reply.samples)]!),
          )
        : null,
      path: reply.path.slice(0, this.timer === null && this.iteration === 0 ? undefined : this.iteration + 2),
      draped: true,
      direction: null,
      marks,
      keep: [from?.value ?? null],
      log: this.log.input.checked,
    };
  }

  private addTrials(reply: FunctionReply, marks: Mark[]): void {
    const from = reply.path[this.iteration];
    const to = reply.path[this.iteration + 1];
    const alpha = reply.iterations[this.iteration]?.alpha ?? 0;
    if (!from || !to || !(alpha > 0)) return;
    const rejected = reply.trials.filter((trial) => !trial.accepted);
    for (const trial of rejected) {
      const f = trial.alpha / alpha;
      marks.push({
        x: from.x + f * (to.x - from.x),
        y: from.y + f * (to.y - from.y),
        value: trial.value,
        shape: "cross",
        colour: "bad",
        size: 10,
      });
    }
    if (rejected.length > 0)
      this.signs.push({ sign: "✕", colour: "bad", text: plural(rejected.length, "rejected trial") });
  }

  private addModel(reply: FunctionReply, grid: Grid, marks: Mark[]): void {
    this.signs.push({ sign: "▇", colour: "series2", text: "this iteration's quadratic model" });
    const lowest = minimizerOf(reply.model);
    if (!lowest) return void this.signs.push({ sign: "◆", colour: "series2", text: "the model has no minimum" });
    marks.push({
      ...lowest,
      value: quadraticAt(reply.model, lowest.x, lowest.y),
      shape: "diamond",
      colour: "series2",
      size: 12,
    });
    const place = isInside(grid, lowest) ? "" : `, outside at (${short(lowest.x, 3)}, ${short(lowest.y, 3)})`;
    this.signs.push({ sign: "◆", colour: "series2", text: `the model's minimum${place}` });
  }

  private savePng(): void {
    const name = this.form.question(0, 2).name;
    const picture =
      this.reply &&
      this.view.picture(
        `f = ${this.reply.formula}: iteration ${this.iteration} of ${this.reply.iterations.length}`,
        this.signs,
      );
    if (picture) downloadCanvas(fileName(name, this.iteration) + ".png", picture);
  }

  private restore(saved: unknown): void {
    const kept = saved as Partial<FunctionQuestion> | null;
    const start = kept?.start;
    if (typeof kept?.name !== "string" || !Array.isArray(start) || !start.every(Number.isFinite) || start.length !== 2)
      return;
    this.form.fill({
      name: kept.name,
      start,
      settings: typeof kept.settings === "object" && kept.settings !== null ? kept.settings : {},
    });
    if (this.visible) this.formChanged();
    else this.asked = false;
  }
}

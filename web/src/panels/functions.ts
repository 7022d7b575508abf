// Functions of two variables, minimized by the methods of the simulation: the lecture's surfaces, from any initial
// point.
import { button, downloadCanvas, element, messageOf } from "../dom";
import { Newest } from "../newest";
import { fieldsOf, type Page, type Panel } from "../page";
import type { FunctionQuestion, FunctionReply } from "../protocol";
import type { Store } from "../store";
import { checkbox } from "../controls";
import { short } from "../numbers";
import { sentence } from "../names";
import { SearchChart } from "../plots/search";
import { SurfaceView } from "../plots/surface";
import { FunctionForm, kPresets, type Preset } from "./functionForm";
import { pictureOf } from "./functionPicture";

const kSamples = 81;
const kPlayEvery = 700; // [ms]
const kLabel = "Minimizing a function of two variables";

export class FunctionsPanel implements Panel {
  readonly name = "functions";
  readonly title = "Functions";
  readonly isTall = true; // a surface needs room
  readonly element = element("div", { class: "plot-panel", role: "group", "aria-label": kLabel });
  private readonly form = new FunctionForm(() => this.formChanged());
  private readonly view = new SurfaceView();
  private readonly search = new SearchChart("f");
  private readonly slider = element("input", { type: "range", min: "0", max: "0", value: "0", "aria-label": "Iteration" });
  private readonly where = element("strong");
  private readonly playButton = button({ text: "▶ play", title: "Play the iterations" }, () => this.togglePlay());
  private readonly model = checkbox("quadratic model", "Show the quadratic model of this iteration", true, () => this.draw());
  private readonly log = checkbox("log height", "Logarithmic heights above the lowest value of f here", false, () => this.draw());
  private readonly words = element("div", { class: "plot-note", role: "status" });
  private readonly about = element("div", { class: "plot-note" });
  private reply: FunctionReply | null = null;
  private iteration = 0;
  private shows = ""; // name of the preset shown
  private readonly questions = new Newest((question: FunctionQuestion) => this.send(question), (reason) => this.fail(messageOf(reason)));
  private asked = false; // whether a question was sent
  private timer: ReturnType<typeof setInterval> | null = null;

  constructor(
    private readonly store: Store,
    page: Page,
  ) {
    const presets = element("div", { class: "pair", role: "group", "aria-label": "Examples" });
    for (const preset of kPresets) presets.append(button({ text: preset.title, title: preset.shows }, () => this.openPreset(preset)));
    this.form.element.prepend(presets);
    const png = button({ text: "PNG", title: "Save the picture" }, () => this.savePng());
    const shown = [this.model.element, this.log.element];
    const walk = element("div", { class: "plot-bar" }, this.playButton, this.slider, this.where, ...shown, png, this.words);
    const chart = element("div", { class: "functions-chart" }, this.search.element);
    const right = element("div", { class: "functions-side" }, this.about, chart, this.view.legend);
    const fill = element("div", { class: "plot-fill" }, this.view.element);
    this.element.append(walk, element("div", { class: "plot-columns plot-fill" }, this.form.element, fill, right));
    this.slider.addEventListener("input", () => {
      this.stop();
      this.goTo(this.slider.valueAsNumber);
    });
    this.view.dragged = (at, done) => this.drag(at.x, at.y, done);
    this.view.nudged = (dx, dy) => this.nudge(dx, dy);
    page.keep("functions", {
      save: () => this.form.question(this.iteration, kSamples),
      restore: (saved) => this.restore(saved),
    });
  }

  show(visible: boolean): void {
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
    this.log.input.checked = false;
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
    const reply = await this.store.source.ask<FunctionReply>({ ask: "function", ...question });
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
    const [x, y] = [dx, dy].map((d, k) => this.form.start[k] + (d * (reply.upper[k] - reply.lower[k])) / 100);
    this.drag(x, y, true);
  }

  private draw(): void {
    const reply = this.reply;
    if (!reply) return;
    const { iteration } = this;
    const [model, log] = [this.model.input.checked, this.log.input.checked];
    const wholePath = this.timer === null && iteration === 0;
    this.view.show(pictureOf(reply, { iteration, wholePath, start: this.form.start, model, log }));
    const row = reply.iterations[iteration];
    this.where.textContent = row ? `iteration ${iteration} of ${reply.iterations.length}` : "no iteration";
    const test = this.form.question(0, 2).settings["line_search.test"];
    this.search.show(row ? { ...reply, test: String(test) } : null);
    this.about.textContent = this.shows;
    const cut = this.view.cutAbove;
    this.words.textContent = `${sentence(reply.text)}${cut === null ? "" : ` Walls above f = ${short(cut, 3)} are cut off.`}`;
    this.words.dataset.kind = reply.status === "converged" || reply.status === "round_off" ? "" : "bad";
  }

  private savePng(): void {
    const name = this.form.question(0, 2).name;
    const { reply, iteration } = this;
    const picture = reply && this.view.picture(`f = ${reply.formula}: iteration ${iteration} of ${reply.iterations.length}`);
    if (picture) void downloadCanvas(`${name}_${this.iteration}`, picture);
  }

  private restore(saved: unknown): void {
    const kept = saved as Partial<FunctionQuestion> | null;
    const start = kept?.start;
    if (typeof kept?.name !== "string" || !Array.isArray(start) || !start.every(Number.isFinite) || start.length !== 2)
      return;
    this.form.fill({ name: kept.name, start, settings: fieldsOf(kept.settings) as FunctionQuestion["settings"] });
    if (this.element.isConnected) this.formChanged();
    else this.asked = false;
  }
}

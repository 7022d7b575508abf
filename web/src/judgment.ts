// Judges the page of the lecture in the page: the measures of `aspic lecture`, computed by the engine of this page.
import { button, element, messageOf } from "./dom";
import { hasEngine, type Judging, judgeLesson } from "./engine";
import { short } from "./plots/numbers";
import type { Judgment, Measure } from "./protocol";

// JSON has no infinity.
const numberOf = (value: number | string): number => (typeof value === "string" ? Number(value.replace("inf", "Infinity")) : value);

function row(measure: Measure): HTMLElement {
  const { what, value, unit, relation, bound, holds, reason } = measure;
  const judged = relation === undefined ? "" : holds ? "pass" : "fail";
  const limit = relation === undefined ? "" : `${relation} ${short(numberOf(bound!))}`;
  const cells = [what, `${short(numberOf(value))} ${unit}`.trim(), limit].map((text) => element("td", {}, text));
  return element("tr", { title: reason }, ...cells, element("td", {}, element("span", { class: judged }, judged)));
}

function resultElements({ passes, seconds, measures, remarks }: Judgment): HTMLElement[] {
  const head = element("tr", {}, ...["measured", "value", "bound", ""].map((text) => element("th", {}, text)));
  const verdict = passes ? "pass" : "fail";
  return [
    element("p", {}, element("span", { class: verdict }, verdict), ` ${seconds.toFixed(1)} s`),
    element("div", { class: "measures" }, element("table", {}, head, ...measures.map(row))),
    ...remarks.map((remark) => element("p", { class: "faint" }, remark)),
  ];
}

// Runs at most one judgment.
export class Judge {
  readonly root = element("div", { class: "judgment" });
  private running: Judging | null = null;

  // Offers to judge the lesson; nothing in a page without an engine.
  show(lesson: string): void {
    this.running?.stop();
    this.running = null;
    const title = "Runs the computation of aspic lecture in this page and compares its numbers with their bounds";
    const start = button({ text: "Judge this page by numbers", title }, () => void this.run(lesson));
    this.root.replaceChildren(...(hasEngine() ? [start] : []));
  }

  private async run(lesson: string): Promise<void> {
    const judging = judgeLesson(lesson);
    this.running = judging;
    const stop = button({ text: "Stop" }, () => this.show(lesson));
    this.root.replaceChildren(element("p", { class: "faint" }, "Computing in the background; this may take a minute. ", stop));
    const result = await judging.result.then(resultElements, (reason: unknown) => [element("p", { class: "error" }, messageOf(reason))]);
    if (this.running === judging) this.root.replaceChildren(...result);
  }
}

// Judges the page of the lecture in the page: the measures of `aspic lecture`, computed by the engine of this page.
import { button, element, messageOf } from "./dom";
import { hasEngine, type Judging, judgeLesson } from "./engine";
import { short } from "./numbers";
import type { Judgment, Measure } from "./protocol";

// JSON has no infinity.
const numberOf = (value: number | string): number => (typeof value === "string" ? Number(value.replace("inf", "Infinity")) : value);

function item({ what, value, unit, relation, bound, holds, reason }: Measure): HTMLElement {
  const mark = relation === undefined ? "" : holds ? "pass" : "fail";
  const limit = relation === undefined ? "" : ` (${relation} ${short(numberOf(bound!))})`;
  const text = `${what}: ${`${short(numberOf(value))} ${unit}`.trim()}${limit}`;
  return element("li", {}, element("span", { class: mark }, mark), ` ${text}`, reason ? element("small", {}, reason) : null);
}

function resultElements({ passes, seconds, measures, remarks }: Judgment): HTMLElement[] {
  const verdict = passes ? "pass" : "fail";
  return [
    element("p", {}, element("b", { class: verdict }, verdict), ` in ${seconds.toFixed(1)} s`),
    element("ul", {}, ...measures.map(item)),
    ...remarks.map((remark) => element("p", { class: "faint" }, remark)),
  ];
}

// Runs at most one judgment.
export class Judge {
  readonly root = element("div", { class: "judgment" });
  private running: Judging | null = null;

  // Offers to judge the lesson; a page without an engine names the command that does.
  show(lesson: string): void {
    this.running?.stop();
    this.running = null;
    const title = "Runs the computation of aspic lecture in this page and compares its numbers with their bounds";
    const start = button({ text: "Check this page's claim", title }, () => void this.run(lesson));
    const command = `aspic lecture ${Number.parseInt(lesson, 10)}`;
    this.root.replaceChildren(hasEngine() ? start : element("p", { class: "faint" }, "Check this page's claim: ", element("code", {}, command)));
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

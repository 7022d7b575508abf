// The exercise of a page of the lecture: an editor, a check, hints one by one, and the solution after some tries.
import "./exercises.css";
import { button, element, fileName, saveFile } from "../dom";
import { formulaElements } from "../formulas";
import type { Store } from "../store";
import { recall, remember } from "../storage";
import { casesError } from "./cases";
import { check, type Verdict } from "./check";
import { makeEditor } from "./editor";
import { type Exercise, exercises } from "./exercises";
import { keepProgress, type Progress, progressFile, progressOf } from "./progress";

const kTriesBeforeSolution = 3;

export class ExercisePanel {
  readonly root = element("details", { class: "exercise", hidden: true });
  private readonly summary = element("summary");
  private readonly text = element("div");
  private readonly editor = makeEditor("Code of the exercise", () => this.keep({ code: this.editor.field.value }));
  private readonly checker = button({ text: "Check" }, () => void this.check());
  private readonly hinter = button({}, () => this.hint());
  private readonly solver = button({ text: "Show a solution" }, () => this.solve());
  private readonly verdict = element("p", { role: "status" });
  private readonly hints = element("ol");
  private readonly solution = element("pre", { class: "solution", hidden: true });
  private readonly name = element("input", { type: "text", autocomplete: "name", "aria-label": "Your name", placeholder: "Your name" });
  private exercise: Exercise | null = null;
  private progress: Progress = { passing: "", tries: 0, hints: 0, solution: false, code: "" };

  constructor(private readonly store: Store) {
    this.checker.classList.add("primary");
    this.name.value = recall("exercise_name") ?? "";
    this.name.addEventListener("change", () => remember("exercise_name", this.name.value));
    const restart = button({ text: "Start again", title: "Restore the code as it was at first" }, () => this.restart());
    const save = button({ text: "Save my results", title: "A JSON file with your name, code and results of all exercises" }, () => this.save());
    const bar = element("div", { class: "pair" }, this.checker, this.hinter, this.solver, restart);
    this.root.append(this.summary, this.text, this.editor.element, bar, this.verdict, this.hints, this.solution, element("div", { class: "pair" }, this.name, save));
  }

  // Shows the exercise of a lesson, if it has one.
  show(lesson: string): void {
    this.exercise = exercises.find((exercise) => lesson.startsWith(exercise.lesson)) ?? null;
    this.root.hidden = this.exercise === null;
    this.root.open = false;
    if (!this.exercise) return;
    this.progress = progressOf(this.exercise);
    this.text.replaceChildren(element("p", {}, this.exercise.text), ...formulaElements(this.exercise.formula));
    this.editor.show(this.progress.code);
    this.hints.replaceChildren();
    this.solution.hidden = true;
    this.report({ passed: this.progress.passing !== "", text: "" });
    this.refresh();
  }

  private refresh(): void {
    const { title, hints } = this.exercise!;
    const left = hints.length - this.hints.childElementCount;
    this.summary.textContent = `Exercise: ${title}${this.progress.passing ? " ✓" : ""}`;
    this.hinter.textContent = `Hint (${left} left)`;
    this.hinter.disabled = left === 0;
    this.solver.hidden = this.progress.tries < kTriesBeforeSolution || !this.solution.hidden;
  }

  private keep(part: Partial<Progress>): void {
    this.progress = { ...this.progress, ...part };
    keepProgress(this.exercise!, this.progress);
  }

  private report({ passed, text }: Verdict): void {
    this.verdict.textContent = text;
    this.verdict.className = passed ? "pass" : "problem";
  }

  private async check(): Promise<void> {
    const exercise = this.exercise!;
    const code = this.editor.field.value;
    this.checker.disabled = true;
    this.report({ passed: true, text: "Checking ..." });
    const verdict = await this.verdictOn(exercise, code);
    this.checker.disabled = false;
    if (exercise !== this.exercise) return;
    this.progress = progressOf(exercise);
    this.report(verdict);
    this.refresh();
  }

  private async verdictOn(exercise: Exercise, code: string): Promise<Verdict> {
    try {
      const cases = await exercise.cases(this.store);
      const verdict = await check(code, exercise.entry, cases);
      const before = progressOf(exercise); // with what was written meanwhile
      keepProgress(exercise, { ...before, passing: verdict.passed ? code : before.passing, tries: before.tries + (verdict.isTry ? 1 : 0) });
      return verdict;
    } catch (reason) {
      return { passed: false, text: casesError(reason) };
    }
  }

  private hint(): void {
    this.hints.append(element("li", {}, this.exercise!.hints[this.hints.childElementCount]!));
    this.keep({ hints: Math.max(this.progress.hints, this.hints.childElementCount) });
    this.refresh();
  }

  private solve(): void {
    this.solution.textContent = this.exercise!.solution;
    this.solution.hidden = false;
    this.keep({ solution: true });
    this.refresh();
  }

  private restart(): void {
    this.editor.show(this.exercise!.code);
    this.keep({ code: this.exercise!.code });
  }

  private save(): void {
    const name = this.name.value.trim();
    if (name === "") {
      this.name.focus();
      return this.report({ passed: false, text: "Write your name first: the file is for your lecturer." });
    }
    const text = progressFile(name, exercises);
    saveFile(fileName(`exercises_${name}`, "json"), new Blob([text], { type: "application/json" }));
  }
}

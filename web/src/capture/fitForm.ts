// The fit: starts it, shows its convergence, compares it with the truth, and simulates it.
import { button, element } from "../dom";
import type { Page } from "../page";
import { checkbox } from "../controls";
import { short, withUnit } from "../plots/numbers";
import type { Capture, CaptureFit, Command } from "../protocol";
import type { Store } from "../store";

const kFields = [
  ["young", "Show true stiffness"],
  ["fitted_young", "Show fitted stiffness"],
  ["fit_error", "Show error"],
  ["young_deviation", "Show standard deviation"],
] as const;

// One-line summary of the fit.
export function fitText(fit: CaptureFit | null): string {
  if (!fit) return "";
  if (fit.failure !== "") return `The fit failed: ${fit.failure}`;
  const last = fit.iterations.at(-1);
  const where = last ? `iteration ${last.index}, residuals of ${short(last.chi, 2)} standard deviations` : "";
  if (fit.running) return [fit.stage, where].filter((text) => text !== "").join(": ");
  return last ? `Done: ${where}` : "";
}

// Error as a readable factor: 0.1 is "10 %", 0.7 "a factor of 2.0".
export function errorText(log: number): string {
  return log < 0.3 ? `${short(100 * (Math.exp(log) - 1), 2)} %` : `a factor of ${short(Math.exp(log), 2)}`;
}

export class FitForm {
  readonly element = element("section", { class: "capture-fit", "aria-label": "Fit" });
  private readonly begin = button({ text: "Fit the stiffness", title: "Fit Young's modulus of every tet to the recorded cases, in the background", steers: true }, () => this.send({ do: "fit" }));
  private readonly end = button({ text: "Stop", title: "Stop the fit and keep its result", steers: true }, () => this.send({ do: "stop_fit" }));
  private readonly simulate = button({ text: "Simulate it", title: "Simulate the fitted body beside the true one, with the same probe and mouse", steers: true }, () => this.send({ do: "simulate_fit" }));
  private readonly status = element("p", { class: "capture-status", role: "status" });
  private readonly result = element("p", { class: "capture-result" });
  private readonly bar = element("progress", { max: "1", value: "0", "aria-label": "Progress of the fit" });
  private readonly sameMesh = checkbox("Fit on the measured mesh", "Inverse crime: results are sharper than those of a real measurement. Without it, the discretization error of the coarser mesh hides details. Delete the recorded cases to change it", true, (on) =>
    this.send({ do: "bench", same_mesh: on }),
  );
  private readonly colors = element("div", { class: "capture-row", role: "group", "aria-label": "Colors of the body" });
  private readonly note = element("div", { class: "faint capture-note" });

  constructor(
    private readonly store: Store,
    private readonly page: Page,
  ) {
    for (const [field, words] of kFields) {
      const choose = button({ text: words, title: `Color the body: ${field === "young_deviation" ? "standard deviation of every tet" : words.replace("Show ", "")}`, steers: true }, () => this.send({ do: "color", field }));
      choose.dataset.field = field;
      this.colors.append(choose);
    }
    const buttons = element("div", { class: "capture-row" }, this.begin, this.end, this.simulate);
    this.element.append(element("h3", {}, "3  Fit"), buttons, this.sameMesh.element, this.bar, this.status, this.colors, this.result, this.note);
    store.on("scene", () => this.mark());
    this.show(null);
  }

  show(capture: Capture | null): void {
    const fit = capture?.fit ?? null;
    const steers = this.store.steers;
    this.begin.disabled = !steers || !capture || capture.cases.length === 0 || fit?.running === true;
    this.end.disabled = !steers || fit?.running !== true;
    this.simulate.disabled = !steers || fit?.has_material !== true || fit.running;
    this.bar.hidden = fit?.running !== true;
    if (fit) this.progress(fit);
    this.status.textContent = fitText(fit) || capture?.words || "";
    this.status.classList.toggle("plot-error", (fit?.failure ?? "") !== "");
    const known = fit?.error !== null && fit?.error !== undefined;
    this.result.textContent = known
      ? `E from ${withUnit(fit.softest, "Pa", 2)} to ${withUnit(fit.stiffest, "Pa", 2)}; mean error ${errorText(fit.error!)}.`
      : "";
    this.sameMesh.input.disabled = !steers || (capture?.cases.length ?? 0) > 0;
    if (capture && capture.tets > 0) this.sameMesh.input.checked = capture.same_mesh;
    const notes = [...meshNote(capture), ...(fit && !fit.running ? [...(fit.next ? [`Next poke: ${fit.next.words}`] : []), ...fit.warnings] : [])];
    if (this.note.textContent !== notes.join("")) this.note.replaceChildren(...notes.map((text) => element("p", {}, `${text[0]!.toUpperCase()}${text.slice(1)}`)));
    this.mark();
  }

  // Progress from the first chi to 1, on a logarithmic scale.
  private progress({ iterations }: CaptureFit): void {
    const [first, last] = [iterations[0]?.chi, iterations.at(-1)?.chi];
    if (!first || !last || first <= 1) return this.bar.removeAttribute("value");
    this.bar.value = Math.min(1, Math.max(0, 1 - Math.log(last) / Math.log(first)));
  }

  private mark(): void {
    const scene = this.store.side("a")?.scene;
    for (const choose of this.colors.querySelectorAll("button")) {
      choose.hidden = !scene?.fields.some(({ name }) => name === choose.dataset.field);
      choose.setAttribute("aria-pressed", String(scene?.field === choose.dataset.field));
    }
  }

  private send(command: Command): void {
    this.store.source.request(command).catch(this.page.report);
  }
}

function meshNote(capture: Capture | null): string[] {
  if (!capture || capture.tets === 0) return [];
  if (capture.same_mesh) return ["Inverse crime: the fit uses the mesh that was measured, so its error is too small. Simulate it on these tets, not on finer ones."];
  return [`Fitted on a coarser mesh of ${capture.tets} tets than the measured one, to avoid an inverse crime. It is simulated on these tets, corrected for their discretization error.`];
}

// The estimate of the error of the mesh: its sentence, a button that computes it in a running program, and its color.
import { button, element } from "../dom";
import { plainText } from "../names";
import type { Page } from "../page";
import type { StepRow } from "../protocol";
import type { Store } from "../store";

const kField = "mesh_error";

// The last step with an estimate.
export function estimatedStep(steps: readonly StepRow[]): StepRow | null {
  return steps.filter((row) => row.mesh_error !== "").at(-1) ?? null;
}

export function meshErrorText(row: StepRow | null): string {
  if (!row) return "mesh: its error is not estimated";
  return `mesh: ${plainText(row.mesh_error).replace(/(\d) (?=%|m )/g, "$1\u00a0")} (step\u00a0${row.step})`;
}

// A recorded run without an estimate has no line.
export function makeMeshError(store: Store, page: Page): HTMLElement {
  const { source } = store;
  const text = element("span");
  const color = button({ text: "Show as color", title: "Color the surface by the density of the error" }, () => void toggle().catch(page.report));
  const estimate = button({ text: "Estimate", title: "Estimate the error of the mesh after the last step" }, () => void ask());
  const line = element("p", { class: "mesh-error" }, text, source.live ? estimate : null, color);
  const side = (): Store["sides"]["a"] => store.side("a");

  const toggle = async (): Promise<void> => {
    const row = estimatedStep(side()?.steps ?? []);
    const isShown = side()?.scene.field === kField;
    if (!source.live && row && !isShown) await source.request({ do: "rewind", step: row.step });
    await source.request({ do: "color", field: isShown ? "" : kField });
  };
  const ask = async (): Promise<void> => {
    estimate.disabled = true;
    await source.ask({ ask: "mesh_error", side: "a" }).catch(page.report);
    estimate.disabled = false;
  };
  const draw = (): void => {
    const row = estimatedStep(side()?.steps ?? []);
    text.textContent = meshErrorText(row);
    line.hidden = !row && !source.live;
    color.hidden = !side()?.scene.fields.some(({ name }) => name === kField);
    color.setAttribute("aria-pressed", String(side()?.scene.field === kField));
  };
  for (const event of ["steps", "scene"] as const) store.on(event, draw);
  draw();
  return line;
}

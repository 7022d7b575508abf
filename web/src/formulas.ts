// Formulas of the lecture's pages and of named functions; the build turns their TeX into MathML.
import { element } from "./dom";
import source from "./formulas.json";

const formulas: Record<string, string[]> = source;

// A lesson has the formulas of the demonstration with whose name its id begins.
export function formulasOf(id: string): string[] {
  const name = Object.keys(formulas).find((known) => id === known || id.startsWith(`${known}_`));
  return name ? formulas[name]! : [];
}

export function formulaElements(id: string): HTMLElement[] {
  return formulasOf(id).map((text) => {
    const shown = element("div", { class: "formula" });
    shown.innerHTML = text;
    return shown;
  });
}

// Formulas of the lecture and of named functions. The build converts their TeX to MathML.
import { element } from "./dom";
import source from "./formulas.json";

const formulas: Record<string, string[]> = source;

// Formulas of a lesson. Its id begins with the name of the demonstration that has them.
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

// Formulas of the lecture, of named functions and of materials. The build converts their TeX to MathML.
import { element } from "./dom";
import source from "./formulas.json";
import type { Setting } from "./protocol";

const formulas: Record<string, string[]> = source;
const kSymbols = "I₁ = tr FᵀF, J = det F, K: bulk modulus; μ and λ: Lamé constants of E and ν";

// Formulas of a lesson. Its id begins with the name of the demonstration that has them.
export function formulasOf(id: string): string[] {
  const name = Object.keys(formulas).find((known) => id === known || id.startsWith(`${known}_`));
  return name ? formulas[name]! : [];
}

function elements(list: string[], title?: string): HTMLElement[] {
  return list.map((text) => {
    const shown = element("div", { class: "formula", title });
    shown.innerHTML = text;
    return shown;
  });
}

export function formulaElements(id: string): HTMLElement[] {
  return elements(formulasOf(id));
}

export function materialModel(settings: Setting[]): string {
  return String(settings.find(({ key }) => key === "material.model")?.value ?? "");
}

// Strain energy density of a material model.
export function materialFormulas(model: string): HTMLElement[] {
  return elements(formulas[model] ?? [], kSymbols);
}

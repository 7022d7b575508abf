// Formulas of the lecture, of named functions, of materials and of integrators. The build converts their TeX to MathML.
import { element } from "./dom";
import source from "./formulas.json";
import type { Setting } from "./protocol";

const formulas: Record<string, string[]> = source;

// Settings whose choices have formulas: what they are, and their symbols.
export const kWithFormulas: Record<string, { title: string; symbols: string }> = {
  "material.model": {
    title: "Strain energy density",
    symbols: "I₁ = tr FᵀF, J = det F, K: bulk modulus; μ and λ: Lamé constants of E and ν",
  },
  "time.integrator": {
    title: "Update rule",
    symbols: "h: time step, v: velocity, a: acceleration, M a = −∂V/∂q − C v with the damping C",
  },
};

// Formulas of a lesson. Its id begins with the name of the demonstration that has them.
export function formulasOf(id: string): string[] {
  const name = Object.keys(formulas).find((known) => id === known || id.startsWith(`${known}_`));
  return name ? formulas[name]! : [];
}

// Shrinks a formula that is wider than its place; below kSmallest it scrolls.
const kSmallest = 0.65;
function fit(shown: HTMLElement): void {
  shown.style.fontSize = "";
  const scale = shown.clientWidth / shown.scrollWidth;
  if (scale < 1) shown.style.fontSize = `${Math.max(kSmallest, 0.99 * scale)}em`;
}

function elements(list: string[], title?: string): HTMLElement[] {
  const resized = new ResizeObserver((entries) => entries.forEach(({ target }) => fit(target as HTMLElement)));
  return list.map((text) => {
    const shown = element("div", { class: "formula", title });
    shown.innerHTML = text;
    resized.observe(shown);
    return shown;
  });
}

export function formulaElements(id: string): HTMLElement[] {
  return elements(formulasOf(id));
}

export function chosen(settings: Setting[], key: string): string {
  return String(settings.find((setting) => setting.key === key)?.value ?? "");
}

// Formulas of the chosen value of a setting in kWithFormulas.
export function choiceFormulas(settings: Setting[], key: string): HTMLElement[] {
  return elements(formulas[chosen(settings, key)] ?? [], kWithFormulas[key]?.symbols);
}

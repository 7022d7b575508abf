// Builders of the plots' controls.
import { element, fileName, saveFile } from "../dom";

export { element, fileName, saveFile };

export function button(text: string, title: string, click: () => void): HTMLButtonElement {
  const made = element("button", { type: "button", title, class: "plot-button" }, text);
  made.addEventListener("click", click);
  return made;
}

// An input with its label.
export interface Field {
  element: HTMLLabelElement;
  input: HTMLInputElement;
}

export function checkbox(text: string, title: string, on: boolean, change: (on: boolean) => void): Field {
  const input = element("input", { type: "checkbox" });
  input.checked = on;
  input.addEventListener("change", () => change(input.checked));
  return { element: element("label", { class: "plot-field", title }, input, " " + text), input };
}

export interface Choice {
  element: HTMLLabelElement;
  select: HTMLSelectElement;
}

export function choice(
  text: string,
  title: string,
  options: readonly (readonly [value: string, text: string])[],
  value: string,
  change: (value: string) => void,
): Choice {
  const select = element("select", { "aria-label": text || title });
  for (const [name, shown] of options) select.append(element("option", { value: name }, shown));
  select.value = value;
  select.addEventListener("change", () => change(select.value));
  return { element: element("label", { class: "plot-field", title }, ...(text ? [text + " "] : []), select), select };
}

// `change` receives only finite numbers.
export function numberField(
  text: string,
  title: string,
  value: number,
  limits: { min?: number; max?: number; step?: number | "any" },
  change: (value: number) => void,
): Field {
  const input = element("input", { type: "number", "aria-label": text || title, step: String(limits.step ?? "any") });
  if (limits.min !== undefined) input.min = String(limits.min);
  if (limits.max !== undefined) input.max = String(limits.max);
  input.value = String(value);
  input.addEventListener("change", () => {
    if (input.value.trim() !== "" && Number.isFinite(input.valueAsNumber) && input.checkValidity())
      change(input.valueAsNumber);
  });
  return { element: element("label", { class: "plot-field", title }, text + " ", input), input };
}

export function downloadCanvas(name: string, canvas: HTMLCanvasElement): void {
  canvas.toBlob((blob) => blob && saveFile(name, blob), "image/png");
}

// Returns a function that calls `draw` at most once per frame.
export function oncePerFrame(draw: () => void): () => void {
  let asked = false;
  return () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      draw();
    });
  };
}

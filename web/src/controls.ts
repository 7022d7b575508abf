// Controls with a label, and redrawing once per frame.
import { element, selectOf } from "./dom";

export function checkbox(text: string, title: string, on: boolean, change: (on: boolean) => void) {
  const input = element("input", { type: "checkbox" });
  input.checked = on;
  input.addEventListener("change", () => change(input.checked));
  return { element: element("label", { class: "plot-field", title }, input, " " + text), input };
}

export function choice(
  text: string,
  title: string,
  options: readonly (readonly [value: string, text: string])[],
  value: string,
  change: (value: string) => void,
) {
  const select = selectOf(options);
  select.setAttribute("aria-label", text || title);
  select.value = value;
  select.addEventListener("change", () => change(select.value));
  return { element: element("label", { class: "plot-field", title }, text ? `${text} ` : null, select), select };
}

// `change` receives only finite numbers within the limits.
export function numberField(
  text: string,
  title: string,
  value: number,
  limits: { min?: number; max?: number; step?: number },
  change: (value: number) => void,
) {
  const bounds = Object.fromEntries(Object.entries({ step: "any", ...limits }).map(([name, limit]) => [name, String(limit)]));
  const input = element("input", { type: "number", "aria-label": text || title, ...bounds });
  input.value = String(value);
  input.addEventListener("change", () => {
    if (Number.isFinite(input.valueAsNumber) && input.checkValidity()) change(input.valueAsNumber);
  });
  // Shows a value from the program unless the reader is changing it.
  const show = (shown: string): void => {
    if (document.activeElement !== input) input.value = shown;
  };
  return { element: element("label", { class: "plot-field", title }, text + " ", input), input, show };
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

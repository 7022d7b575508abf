// First words to a reader who opens a simulation: they go with the first touch or key.
import { element } from "./dom";

export function makeInvitation(): HTMLElement {
  const words = "Drag the body. Play starts the time, 1 iteration shows the minimization at work, and Lecture explains it page by page.";
  const shown = element("p", { class: "invitation" }, words);
  for (const event of ["pointerdown", "keydown"]) addEventListener(event, () => shown.remove(), { once: true, capture: true });
  return shown;
}

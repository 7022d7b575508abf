// A bar between two areas that resizes one of them, by mouse or arrow keys.
import { element } from "./dom";

export interface Resized {
  label: string;
  orientation: "horizontal" | "vertical"; // orientation of the bar
  size: () => number; // current size [px]
  limits: () => [number, number];
  resize: (size: number) => void;
}

const kKeyStep = 24; // [px]

// The resized area is below a horizontal bar, or to the right of a vertical one.
export function makeDivider(resized: Resized): HTMLElement {
  const bar = element("div", {
    class: `divider ${resized.orientation}`,
    role: "separator",
    tabindex: "0",
    "aria-label": resized.label,
    "aria-orientation": resized.orientation,
    title: `${resized.label}: drag, or use the arrow keys`,
  });
  const horizontal = resized.orientation === "horizontal";
  const set = (size: number): void => {
    const [smallest, largest] = resized.limits();
    const within = Math.round(Math.max(smallest, Math.min(largest, size)));
    resized.resize(within);
    bar.setAttribute("aria-valuemin", String(Math.round(smallest)));
    bar.setAttribute("aria-valuemax", String(Math.round(largest)));
    bar.setAttribute("aria-valuenow", String(within));
  };
  const at = (event: PointerEvent): number => (horizontal ? event.clientY : event.clientX);
  bar.addEventListener("pointerdown", (down) => {
    down.preventDefault();
    bar.setPointerCapture(down.pointerId);
    const start = resized.size() + at(down);
    const move = (event: PointerEvent): void => set(start - at(event));
    bar.addEventListener("pointermove", move);
    bar.addEventListener("lostpointercapture", () => bar.removeEventListener("pointermove", move), { once: true });
  });
  bar.addEventListener("keydown", (event) => {
    const larger = horizontal ? "ArrowUp" : "ArrowLeft";
    const smaller = horizontal ? "ArrowDown" : "ArrowRight";
    if (event.key !== larger && event.key !== smaller) return;
    event.preventDefault();
    set(resized.size() + (event.key === larger ? kKeyStep : -kKeyStep));
  });
  return bar;
}

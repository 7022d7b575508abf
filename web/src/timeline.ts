// Slider over the steps that the program still holds. Dragging it rewinds.
import { element } from "./dom";
import { Newest } from "./newest";
import type { Page } from "./page";
import type { State } from "./protocol";
import type { Store } from "./store";

export function placeText(state: State): string {
  const { step, time, iteration } = state.a;
  // The step under way has the next number, as in the other panels and the picture.
  const place = iteration < 0 ? `step ${step}` : `step ${step + 1}, iteration ${iteration}`;
  return `${place}, ${time.toFixed(3)} s`;
}

export function makeTimeline(store: Store, page: Page): HTMLElement {
  const slider = element("input", {
    type: "range",
    "aria-label": "Timeline: rewind to a step",
    title: "Rewind to a step (Left and Right while it has the focus)",
    "data-steers": store.source.live,
    step: "1",
    max: "0", // until the first state
  });
  const place = element("span", { class: "place" });
  const ends = element("span", { class: "faint ends" });
  const rewind = new Newest((step: number) => store.source.request({ do: "rewind", step }), page.report);
  slider.addEventListener("input", () => rewind.push(Number(slider.value)));

  store.on("state", (state) => {
    const { first, last } = state.a.timeline;
    place.textContent = placeText(state);
    ends.textContent = `steps ${first} to ${last}`;
    slider.min = String(first);
    slider.max = String(last);
    if (!slider.matches(":active") && !rewind.busy) slider.value = String(state.a.step);
    slider.setAttribute("aria-valuetext", placeText(state));
  });
  return element("div", { class: "timeline" }, slider, place, ends);
}

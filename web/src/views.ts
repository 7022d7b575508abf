// The views of one or two sides, with labels that distinguish them.
import { element } from "./dom";
import type { Page } from "./page";
import type { SideName } from "./protocol";
import type { Store } from "./store";
import type { Layers } from "./video";
import type { Display } from "./view/display";
import { View } from "./view/view";

interface Shown {
  view: View;
  frame: HTMLElement;
  label: HTMLElement;
}

export class Views {
  private readonly shown = new Map<SideName, Shown>();

  constructor(
    private readonly root: HTMLElement,
    private readonly store: Store,
    private readonly page: Page,
    private readonly display: Display,
  ) {
    store.on("scene", (side) => this.update(side));
    store.on("gone", (side) => this.remove(side));
  }

  all = (): View[] => [...this.shown.values()].map(({ view }) => view);

  // Draws now: the pixels of a canvas are valid until the current task ends.
  draw = (): Layers[] =>
    [...this.shown.values()].map(({ view, label }) => {
      view.drawNow();
      return { canvases: [...view.host.querySelectorAll("canvas")], label: label.textContent ?? "" };
    });

  private update(side: SideName): void {
    if (this.store.side(side) && !this.shown.has(side)) {
      this.shown.set(side, this.make(side));
      this.display.change({}); // comparisons have further colors
    }
    this.showLabels();
  }

  private showLabels(): void {
    const comparing = this.store.side("b") !== null;
    for (const [side, { label }] of this.shown) {
      label.textContent = comparing ? this.store.title(side) : "";
      label.hidden = !comparing;
    }
  }

  private make(side: SideName): Shown {
    const host = element("div", { role: "application", tabindex: "0", "aria-label": `Side ${side.toUpperCase()} in 3-D` });
    const label = element("div", { class: "view-label" });
    const frame = element("div", { class: "side" }, host, label);
    this.root.append(frame);
    return { view: new View(host, this.store, this.page, side, this.display), frame, label };
  }

  private remove(side: SideName): void {
    const shown = this.shown.get(side);
    shown?.view.dispose();
    shown?.frame.remove();
    this.shown.delete(side);
    this.display.change({});
    this.showLabels();
  }
}

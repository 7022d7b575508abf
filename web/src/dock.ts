// Panels below the view, one at a time, selected by tabs. When the dock is closed, as at first, only the tabs remain.
import { makeDivider } from "./divider";
import { button, element } from "./dom";
import { whenNarrow } from "./narrow";
import { fieldsOf, type Page, type Panel } from "./page";
import { keyName } from "./shortcuts";

const kKeys: Record<string, string> = { energy: "e", microscope: "m", landscape: "a", functions: "f", certificate: "q", bench: "k" };
const kSmallest = 120; // smallest height [px]
const kShare = 0.62; // largest part of the window's height; the mesh keeps the rest

export class Dock {
  private open: Panel | null = null;
  private last: Panel | null = null; // panel that the key opens again
  private height: number | null = null; // height chosen by the reader [px]; null: the default of the style sheet
  private readonly tabs = new Map<Panel, HTMLButtonElement>();
  private readonly list = element("div", { role: "tablist", "aria-label": "Plots" });
  private readonly body = element("div", { class: "dock-body" });
  private readonly close: HTMLButtonElement;

  constructor(
    private readonly root: HTMLElement,
    private readonly page: Page,
    private readonly panels: Panel[],
  ) {
    for (const panel of panels) this.list.append(this.makeTab(panel));
    this.close = button({ icon: "close", label: "Close the plots", title: "Close the plots (D)" }, () => this.show(null));
    const divider = makeDivider({
      label: "Height of the plots",
      orientation: "horizontal",
      size: () => root.offsetHeight,
      limits: () => [kSmallest, Math.max(kSmallest, innerHeight * kShare)],
      resize: (height) => {
        this.height = height;
        this.resize();
      },
    });
    root.append(divider, element("div", { class: "dock-tabs" }, this.list, this.close), this.body);
    this.list.addEventListener("keydown", (event) => this.moveBetweenTabs(event));
    addEventListener("resize", () => this.resize());
    page.on("panel", (name) => this.show(this.named(name)));
    page.shortcut({ key: "d", does: "Open or close the plots", group: "Panels", run: () => this.show(this.open ? null : this.last) });
    page.keep("dock", {
      save: () => ({ panel: this.open?.name ?? null, height: this.height }),
      restore: (saved) => this.restore(saved),
    });
    this.show(panels[0] ?? null);
    whenNarrow(true, (narrow) => this.show(narrow ? null : this.last));
  }

  // Adds a panel after the construction.
  add(panel: Panel): void {
    this.panels.push(panel);
    this.list.append(this.makeTab(panel));
    this.show(this.open);
  }

  show(panel: Panel | null): void {
    if (panel !== this.open) {
      this.open?.show(false);
      this.open = panel;
      this.last = panel ?? this.last;
      this.body.replaceChildren(...(panel ? [panel.element] : []));
    }
    for (const [other, tab] of this.tabs) {
      tab.setAttribute("aria-selected", String(other === panel));
      tab.tabIndex = other === (panel ?? this.panels[0]) ? 0 : -1;
    }
    this.close.hidden = panel === null;
    this.resize();
    panel?.show(true);
  }

  private named(name: string): Panel | null {
    return this.panels.find((panel) => panel.name === name) ?? this.open;
  }

  private resize(): void {
    const largest = Math.round(innerHeight * kShare);
    const chosen = this.height === null ? "" : `${Math.max(kSmallest, Math.min(this.height, largest))}px`;
    this.root.classList.toggle("closed", this.open === null);
    this.root.classList.toggle("tall", this.open?.isTall ?? false);
    this.root.style.height = this.open === null ? "auto" : chosen;
  }

  private makeTab(panel: Panel): HTMLElement {
    const key = kKeys[panel.name];
    panel.element.setAttribute("role", "tabpanel");
    panel.element.setAttribute("aria-label", panel.title);
    const title = key ? `${panel.title} (${keyName(key)})` : panel.title;
    const tab = button({ text: panel.title, title }, () => this.show(panel));
    tab.setAttribute("role", "tab");
    this.tabs.set(panel, tab);
    if (key) {
      const run = (): void => this.show(this.open === panel ? null : panel);
      this.page.shortcut({ key, does: `${panel.title}: open or close`, group: "Panels", run });
    }
    return tab;
  }

  private moveBetweenTabs(event: KeyboardEvent): void {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (by === undefined) return;
    const count = this.panels.length;
    const focused = this.panels.findIndex((panel) => this.tabs.get(panel) === document.activeElement);
    const next = this.panels[(focused + by + count) % count];
    event.preventDefault();
    this.show(next);
    this.tabs.get(next)?.focus();
  }

  private restore(saved: unknown): void {
    const { panel, height } = fieldsOf(saved);
    if (typeof height === "number" && Number.isFinite(height)) this.height = height;
    else if (height === null) this.height = null;
    if (panel === null) this.show(null);
    else if (typeof panel === "string") this.show(this.named(panel));
  }
}

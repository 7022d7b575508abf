// Area of the settings: its width, and the key that hides it.
import { makeDivider } from "./divider";
import { element } from "./dom";
import { whenNarrow } from "./narrow";
import { fieldsOf, type Page } from "./page";
import { shortcutButton } from "./shortcuts";

const kNarrowest = 160; // smallest width [px]
const kBesideLecture = 1400; // least width of a window for both [px]
const kShare = 0.5; // largest part of the window's width

export class Sidebar {
  readonly body = element("div", { class: "settings" });
  readonly opener: HTMLButtonElement;

  constructor(
    private readonly root: HTMLElement,
    page: Page,
    isClosed: boolean, // at first
  ) {
    const divider = makeDivider({
      label: "Width of the settings",
      orientation: "vertical",
      size: () => root.offsetWidth,
      limits: () => [kNarrowest, innerWidth * kShare],
      resize: (width) => this.resize(width),
    });
    root.append(divider, this.body);
    const shortcut = { key: "g", does: "Settings", group: "Panels", run: () => this.hide(!root.hidden) } as const;
    this.opener = shortcutButton(page, shortcut, { text: "Settings" });
    whenNarrow(isClosed, (narrow) => this.hide(narrow));
    page.on("lesson", () => innerWidth < kBesideLecture && this.hide(true));
    page.keep("settings", {
      save: () => ({ hidden: root.hidden, width: root.offsetWidth }),
      restore: (saved) => this.restore(saved),
    });
  }

  private hide(hidden: boolean): void {
    this.root.hidden = hidden;
    this.opener.setAttribute("aria-expanded", String(!hidden));
  }

  private resize(width: number): void {
    document.body.style.setProperty("--right-width", `${width}px`);
  }

  private restore(saved: unknown): void {
    const { hidden, width } = fieldsOf(saved);
    if (typeof width === "number" && width >= kNarrowest && width <= innerWidth * kShare) this.resize(width);
    if (typeof hidden === "boolean") this.hide(hidden);
  }
}

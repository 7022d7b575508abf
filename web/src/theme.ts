// Light or dark, and font size: the reader's choice, otherwise the system's.
import { fieldsOf, type Page } from "./page";
import { recall, remember } from "./storage";

export type ThemeName = "light" | "dark";
const kSmallest = 10; // smallest font size [px]
const kNormal = 14;
const kLargest = 28;

// Calls back when the theme or the font size has changed.
export function onLook(run: () => void, signal?: AbortSignal): void {
  const observer = new MutationObserver(run);
  observer.observe(document.documentElement, { attributeFilter: ["data-theme", "style"] });
  signal?.addEventListener("abort", () => observer.disconnect());
}

export class Theme {
  private fontSize = kNormal;

  constructor(page: Page) {
    const system = matchMedia("(prefers-color-scheme: dark)");
    const chosen = recall("theme");
    this.show(chosen === "light" || chosen === "dark" ? chosen : system.matches ? "dark" : "light");
    system.addEventListener("change", () => recall("theme") ?? this.show(system.matches ? "dark" : "light"));
    this.setFontSize(Number(recall("font") ?? kNormal));
    page.keep("theme", {
      save: () => ({ theme: this.name, font: this.fontSize }),
      restore: (saved) => this.restore(saved),
    });
    page.shortcut({ key: "t", does: "Light or dark", group: "Display", run: () => this.toggle() });
    page.shortcut({ key: ">", does: "Larger letters", group: "Display", run: () => this.scale(1) });
    page.shortcut({ key: "<", does: "Smaller letters", group: "Display", run: () => this.scale(-1) });
  }

  get name(): ThemeName {
    return document.documentElement.dataset.theme === "dark" ? "dark" : "light";
  }

  toggle(): void {
    const name = this.name === "dark" ? "light" : "dark";
    remember("theme", name);
    this.show(name);
  }

  scale(steps: number): void {
    this.setFontSize(this.fontSize + 2 * steps);
    remember("font", String(this.fontSize));
  }

  private show(name: ThemeName): void {
    document.documentElement.dataset.theme = name;
  }

  private setFontSize(pixels: number): void {
    this.fontSize = Number.isFinite(pixels) ? Math.min(kLargest, Math.max(kSmallest, pixels)) : kNormal;
    document.documentElement.style.setProperty("--font", `${this.fontSize}px`);
  }

  private restore(saved: unknown): void {
    const { theme, font } = fieldsOf(saved);
    if (theme === "light" || theme === "dark") this.show(theme);
    if (typeof font === "number") this.setFontSize(font);
  }
}

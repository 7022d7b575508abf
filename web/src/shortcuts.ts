// Keyboard shortcuts of the page, and their list on the screen.
import { button, element, openDialog, type ButtonOptions } from "./dom";
import type { Page, Shortcut } from "./page";

export function keyName(key: string): string {
  if (key === " ") return "Space";
  return /^[a-z]$/.test(key) ? key.toUpperCase() : key.replace("Arrow", "");
}

// Name of a key press in the registry. It includes Shift for letters and for keys without a character; other characters
// already depend on it.
export function pressedKey(event: Pick<KeyboardEvent, "key" | "shiftKey">): string {
  const { key } = event;
  if (/^[a-z]$/i.test(key)) return event.shiftKey ? `Shift+${key.toUpperCase()}` : key.toLowerCase();
  return event.shiftKey && key.length > 1 ? `Shift+${key}` : key;
}

function takesText(target: Element): boolean {
  if (target instanceof HTMLElement && target.isContentEditable) return true;
  return target.matches("textarea, select, input:not([type=range], [type=checkbox], [type=radio], [type=button])");
}

// Keys that move or press the focused control.
function belongsToControl(key: string, target: Element): boolean {
  if (key === " " || key === "Enter") return target.matches("button, a, summary, [role=tab], input:not([type=range])");
  return /^(Arrow|Page)|^(Home|End)$/.test(key) && target !== document.body && !target.closest("#views");
}

function press(page: Page, event: KeyboardEvent): void {
  const altGraph = event.getModifierState("AltGraph");
  if (event.metaKey || ((event.ctrlKey || event.altKey) && !altGraph)) return;
  if (document.querySelector("dialog[open]")) return;
  const target = event.target instanceof Element ? event.target : document.body;
  if (takesText(target) || belongsToControl(event.key, target)) return;
  const shortcut = page.shortcuts.get(pressedKey(event));
  if (!shortcut) return;
  event.preventDefault();
  shortcut.run();
}

// Listens during capture: lil-gui's rows stop the propagation of keys, and a focused slider needs none of these.
export function listenToKeys(page: Page): void {
  addEventListener("keydown", (event) => press(page, event), { capture: true });
}

// A shortcut with a button, whose tooltip shows the key.
export function shortcutButton(page: Page, shortcut: Shortcut, options: ButtonOptions): HTMLButtonElement {
  page.shortcut(shortcut);
  const title = `${shortcut.does} (${keyName(shortcut.key)})`;
  // The shortcut of a disabled button has no effect.
  const made = button({ ...options, title }, shortcut.run);
  page.shortcuts.set(shortcut.key, { ...shortcut, run: () => made.disabled || shortcut.run() });
  made.setAttribute("aria-keyshortcuts", keyName(shortcut.key));
  if (!options.text && !options.label) made.setAttribute("aria-label", shortcut.does);
  return made;
}

export const kGroups: Shortcut["group"][] = ["Simulation", "Camera", "Display", "Panels", "File"];

export function openShortcutList(page: Page): void {
  const groups = kGroups.map((group) => {
    const rows = [...page.shortcuts.values()]
      .filter((shortcut) => shortcut.group === group)
      .map(({ key, does }) =>
        element("tr", {}, element("td", {}, element("kbd", {}, keyName(key))), element("td", {}, does)),
      );
    return rows.length === 0 ? null : element("section", {}, element("h3", {}, group), element("table", {}, ...rows));
  });
  openDialog("Keyboard shortcuts", [element("div", { class: "columns" }, ...groups)], "shortcuts");
}

// A button that opens a list of commands.
import { button, element } from "./dom";

let menus = 0;

export function makeMenu(text: string, title: string, items: HTMLButtonElement[]): HTMLElement {
  const id = `menu-${++menus}`;
  const list = element("div", { id, popover: "auto", role: "menu", class: "menu", "aria-label": title });
  const opener = button({ text: `${text} ▾`, title }, () => {});
  opener.setAttribute("popovertarget", id);
  opener.setAttribute("aria-haspopup", "menu");
  const enabled = (): HTMLButtonElement[] => items.filter((item) => !item.disabled && !item.hidden);
  for (const item of items) {
    item.setAttribute("role", "menuitem");
    item.addEventListener("click", () => list.hidePopover());
    list.append(item);
  }
  list.addEventListener("toggle", (event) => {
    if ((event as ToggleEvent).newState !== "open") return;
    const box = opener.getBoundingClientRect();
    list.style.top = `${box.bottom + 4}px`;
    list.style.left = `${Math.max(4, Math.min(box.left, innerWidth - list.offsetWidth - 4))}px`;
    enabled()[0]?.focus();
  });
  list.addEventListener("keydown", (event) => {
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (by === undefined) return;
    event.preventDefault();
    const all = enabled();
    const at = all.findIndex((item) => item === document.activeElement);
    all[(at + by + all.length) % all.length]?.focus();
  });
  return element("span", { class: "menu-holder" }, opener, list);
}

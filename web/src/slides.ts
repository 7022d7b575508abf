// Slide view for teaching: the page of the lecture in large letters beside its demonstration, on the full screen. Arrow
// keys, page keys and swipes over the text turn pages; Escape leaves.
import type { Page } from "./page";
import { shortcutButton } from "./shortcuts";

const kKeys: Record<string, 1 | -1> = { ArrowRight: 1, PageDown: 1, ArrowLeft: -1, PageUp: -1 };
const kSwipe = 60; // [px]

export function makeSlides(page: Page, card: HTMLElement, move: (by: 1 | -1) => void, start: () => boolean): HTMLButtonElement {
  const { classList } = document.body;
  const isOn = (): boolean => classList.contains("slides");
  const show = (on: boolean): void => {
    if (on && !start()) return;
    classList.toggle("slides", on);
    // A frame may refuse the full screen; then the page fills the frame.
    if (on) void document.documentElement.requestFullscreen?.().catch(() => {});
    else if (document.fullscreenElement) void document.exitFullscreen();
  };
  addEventListener("fullscreenchange", () => document.fullscreenElement || show(false));
  addEventListener("keydown", (event) => isOn() && press(event), { capture: true });
  const press = (event: KeyboardEvent): void => {
    const { target, key, shiftKey, ctrlKey, altKey, metaKey } = event;
    if (shiftKey || ctrlKey || altKey || metaKey || document.querySelector("dialog[open]")) return;
    if (target instanceof Element && target.matches("textarea, select, input")) return;
    const by = kKeys[key];
    if (key !== "Escape" && by === undefined) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    if (by === undefined) show(false);
    else move(by);
  };
  let touched: Touch | null = null;
  card.addEventListener("touchstart", ({ touches }) => (touched = touches.length === 1 ? touches[0]! : null), { passive: true });
  card.addEventListener("touchend", ({ changedTouches }) => {
    const [x, y] = touched ? [changedTouches[0]!.clientX - touched.clientX, changedTouches[0]!.clientY - touched.clientY] : [0, 0];
    if (isOn() && Math.abs(x) > Math.max(kSwipe, 2 * Math.abs(y))) move(x < 0 ? 1 : -1);
  });
  const shortcut = { key: "Shift+F", does: "Slides of the lecture on the full screen", group: "Panels", run: () => show(!isOn()) } as const;
  return shortcutButton(page, shortcut, { text: "Slides" });
}

// Messages of the page: state of the connection, activity of the program, refusals, notices and errors.
import { button, element, messageOf } from "./dom";
import type { Page } from "./page";
import type { Store } from "./store";

const kShown = 4; // largest number at a time
const kInfoLasts = 6000; // duration [ms]
const kErrorLasts = 15000;
const kGone = 6; // failed reconnections after which the program has probably ended

export function connectionText(failures: number): string {
  if (failures === Infinity) return "The simulation in this page has ended. Reload the page to start it again.";
  return failures < kGone
    ? "Connection lost. Reconnecting."
    : "The program does not answer. It has probably ended: start aspic view again and open the address that it prints. " +
        "This page continues to try.";
}

export function showNotices(root: HTMLElement, store: Store, page: Page): void {
  const lasting = element("div", { class: "lasting" });
  const list = element("div", { class: "notices" });
  root.append(element("div", { class: "over-views" }, lasting, list));

  const show = (text: string, kind: "info" | "error"): void => {
    const same = [...list.children].find((child) => child.firstChild?.textContent === text);
    same?.remove();
    const item = element("div", { class: `notice ${kind}` }, element("span", {}, text));
    item.append(button({ icon: "close", label: "Dismiss" }, () => item.remove()));
    list.append(item);
    while (list.children.length > kShown) list.firstElementChild?.remove();
    // Starts the time when the notice is drawn, so that a slow or hidden page shows it equally long.
    requestAnimationFrame(() => setTimeout(() => item.remove(), kind === "info" ? kInfoLasts : kErrorLasts));
  };
  page.on("notice", ({ text, kind }) => show(text, kind));
  page.on("cleared", () => list.replaceChildren());
  store.on("refused", (why) => show(why, "error"));

  const showLasting = (): void => {
    const lost = store.failures ?? 0;
    const text = store.failures === null ? "Starting." : lost ? connectionText(lost) : store.busy;
    lasting.textContent = text;
    lasting.className = `lasting ${lost ? "error" : "busy"}`;
    lasting.hidden = text === "";
  };
  for (const event of ["connected", "busy"] as const) store.on(event, showLasting);
  showLasting();
}

export function showOwnErrors(page: Page): void {
  const report = (text: string): void => page.notice(`Error in this page: ${text}`, "error");
  addEventListener("error", (event) => {
    if (!event.message.startsWith("ResizeObserver loop")) report(event.message);
  });
  addEventListener("unhandledrejection", (event) => report(messageOf(event.reason)));
}

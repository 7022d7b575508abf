// One page steers, the others watch. Any page may request to steer.
import { button, element } from "./dom";
import type { Store } from "./store";

export function makeRole(store: Store): HTMLElement {
  const steer = button({ text: "Steer", title: "Steer from this page instead of the other one" }, () =>
    store.source.send({ do: "take" }),
  );
  const role = element("div", { class: "group role", hidden: true }, element("strong", {}, "Watching"), steer);
  const show = (): void => {
    const may = store.steers && store.connected;
    role.hidden = store.steers || !store.source.live || !store.hello;
    for (const control of document.querySelectorAll<HTMLButtonElement>("[data-steers]"))
      control.disabled = store.source.live && !may;
  };
  for (const event of ["role", "connected"] as const) store.on(event, show);
  return role;
}

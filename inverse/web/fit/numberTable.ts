// A table with a head; columns from number `first` on hold numbers.
import { element } from "../../../web/src/dom";

export function numberTable(titles: readonly string[], first: number, body: HTMLElement): HTMLElement {
  const head = titles.map((title, i) => element("th", { scope: "col", class: i >= first ? "number" : "" }, title));
  return element("table", { class: "values" }, element("thead", {}, element("tr", {}, ...head)), body);
}

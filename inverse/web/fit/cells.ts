// Texts and rows of the tables of a fit.
import { element } from "../../../web/src/dom";
import { short, withUnit } from "../../../web/src/numbers";
import type { MaybeNumber } from "../../../web/src/protocol";

export const percent = (part: MaybeNumber | undefined): string => (part === null || part === undefined || part < 0 ? "–" : part === 0 ? "0 %" : `${short(100 * part, 2)} %`);

export function row(head: string, cells: readonly string[], className = ""): HTMLElement {
  return element("tr", { class: className }, element("th", { scope: "row" }, head), ...cells.map((text) => element("td", { class: "number" }, text)));
}

// A row with a failure instead of its numbers.
export function failedRow(head: string, failure: string, columns: number, className = ""): HTMLElement {
  return element("tr", { class: className }, element("th", { scope: "row" }, head), element("td", { class: "number", colspan: String(columns) }, failure));
}

export const valueText = (value: MaybeNumber, unit: string, digits = 3): string => (unit === "" ? short(value, digits) : withUnit(value, unit, digits));

// Digits that distinguish the ends of an interval.
export function digitsOf(lower: MaybeNumber, upper: MaybeNumber): number {
  if (lower === null || upper === null || !(upper > lower)) return 3;
  const size = Math.max(Math.abs(lower), Math.abs(upper));
  return Math.min(8, Math.max(3, 2 + Math.ceil(Math.log10(size / (upper - lower)))));
}

export function intervalText(lower: MaybeNumber, upper: MaybeNumber, unit: string): string {
  if (lower === null || upper === null) return "–";
  const digits = digitsOf(lower, upper);
  return `${valueText(lower, unit, digits)} to ${valueText(upper, unit, digits)}`;
}

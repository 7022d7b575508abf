// The first paragraph of a report: the values, and how far to trust them.
import type { MaybeNumber } from "../protocol";
import { short, withUnit } from "../plots/numbers";
import type { FitHead, Quantity } from "./data";

export const kQuantityNames: Record<string, string> = { young: "Young's modulus", poisson: "Poisson's ratio", density: "density" };

export const valueText = (value: MaybeNumber, unit: string): string => (unit === "" ? short(value, 3) : withUnit(value, unit, 3));

function valueSentence(q: Quantity): string {
  const name = kQuantityNames[q.name] ?? q.name;
  if (q.rows.length === 1) {
    const { value, lower, upper } = q.rows[0];
    return `${name}: ${valueText(value, q.unit)}${lower === null ? "" : ` (95 %: ${valueText(lower, q.unit)} to ${valueText(upper, q.unit)})`}`;
  }
  const values = q.rows.map((r) => r.value).filter((v) => v !== null);
  return `${name}: ${valueText(Math.min(...values), q.unit)} to ${valueText(Math.max(...values), q.unit)}`;
}

const percent = (part: number): string => `${short(100 * part, 2)} %`;

// What held-out groups say about predictions.
function tested({ figures: { comparison } }: FitHead): string {
  const own = comparison.map(({ models }) => models[0]).filter((m) => m !== undefined);
  const worst = (key: "position" | "force"): MaybeNumber => own.reduce<MaybeNumber>((most, m) => (m[key] === null ? most : Math.max(most ?? 0, m[key])), null);
  const [position, force] = [worst("position"), worst("force")];
  const parts = [position === null ? "" : `${percent(position)} of the largest motion`, force === null ? "" : `${percent(force)} of the largest force`].filter((text) => text !== "");
  return parts.length === 0 ? "" : parts.join(" and ");
}

export function trust(head: FitHead): string {
  const { verdict } = head.figures;
  const values = head.quantities.filter((q) => q.rows.every((r) => r.where !== "given")).map(valueSentence).join("; ");
  const errors = tested(head);
  const missed = errors === "" ? "Nothing was held out, so predictions of other loads are untested." : `Groups of cases that a fit had not seen are predicted with errors of ${errors} beyond the noise of the readings.`;
  if (!verdict.good) return `${values}. Do not rely on these values: the reasons are below. ${missed}`;
  const field = head.quantities.some((q) => q.varies) && head.fit.informed !== null ? ` Of ${head.counts.unknowns} values, the data determine ${short(head.fit.informed, 3)}; trust the map where its uncertainty is small.` : "";
  return `${values}. ${missed} Trust predictions for loads, places and depths like the measured ones.${field}`;
}

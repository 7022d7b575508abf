// The first paragraph of a report: how far to trust its values.
import { short } from "../../../web/src/numbers";
import { percent } from "./cells";
import { kReadingKinds, type FitHead } from "./data";

export const kQuantityNames: Record<string, string> = { young: "Young's modulus", poisson: "Poisson's ratio", density: "density" };

// What held-out groups say about predictions.
function tested({ figures: { held_out: heldOut } }: FitHead): string {
  const parts = kReadingKinds.flatMap(({ name, peak }) => {
    const error = heldOut?.[name] ?? null;
    return error === null ? [] : [`${percent(error)} of the largest ${peak}`];
  });
  const last = parts.pop() ?? "";
  return parts.length === 0 ? last : `${parts.join(", ")} and ${last}`;
}

export function trust(head: FitHead): string {
  const errors = tested(head);
  const predicted = errors === "" ? "Nothing was held out, so predictions of other loads are untested." : `Groups of cases that a fit had not seen are predicted with errors of ${errors} beyond the noise of the readings.`;
  if (!head.figures.verdict.good || errors === "") return predicted;
  const field = head.quantities.some((q) => q.varies) && head.fit.informed !== null ? ` Of ${head.counts.parameters} values, the data determine ${short(head.fit.informed, 3)}; trust the map where its uncertainty is small.` : "";
  return `${predicted} Trust predictions for loads, places and depths like the measured ones.${field}`;
}

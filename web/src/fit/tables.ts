// Tables of a fit: responses of all cases, errors of held-out groups, and simpler models.
import { element, type Child } from "../dom";
import { short, withUnit } from "../plots/numbers";
import type { MaybeNumber } from "../protocol";
import { failedRow, percent, row } from "./cells";
import { isCorrected, stiffness, type CaseFigures, type Figures, type HeldOutGroup } from "./data";
import { numberTable } from "./numberTable";

const ratio = (part: MaybeNumber | undefined, whole: MaybeNumber | undefined): MaybeNumber => (part === null || part === undefined || !((whole ?? 0) > 0) ? null : part / (whole ?? 1));

const unitOf = (unit: string): string => unit.replace("^2", "²");

// Loads and responses of all cases with their units. Columns that would be empty are left out.
export function caseTable(figures: Figures): HTMLElement {
  const { cases } = figures;
  const response = (key: "measured" | "fitted" | "on_mesh" | "held_out") => (c: CaseFigures): string => (c.response[key] === null ? "–" : withUnit(c.response[key], c.response.unit, 3));
  const has = (key: "fitted" | "held_out"): boolean => cases.some((c) => c.response[key] !== null);
  const all: [string, boolean, (c: CaseFigures) => string][] = [
    ["load", true, (c) => `${c.load.name} ${withUnit(c.load.value, unitOf(c.load.unit), 3)}`],
    ["response", true, (c) => c.response.name],
    ["measured", true, (c) => (c.response.measured === null ? "–" : `${withUnit(c.response.measured, c.response.unit, 3)} ± ${withUnit(c.response.deviation, c.response.unit, 2)}`)],
    [isCorrected(figures) ? "fitted, corrected" : "fitted", has("fitted"), response("fitted")],
    ["on the mesh", isCorrected(figures), response("on_mesh")],
    ["held out", has("held_out"), response("held_out")],
    ["stiffness, measured", cases.some((c) => c.stiffness_unit !== ""), (c) => withUnit(stiffness(c, c.response.measured), c.stiffness_unit, 3)],
    ["stiffness, fitted", cases.some((c) => c.stiffness_unit !== "" && c.response.fitted !== null), (c) => withUnit(stiffness(c, c.response.fitted), c.stiffness_unit, 3)],
    ["residuals, rms", true, (c) => (c.rms === null ? "not fitted" : `${short(c.rms, 3)} sd`)],
  ];
  const columns = all.filter(([, isShown]) => isShown);
  const rows = cases.map((c) => row(c.name, columns.map(([, , text]) => text(c))));
  return numberTable(["case", ...columns.map(([title]) => title)], 1, element("tbody", {}, ...rows));
}

function groupRow(g: HeldOutGroup, largest: { motion: MaybeNumber; force: MaybeNumber }): HTMLElement {
  if (!g.ok) return failedRow(g.group, g.failure || "could not be predicted", 6, "bad");
  const errors = (error: MaybeNumber | undefined, unit: string, peak: MaybeNumber | undefined, beyond: MaybeNumber | undefined): string[] =>
    error === null || error === undefined ? ["–", "–", "–"] : [withUnit(error, unit, 3), percent(ratio(error, peak)), percent(beyond)];
  return row(
    g.group,
    [...errors(g.position_error, "m", largest.motion, g.position_beyond_noise), ...errors(g.force_error, "N", largest.force, g.force_beyond_noise)],
    g.poor ? "bad" : "",
  );
}

// Root mean square errors of the groups, and their limits.
export function heldOutTable({ held_out: heldOut }: Figures): HTMLElement | null {
  if (!heldOut) return null;
  const titles = ["held out", "position error", "of largest motion", "beyond noise", "force error", "of largest force", "beyond noise"];
  const { groups, limits } = heldOut;
  const largest = { motion: heldOut.largest_motion, force: heldOut.largest_force };
  const all = row("all (rms)", ["", "", percent(heldOut.position), "", "", percent(heldOut.force)], heldOut.poor ? "bad total" : "total");
  const allowed = row("limit for all", ["", "", percent(limits.position), "", "", percent(limits.force)], "limit");
  const single = groups.length > 1 ? row("limit for one group", ["", "", percent(limits.single * limits.position), "", "", percent(limits.single * limits.force)], "limit") : null;
  return numberTable(titles, 1, element("tbody", {}, ...groups.map((g) => groupRow(g, largest)), all, allowed, single ?? ""));
}

const kHow: Record<string, string> = {
  "cross-validation": "Each group predicted from all others",
  "left out": "Groups that no model was fitted to",
};

export const kLeaveOut = "With leave_out in aspic.fit.toml, the named groups are also predicted by simpler models.";

export function comparisonTables({ comparison }: Figures): Child[] {
  const compared = comparison.filter(({ models }) => models.length > 1);
  if (compared.length === 0) return [element("p", { class: "hint" }, `No simpler model was compared. ${kLeaveOut}`)];
  return compared.flatMap(({ how, models }) => {
    const rows = models.map(({ model, position, force, failure }) => (failure === undefined ? row(model, [percent(position), percent(force)]) : failedRow(model, failure, 2)));
    return [element("h3", {}, `Simpler models: ${kHow[how] ?? how}`), element("div", { class: "wide" }, numberTable(["model", "positions, beyond noise", "forces, beyond noise"], 1, element("tbody", {}, ...rows)))];
  });
}

// Tables of a fit: responses of all cases, errors of held-out groups, and simpler models.
import { element, type Child } from "../../../web/src/dom";
import { short, withUnit } from "../../../web/src/numbers";
import type { MaybeNumber } from "../../../web/src/protocol";
import { failedRow, percent, row } from "./cells";
import { isCorrected, kReadingKinds, stiffness, type CaseFigures, type Figures, type HeldOutFigures, type HeldOutGroup, type ReadingKind, type ReadingName } from "./data";
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

function errorCells(g: HeldOutGroup, { name, peak, unit }: ReadingKind, heldOut: HeldOutFigures): string[] {
  const error = g[`${name}_error`];
  if (error === null || error === undefined) return ["–", "–", "–"];
  return [withUnit(error, unit, 3), percent(ratio(error, heldOut[`largest_${peak}`])), percent(g[`${name}_beyond_noise`])];
}

function groupRow(g: HeldOutGroup, kinds: readonly ReadingKind[], heldOut: HeldOutFigures): HTMLElement {
  if (!g.ok) return failedRow(g.group, g.failure || "could not be predicted", 3 * kinds.length, "bad");
  return row(
    g.group,
    kinds.flatMap((kind) => errorCells(g, kind, heldOut)),
    g.poor ? "bad" : "",
  );
}

// Root mean square errors of the groups, and their limits.
export function heldOutTable({ held_out: heldOut }: Figures): HTMLElement | null {
  if (!heldOut) return null;
  const { groups, limits } = heldOut;
  const kinds = kReadingKinds.filter(({ name }) => groups.some((g) => typeof g[`${name}_error`] === "number"));
  const titles = ["held out", ...kinds.flatMap(({ name, peak }) => [`${name} error`, `of largest ${peak}`, "beyond noise"])];
  const total = (head: string, of: (name: ReadingName) => MaybeNumber, state: string) =>
    row(
      head,
      kinds.flatMap(({ name }) => ["", "", percent(of(name))]),
      state,
    );
  const all = total("all (rms)", (name) => heldOut[name], heldOut.poor ? "bad total" : "total");
  const allowed = total("limit for all", (name) => limits[name], "limit");
  const single = groups.length > 1 ? total("limit for one group", (name) => limits.single * limits[name], "limit") : null;
  return numberTable(titles, 1, element("tbody", {}, ...groups.map((g) => groupRow(g, kinds, heldOut)), all, allowed, single ?? ""));
}

export function comparisonTables({ comparison }: Figures): Child[] {
  const compared = comparison.filter(({ models }) => models.length > 1);
  return compared.flatMap(({ models }) => {
    const kinds = kReadingKinds.filter(({ name }) => models.some((m) => typeof m[name] === "number"));
    const rows = models.map((m) => row(m.model, kinds.map(({ name }) => percent(m[name]))));
    const titles = ["model", ...kinds.map(({ name }) => `${name}s, beyond noise`)];
    return [element("h3", {}, "Simpler models: each group predicted from all others"), element("div", { class: "wide" }, numberTable(titles, 1, element("tbody", {}, ...rows)))];
  });
}

// The checks of the verdict: every figure beside its limit.
import { element } from "../../../web/src/dom";
import { short } from "../../../web/src/numbers";
import { kReadingKinds, type FitHead, type Reason } from "./data";
import { percent, row } from "./cells";
import { numberTable } from "./numberTable";
import { kQuantityNames } from "./trust";

export interface Check {
  what: string;
  value: string;
  limit: string; // empty: for comparison only
  fails: boolean;
}

const size = (value: number): string => (value < 0.01 ? "< 0.01" : short(value, 3));
const deviations = (count: number): string => `${size(count)} sd`;

function squaresOf(head: FitHead): Check[] {
  const { figures, fit } = head;
  const limit = figures.limits.squares_per_reading;
  const check = (what: string, squares: number, isJudged = true): Check => ({ what, value: size(squares), limit: isJudged ? short(limit) : "", fails: isJudged && squares > limit });
  const perReading = (squares: number): number => squares / Math.max(figures.residuals, 1);
  const list = [check("|r|² per reading (expected: 1)", perReading(figures.squares))];
  if (fit.uniformMisfit !== null && head.quantities.some((q) => q.varies)) list.push(check("the same with one value for the whole body", perReading(2 * fit.uniformMisfit), false));
  if (figures.relaxation?.ok) list.push(check("|r|² per reading of the histories", figures.relaxation.squares_per_reading));
  return list;
}

function worstGroup({ figures: { groups, limits } }: FitHead): Check[] {
  if (groups.length === 0) return [];
  const worst = groups.reduce((a, b) => (b.standard_deviations > a.standard_deviations ? b : a));
  return [{ what: `group with the largest error: ${worst.readings} of ${worst.group}`, value: deviations(worst.standard_deviations), limit: deviations(limits.missed), fails: worst.standard_deviations > limits.missed }];
}

function commonErrors({ figures: { common_errors: errors, limits } }: FitHead): Check[] {
  return (errors ?? []).map((e) => {
    const count = Math.abs(e.standard_deviations);
    return { what: `error of ${e.cause}`, value: deviations(count), limit: deviations(limits.missed), fails: count > limits.missed };
  });
}

function heldOutErrors({ figures: { held_out: heldOut } }: FitHead): Check[] {
  if (!heldOut) return [{ what: "held-out groups", value: "not tested", limit: "", fails: false }];
  const list = [];
  for (const { name, peak } of kReadingKinds) {
    const [error, limit] = [heldOut[name], heldOut.limits[name]];
    if (error !== null) list.push({ what: `held-out ${name}s: error beyond the noise, of the largest ${peak}`, value: percent(error), limit: percent(limit), fails: error > limit });
  }
  return list;
}

// Share of the tets of synthetic data whose interval contains the truth.
function coverage({ figures: { truth } }: FitHead): Check[] {
  return (truth ?? []).filter((t) => t.coverage >= 0).map((t) => ({ what: `tets whose 95 % interval of ${kQuantityNames[t.quantity] ?? t.quantity} contains the truth`, value: percent(t.coverage), limit: "", fails: false }));
}

// Reasons whose figures are in no other row, such as one held-out group.
function others(reasons: readonly Reason[], shown: readonly Check[]): Check[] {
  const own = ["group_missed", "unexplained", ...(shown.some((c) => c.what.startsWith("held-out") && c.fails) ? ["predicts_badly"] : [])];
  return reasons
    .filter((r): r is Reason & { value: number; limit: number } => r.value !== undefined && r.limit !== undefined && r.name !== "field_rejected" && !own.includes(r.name))
    .map((r) => ({ what: r.text, value: short(r.value, 3), limit: short(r.limit, 3), fails: true }));
}

export function checksOf(head: FitHead): Check[] {
  const list = [...squaresOf(head), ...worstGroup(head), ...commonErrors(head), ...heldOutErrors(head), ...coverage(head)];
  return [...list, ...others(head.figures.verdict.reasons, list)];
}

const kMeaning = "sd: standard deviations of the readings with their corrections.";
const kCommon = " Errors of mesh and law are common to all readings; their estimates are in standard deviations of what meshes and laws of this kind differ by.";

export function checkTable(head: FitHead): HTMLElement {
  const rows = checksOf(head).map((c) => row(c.what, [c.value, c.limit === "" ? "–" : c.fails ? `${c.limit}: exceeded` : c.limit], c.fails ? "bad" : ""));
  const table = numberTable(["check", "value", "limit"], 1, element("tbody", {}, ...rows));
  table.classList.add("checks");
  const hasCommon = (head.figures.common_errors ?? []).length > 0;
  return element("div", {}, table, element("p", { class: "hint" }, kMeaning + (hasCommon ? kCommon : "")));
}

// The report of a fit: fitted values, their uncertainty, and how well they explain the measurements.
import "./fit.css";
import { button, element, listOf, messageOf, type Child } from "../dom";
import { formulaElements } from "../formulas";
import { Page } from "../page";
import type { Chart } from "../plots/chart";
import { plural, short } from "../plots/numbers";
import type { Vec3 } from "../protocol";
import { Theme } from "../theme";
import { CameraRig } from "../view/cameras";
import { histogramChart, historyChart, loadChart, weightChart } from "./charts";
import { closeness, groupCurve, groupsOf, isCorrected, unpackFit, verdict, type Fit, type Quantity, type ValueRow } from "./data";
import { FittedBody } from "./bodyView";
import { Maps } from "./maps";
import { Misfits } from "./misfits";
import { numberTable } from "./numberTable";
import { caseTable, comparisonTables, heldOutTable, percent } from "./tables";
import { kQuantityNames, trust, valueText } from "./trust";

function section(title: string, about: string, ...children: Child[]): HTMLElement {
  return element("section", { "aria-label": title }, element("h2", {}, title), about ? element("p", { class: "about" }, about) : null, ...children);
}

function card(name: string, value: string, meaning: string): HTMLElement {
  return element("div", { class: "card", title: meaning }, element("span", { class: "card-name" }, name), element("strong", {}, value), element("span", { class: "card-meaning" }, meaning));
}

function cards({ head }: Fit): HTMLElement {
  const { fit, counts, figures: { held_out: heldOut, limits } } = head;
  const list = element("div", { class: "cards" });
  list.append(card("misfit |r|² per reading", short(closeness(fit.misfit, counts.residuals), 3), `no unit; 1: consistent with the standard deviations; limit ${limits.squares_per_reading}`));
  if (fit.uniformMisfit !== null) list.append(card("one value for all", short(closeness(fit.uniformMisfit, counts.residuals), 3), "|r|² per reading of a uniform material"));
  const heldOutCard = (name: string, error: number, limit: number, peak: string): HTMLElement => card(name, percent(error), `error beyond the noise, of the largest ${peak}; limit ${percent(limit)}`);
  if (heldOut && heldOut.position !== null) list.append(heldOutCard("held-out positions", heldOut.position, heldOut.limits.position, "motion"));
  if (heldOut && heldOut.force !== null) list.append(heldOutCard("held-out forces", heldOut.force, heldOut.limits.force, "force"));
  if (fit.informed !== null) list.append(card("determined by the data", `${short(fit.informed, 3)} of ${counts.unknowns}`, "number of parameters"));
  return list;
}

function valueTable(quantities: readonly Quantity[]): HTMLElement {
  const row = (q: Quantity, r: ValueRow, first: boolean): HTMLElement =>
    element(
      "tr",
      { class: first ? "first" : "" },
      element("th", { scope: "row" }, first ? (kQuantityNames[q.name] ?? q.name) + (q.unit === "" ? " (no unit)" : "") : ""),
      element("td", {}, r.where),
      element("td", { class: "number" }, valueText(r.value, q.unit)),
      element("td", { class: "number" }, r.lower === null ? "–" : `${valueText(r.lower, q.unit)} to ${valueText(r.upper, q.unit)}`),
    );
  const rows = quantities.flatMap((q) => q.rows.map((r, i) => row(q, r, i === 0)));
  return numberTable(["quantity", "where", "value", "95 % interval"], 2, element("tbody", {}, ...rows));
}

function words(title: string, list: readonly string[], className: string): HTMLElement | null {
  if (list.length === 0) return null;
  return element("div", { class: `words ${className}` }, element("h3", {}, title), listOf(list));
}

function figure(title: string, chart: Chart): HTMLElement {
  return element("figure", {}, element("figcaption", {}, title), chart.element);
}

// Upward direction: along the axis that leads away from the held part of the body.
function upward(fit: Fit): Vec3 {
  const [points, fixed] = [fit.floats("points"), fit.indices("fixed")];
  const mean = (k: number, vertices: Iterable<number>): number => {
    let [sum, count] = [0, 0];
    for (const v of vertices) [sum, count] = [sum + points[3 * v + k], count + 1];
    return count > 0 ? sum / count : 0;
  };
  const away = [0, 1, 2].map((k) => (fixed.length > 0 ? mean(k, Array(points.length / 3).keys()) - mean(k, fixed) : 0));
  const axis = [0, 1, 2].reduce((best, k) => (Math.abs(away[k]) > Math.abs(away[best]) ? k : best), 1);
  return [0, 1, 2].map((k) => (k !== axis ? 0 : away[k] < 0 ? -1 : 1)) as Vec3;
}

function report(fit: Fit): HTMLElement {
  const body = new FittedBody({ points: fit.floats("points"), tets: fit.indices("tets") }, upward(fit));
  const rig = new CameraRig();
  rig.show(fit.head.name, body.lower, body.upper, body.up);
  const maps = new Maps(fit, body, rig);
  const misfits = new Misfits(fit, body, rig);
  return element("main", { class: "fit" }, found(fit), section("Stiffness and its uncertainty", "", maps.element), loads(fit), predictions(fit), residualSection(fit, misfits), made(fit));
}

function found(fit: Fit): HTMLElement {
  const { head } = fit;
  const judged = verdict(head.figures);
  const next = head.nextPoke ? element("div", { class: "words next" }, element("h3", {}, "Next best poke"), element("p", {}, head.nextPoke.words)) : null;
  return section(
    "Result",
    trust(head),
    element("div", { class: `verdict ${judged.kind}` }, element("p", {}, judged.text), judged.reasons.length > 0 ? listOf(judged.reasons) : null),
    cards(fit),
    element("div", { class: "columns" }, element("div", {}, valueTable(head.quantities)), element("div", {}, words("Warnings", head.warnings, "warnings"), next, words("Assumptions", head.notes, ""))),
  );
}

const kCorrected = "“Corrected” predictions include the correction for the discretization error of the mesh and are compared with the readings; those “on the mesh” are what a simulation on this mesh shows. ";
const kBars = "Bars and ± are one standard deviation of the reading, with that of the correction. Held-out values are predicted by a fit without that group.";

function loads(fit: Fit): HTMLElement {
  const { figures } = fit.head;
  const grid = element("div", { class: "charts" });
  for (const group of groupsOf(fit.head.cases)) {
    if (group.cases.length < 2) continue; // the table shows its single case
    const curve = groupCurve(figures, group);
    grid.append(figure(curve.leftOut ? `${group.name} (held out)` : group.name, loadChart(group.name, curve, figures)));
  }
  return section("Measured and fitted", (isCorrected(figures) ? kCorrected : "") + kBars, grid, element("div", { class: "wide" }, caseTable(figures)));
}

function predictions({ head: { figures } }: Fit): HTMLElement {
  const table = heldOutTable(figures);
  if (!table) return section("Predictions of unseen groups", "No group was held out, so predictions of other loads are untested (cross_validation, leave_out).");
  return section(
    "Predictions of unseen groups",
    "Root mean square errors, also without the part that the noise of the readings explains. Percentages are relative to the largest motion and force of all groups. This is the figure to trust.",
    element("div", { class: "wide" }, table),
    ...comparisonTables(figures.comparison),
  );
}

function residualSection(fit: Fit, misfits: Misfits): HTMLElement {
  const { limits } = fit.head.figures;
  return section(
    "Residuals",
    `Fitted minus measured, in standard deviations (sd). A histogram wider than the normal curve indicates a model too simple or bad readings. Groups that are missed by more than ${limits.missed} sd make the verdict bad.`,
    element("div", { class: "charts" }, figure("All coordinates", histogramChart(fit.head.figures))),
    misfits.element,
  );
}

const kSymbols =
  "r: residuals in standard deviations σ of the readings; R: prior, w: its weight; z: fitted value per tet t, linear in the " +
  "parameters p; a, b: range of Poisson's ratio ν; C: posterior covariance. The ends of an interval are converted from z to the quantity. " +
  "If the residuals clearly exceed the noise, JᵀJ is divided by their mean square, which widens the intervals.";

function made({ head }: Fit): HTMLElement {
  const [weights, history] = [weightChart(head), historyChart(head)];
  const { fit, counts } = head;
  const facts = `${head.model}, ${fit.method}: ${fit.words} after ${plural(fit.iterations, "iteration")} and ${counts.equilibria} equilibria; ${counts.unknowns} parameters, ${counts.residuals} readings, weight ${short(fit.weight, 3)}; ${fit.mesh}.`;
  return section(
    "How it was fitted",
    facts,
    ...formulaElements("fit_objective"),
    element("p", { class: "about" }, kSymbols),
    ...(fit.informed === null ? [] : formulaElements("fit_interval")),
    element("div", { class: "charts" }, weights && figure("Weight of the smoothness", weights), history && figure("Convergence", history)),
  );
}

function header({ head }: Fit, theme: Theme): HTMLElement {
  const { counts } = head;
  const facts = [head.model, plural(counts.tets, "tet"), plural(counts.markers, "marker"), plural(counts.cases, "case")];
  return element(
    "header",
    { class: "fit-header" },
    element("h1", {}, `Fit of ${head.name}`),
    element("span", { class: "facts" }, facts.join(" · ")),
    element("span", { class: "facts" }, `Aspic ${head.version}`),
    button({ icon: "theme", label: "Light or dark" }, () => theme.toggle()),
  );
}

export async function openFit(text: string): Promise<void> {
  document.body.className = "fit-page";
  document.documentElement.classList.add("fit-page");
  try {
    const fit = await unpackFit(text);
    document.title = `Fit of ${fit.head.name}`;
    document.body.replaceChildren(header(fit, new Theme(new Page())), report(fit));
  } catch (error) {
    document.body.replaceChildren(element("p", { class: "damaged" }, `Cannot show this fit: ${messageOf(error)}. Create it again with aspic fit.`));
  }
}

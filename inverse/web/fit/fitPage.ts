// The report of a fit: fitted values, their uncertainty, and how well they explain the measurements.
import "./fit.css";
import { button, element, listOf, messageOf, type Child } from "../../../web/src/dom";
import { formulaElements } from "../../../web/src/formulas";
import { Page } from "../../../web/src/page";
import type { Chart } from "../../../web/src/plots/chart";
import { plural, short } from "../../../web/src/numbers";
import type { Vec3 } from "../../../web/src/protocol";
import { Theme } from "../../../web/src/theme";
import { CameraRig } from "../../../web/src/view/cameras";
import { histogramChart, historyChart, loadChart, weightChart } from "./charts";
import { digitsOf, intervalText, valueText } from "./cells";
import { checkTable } from "./checks";
import { groupCurve, groupsOf, isCorrected, unpackFit, verdict, type Fit, type Quantity, type ValueRow } from "./data";
import { FittedBody } from "./bodyView";
import { branchTable, errorTable, historyFigures, lawTable, outlierTable, partsText, trialTable } from "./found";
import { Maps } from "./maps";
import { Misfits } from "./misfits";
import { numberTable } from "./numberTable";
import { caseTable, comparisonTables, heldOutTable } from "./tables";
import { kQuantityNames, trust } from "./trust";

function section(title: string, about: string, ...children: Child[]): HTMLElement {
  return element("section", { "aria-label": title }, element("h2", {}, title), about ? element("p", { class: "about" }, about) : null, ...children);
}

function valueTable(quantities: readonly Quantity[]): HTMLElement {
  const row = (q: Quantity, r: ValueRow, first: boolean): HTMLElement =>
    element(
      "tr",
      { class: first ? "first" : "" },
      element("th", { scope: "row" }, first ? (kQuantityNames[q.name] ?? q.name) + (q.unit === "" ? " (no unit)" : "") : ""),
      element("td", {}, r.where),
      element("td", { class: "number" }, valueText(r.value, q.unit, digitsOf(r.lower, r.upper))),
      element("td", { class: "number" }, intervalText(r.lower, r.upper, q.unit)),
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
  const varies = fit.head.quantities.some((q) => q.varies);
  const map = varies ? section("Stiffness and its uncertainty", "", new Maps(fit, body, rig).element) : null;
  const misfits = new Misfits(fit, body, rig);
  const sections = [result(fit), laws(fit), relaxation(fit), errors(fit), map, loads(fit), predictions(fit), residualSection(fit, misfits), made(fit)];
  return element("main", { class: "fit" }, ...sections.filter((part) => part !== null));
}

function result(fit: Fit): HTMLElement {
  const { head } = fit;
  const judged = verdict(head.figures);
  const isAllInformed = head.fit.informed === null || head.fit.informed > head.counts.parameters - 0.05;
  const informed = isAllInformed ? null : element("p", { class: "hint" }, `The data determine ${short(head.fit.informed, 3)} of ${plural(head.counts.parameters, "parameter")}; the prior determines the rest.`);
  const parts = head.figures.parts ? element("p", { class: "hint" }, partsText(head.figures.parts)) : null;
  return section(
    "Result",
    "",
    element("div", { class: `verdict ${judged.kind}` }, element("p", {}, judged.title), judged.reasons.length > 0 ? listOf(judged.reasons) : null),
    element("p", { class: "about" }, trust(head)),
    element("div", { class: "columns" }, element("div", { class: "wide" }, valueTable(head.quantities), parts, informed), element("div", { class: "wide" }, checkTable(head))),
    element("div", { class: "columns" }, words("Directions of fibres", head.fibres, ""), words("Warnings", head.warnings, "warnings"), words("Assumptions", head.notes, "")),
  );
}

function laws({ head: { figures } }: Fit): HTMLElement | null {
  if (!figures.laws) return null;
  const about = `${figures.laws.text} Log evidence and held-out log probability are relative to the best law; a difference of 3 is a ratio of 20 to 1. Held-out errors include the noise.`;
  return section("Comparison of laws", about, element("div", { class: "wide" }, lawTable(figures.laws)));
}

function relaxation({ head: { figures: { relaxation: found } } }: Fit): HTMLElement | null {
  if (!found) return null;
  if (!found.ok) return section("Relaxation", `No relaxation times: ${found.failure}`);
  return section(
    "Relaxation",
    `Fitted to ${found.readings} readings of the histories. The material above is the long-term response${found.scale.known ? "" : "; its stiffness includes the factor in the last row"}.${found.curves.some((c) => c.unit === "m") ? " Motions are those of the markers that move farthest, along their largest displacement." : ""}`,
    element("div", { class: "columns" }, ...[branchTable(found), trialTable(found)].map((table) => table && element("div", { class: "wide" }, table))),
    element("div", { class: "charts" }, ...historyFigures(found)),
  );
}

function errors({ head: { figures } }: Fit): HTMLElement | null {
  const [systematic, outliers] = [errorTable(figures), outlierTable(figures)];
  if (!systematic && !outliers && !figures.outliers) return null;
  return section(
    "Errors of the measurement",
    "",
    ...(systematic ? [element("p", { class: "about" }, "Systematic errors that the data set states. Intervals of the material include them. Estimates beyond 3 standard deviations of their prior are marked."), element("div", { class: "wide" }, systematic)] : []),
    ...(figures.outliers ? [element("h3", {}, "Outliers"), outliers ?? element("p", {}, "No reading is more than 5 standard deviations off.")] : []),
    outliers ? element("p", { class: "hint" }, "Readings more than 5 standard deviations off. Weight: the part of the reading that the fit uses.") : null,
  );
}

const kCorrected = "“Corrected” predictions include the corrections for the discretization error and for systematic errors, and are compared with the readings; those “on the mesh” are what a simulation on this mesh shows. ";
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
  if (!table) return section("Predictions of unseen groups", "No group was held out, so predictions of other loads are untested.");
  return section(
    "Predictions of unseen groups",
    "Root mean square errors, also without the part that the noise of the readings explains. Percentages are relative to the largest motion, force and torque of all groups. This is the figure to trust.",
    element("div", { class: "wide" }, table),
    ...comparisonTables(figures),
  );
}

const kFewest = 30; // residuals of a histogram

function residualSection(fit: Fit, misfits: Misfits): HTMLElement | null {
  const { limits, histogram } = fit.head.figures;
  const hasMarkers = fit.head.cases.some((c) => c.count > 0);
  const hasMany = histogram.counts.reduce((sum, n) => sum + n, 0) >= kFewest;
  if (!hasMarkers && !hasMany) return null;
  return section(
    "Residuals",
    `Fitted minus measured, in standard deviations (sd). A histogram wider than the normal curve indicates a model too simple or bad readings. Groups that are missed by more than ${limits.missed} sd make the verdict bad.`,
    hasMany ? element("div", { class: "charts" }, figure("All coordinates", histogramChart(fit.head.figures))) : null,
    hasMarkers ? misfits.element : null,
  );
}

const kSymbols =
  "r: residuals in standard deviations σ of the readings; R: prior, w: its weight; z: fitted value per tet t, linear in the " +
  "parameters p; a, b: range of Poisson's ratio ν; C: posterior covariance. The ends of an interval are converted from z to the quantity. " +
  "If the residuals clearly exceed the noise, JᵀJ is divided by their mean square, which widens the intervals.";

function made({ head }: Fit): HTMLElement {
  const [weights, history] = [weightChart(head), historyChart(head)];
  const { fit, counts } = head;
  const facts = `${head.model}, ${fit.method}: ${fit.words} after ${plural(fit.iterations, "iteration")} and ${counts.equilibria} equilibria; ${plural(counts.parameters, "parameter")}, ${plural(counts.residuals, "reading")}, weight ${short(fit.weight, 3)}; ${fit.mesh}.`;
  return section(
    "How it was fitted",
    facts,
    element("div", { class: "charts" }, weights && figure("Weight of the smoothness", weights), history && figure("Convergence", history)),
    element("details", {}, element("summary", {}, "Formulas"), ...formulaElements("fit_objective"), element("p", { class: "about" }, kSymbols), ...(fit.informed === null ? [] : formulaElements("fit_interval"))),
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

// The report of a fit: fitted values, their uncertainty, and how well they explain the measurements.
import "./fit.css";
import { button, element, listOf, messageOf, type Child } from "../dom";
import { formulaElements } from "../formulas";
import { Page } from "../page";
import type { Chart } from "../plots/chart";
import { plural, short, withUnit } from "../plots/numbers";
import type { MaybeNumber, Vec3 } from "../protocol";
import { Theme } from "../theme";
import { CameraRig } from "../view/cameras";
import { caseChart, histogramChart, historyChart, loadChart, weightChart } from "./charts";
import { closeness, groupCurve, groupsOf, residuals, unpackFit, verdict, type Fit, type HeldOutGroup, type Quantity, type ValueRow } from "./data";
import { FittedBody } from "./bodyView";
import { Maps } from "./maps";
import { Misfits } from "./misfits";
import { numberTable } from "./numberTable";

function section(title: string, about: string, ...children: Child[]): HTMLElement {
  return element("section", { "aria-label": title }, element("h2", {}, title), about ? element("p", { class: "about" }, about) : null, ...children);
}

const percent = (part: MaybeNumber): string => (part === null || part < 0 ? "–" : `${short(100 * part, 2)} %`);
const ratio = (part: MaybeNumber, whole: MaybeNumber): MaybeNumber => (part === null || whole === null || !(whole > 0) ? null : part / whole);

const valueText = (value: MaybeNumber, unit: string): string => (unit === "" ? short(value, 3) : withUnit(value, unit, 3));

function card(name: string, value: string, meaning: string): HTMLElement {
  return element("div", { class: "card", title: meaning }, element("span", { class: "card-name" }, name), element("strong", {}, value), element("span", { class: "card-meaning" }, meaning));
}

function cards({ head }: Fit): HTMLElement {
  const { fit, counts, heldOut } = head;
  const list = element("div", { class: "cards" });
  list.append(card("misfit per reading", short(closeness(fit.misfit, counts.residuals), 3), "|r|²: 1 is consistent with the standard deviations"));
  if (fit.uniformMisfit !== null) list.append(card("one value for all", short(closeness(fit.uniformMisfit, counts.residuals), 3), "misfit per reading of a uniform material"));
  if (heldOut && (heldOut.position ?? -1) >= 0) list.append(card("held-out positions", percent(heldOut.position), "relative to the peak motion"));
  if (heldOut && (heldOut.force ?? -1) >= 0) list.append(card("held-out forces", percent(heldOut.force), "relative to the peak force"));
  if (fit.informed !== null) list.append(card("learned", `${short(fit.informed, 3)} of ${counts.unknowns}`, "parameters that the data determine"));
  return list;
}

function valueTable(quantities: readonly Quantity[]): HTMLElement {
  const row = (q: Quantity, r: ValueRow, first: boolean): HTMLElement =>
    element(
      "tr",
      { class: first ? "first" : "" },
      element("th", { scope: "row" }, first ? q.name : ""),
      element("td", {}, r.where),
      element("td", { class: "number" }, valueText(r.value, q.unit)),
      element("td", { class: "number" }, r.lower === null ? "–" : `${valueText(r.lower, q.unit)} to ${valueText(r.upper, q.unit)}`),
    );
  const rows = quantities.flatMap((q) => q.rows.map((r, i) => row(q, r, i === 0)));
  return numberTable(["quantity", "where", "value", "95 % interval"], 2, element("tbody", {}, ...rows));
}

function heldOutTable(groups: readonly HeldOutGroup[]): HTMLElement {
  const titles = ["held out", "position error", "of peak motion", "force error", "of peak force"];
  const row = (g: HeldOutGroup): HTMLElement => {
    if (!g.ok) return element("tr", {}, element("th", { scope: "row" }, g.group), element("td", { colspan: "4" }, g.failure || "could not be predicted"));
    const cells = [
      withUnit(g.positionError, "m", 3),
      percent(ratio(g.positionError, g.peakMotion)),
      (g.peakForce ?? 0) > 0 ? withUnit(g.forceError, "N", 3) : "–",
      percent(ratio(g.forceError, g.peakForce)),
    ];
    return element("tr", {}, element("th", { scope: "row" }, g.group), ...cells.map((text) => element("td", { class: "number" }, text)));
  };
  return numberTable(titles, 1, element("tbody", {}, ...groups.map(row)));
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
  return element("main", { class: "fit" }, found(fit), section("Stiffness and its uncertainty", "", maps.element), loads(fit), residualSection(fit, misfits), made(fit));
}

function found(fit: Fit): HTMLElement {
  const { head } = fit;
  const judged = verdict(head);
  const next = head.nextPoke ? element("div", { class: "words next" }, element("h3", {}, "Next best poke"), element("p", {}, head.nextPoke.words)) : null;
  return section(
    "Result",
    "",
    element("div", { class: `verdict ${judged.kind}` }, element("p", {}, judged.text), judged.reasons.length > 0 ? listOf(judged.reasons) : null),
    cards(fit),
    element("div", { class: "columns" }, element("div", {}, valueTable(head.quantities)), element("div", {}, words("Warnings", head.warnings, "warnings"), next, words("Assumptions", head.notes, ""))),
  );
}

function loads(fit: Fit): HTMLElement {
  const grid = element("div", { class: "charts" });
  for (const group of groupsOf(fit.head.cases)) {
    const curve = groupCurve(fit, group);
    grid.append(figure(curve.leftOut ? `${group.name} (held out)` : group.name, loadChart(group.name, curve)));
  }
  const groups = fit.head.heldOut?.groups ?? [];
  return section(
    "Measured and fitted",
    "Readings and predictions of the fitted material, corrected for the mesh. Bars are one standard deviation of the reading and of the correction. The dashed curve is predicted by a fit without that group.",
    grid,
    groups.length > 0 ? heldOutTable(groups) : null,
  );
}

function residualSection(fit: Fit, misfits: Misfits): HTMLElement {
  const found = residuals(fit);
  const names = fit.head.cases.map((c) => c.name);
  return section(
    "Residuals",
    "Fitted minus measured, in standard deviations. A histogram wider than the normal curve, or a case with large residuals, indicates a model too simple or a bad reading.",
    element("div", { class: "charts" }, figure("All readings", histogramChart(found.all)), figure("By case", caseChart(names, found.ofCase))),
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

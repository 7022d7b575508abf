// The certificate of a run: totals, a table of its steps with the worst first, and the scene as text.
import "./report.css";
import { button, element } from "../dom";
import { choiceFormulas, chosen } from "../formulas";
import { choiceName } from "../names";
import type { Page, Panel } from "../page";
import { plural, short } from "../numbers";
import type { MaybeNumber, Setting, StepRow, TextReply } from "../protocol";
import type { Store } from "../store";
import { saveReply } from "../upload";
import { excess, kColumns, listed, totals, withValues, type Column } from "./certificate";
import { makeMeshError } from "./meshError";

const kRowsPerPage = 100;
const kPause = 500; // time between two drawings [ms]; steps may arrive faster

const text = (value: MaybeNumber | string): string => (typeof value === "string" ? value : short(value));

class StepTable {
  readonly element: HTMLElement;
  private readonly table = element("table");
  private readonly onlyFailed = element("input", { type: "checkbox" });
  private readonly range = element("span", { role: "status" });
  private column = kColumns[0];
  private first = 0; // first row of this page of the table

  constructor(private readonly store: Store) {
    this.onlyFailed.addEventListener("change", () => this.turn(-Infinity));
    const bar = element(
      "div",
      { class: "bar" },
      element("label", {}, this.onlyFailed, " only steps that did not converge"),
      button({ text: "Earlier rows" }, () => this.turn(-kRowsPerPage)),
      this.range,
      button({ text: "Later rows" }, () => this.turn(kRowsPerPage)),
    );
    this.element = element("section", { "aria-label": "Steps" }, bar, this.table);
  }

  draw(): void {
    const steps = this.store.side("a")?.steps ?? [];
    const rows = listed(steps, this.column, this.onlyFailed.checked);
    const columns = withValues(steps);
    this.first = Math.max(0, Math.min(this.first, rows.length - 1));
    this.first -= this.first % kRowsPerPage;
    const shown = rows.slice(this.first, this.first + kRowsPerPage);
    this.range.textContent = shown.length ? `${this.first + 1} to ${this.first + shown.length} of ${rows.length}` : "no steps";
    this.table.replaceChildren(
      element("caption", { hidden: true }, "Steps"),
      element("thead", {}, element("tr", {}, ...columns.map((column) => this.head(column)))),
      element("tbody", {}, ...shown.map((row) => this.row(row, columns))),
    );
  }

  private turn(rows: number): void {
    this.first = Math.max(0, this.first + rows);
    this.draw();
  }

  private head(column: Column): HTMLElement {
    const sorted = column === this.column ? (column.worse ? "descending" : "ascending") : "none";
    const sort = button({ text: column.title, title: `${column.meaning}; ${column.worse ? "worst first" : "in order"}` }, () => {
      this.column = column;
      this.turn(-Infinity);
    });
    return element("th", { scope: "col", "aria-sort": sorted }, sort);
  }

  private row(row: StepRow, columns: Column[]): HTMLElement {
    const cells = columns.map((column, i) => {
      const value = text(column.value(row));
      if (i > 0) return element("td", { class: column.isBad?.(row) ? "bad" : undefined, title: column.whole?.(row) ?? value }, value);
      const show = button({ text: value, title: `Show step ${value}` }, () => this.store.source.send({ do: "rewind", step: row.step }));
      return element("td", {}, show);
    });
    return element("tr", {}, ...cells);
  }
}

function entry(name: string, value: string, className = ""): HTMLElement {
  return element("div", {}, element("dt", {}, name), element("dd", { class: className }, value));
}

function drawTotals(list: HTMLElement, steps: readonly StepRow[]): void {
  const all = totals(steps);
  const at = (row: StepRow | null, value: (row: StepRow) => MaybeNumber): string => (row ? `${short(value(row))} (step ${row.step})` : "–");
  list.replaceChildren(
    entry("steps", String(all.steps)),
    entry("converged", `${all.steps - all.failed} of ${all.steps}`, all.failed ? "bad" : "good"),
    entry("iterations", `${all.iterations}, ${all.steps ? (all.iterations / all.steps).toFixed(1) : "0"} per step`),
    entry("largest residual / threshold", at(all.worstExcess, excess)),
    entry("smallest det F", at(all.smallestVolume, (row) => row.min_det_F), all.inverted ? "bad" : ""),
    ...(all.inverted ? [entry("steps with inverted tets", `${all.inverted} of ${all.steps}`, "bad")] : []),
    entry("largest ledger error [J]", at(all.largestError, (row) => row.ledger_error)),
    ...(all.bounded ? [entry("energy bound", `held in ${all.held} of ${all.bounded}`, all.held < all.bounded ? "bad" : "good")] : []),
    ...(all.bounded ? [entry("smallest slack [J]", at(all.smallestSlack, (row) => row.energy_slack))] : []),
    ...(all.state ? [entry(`state after step ${all.state.step}`, all.state.state_hash ?? "")] : []),
  );
}

// Shows the formulas of the chosen value of a setting.
function drawFormulas(details: HTMLElement, settings: Setting[], key: string, name: string): void {
  const value = chosen(settings, key);
  details.hidden = value === "";
  details.replaceChildren(element("summary", {}, `${name}: ${choiceName(key, value)}`), ...choiceFormulas(settings, key));
}

// The complete scene, requested when it is opened.
function makeScene(store: Store, page: Page): HTMLElement {
  const code = element("pre", { tabindex: "0", "aria-label": "Scene as TOML" });
  let file: TextReply | null = null;
  const save = button({ text: "Save", label: "Save the scene" }, () => file && saveReply(file));
  const details = element("details", {}, element("summary", {}, "Complete scene with all defaults"), save, code);
  const load = async (): Promise<void> => {
    if (!details.open) return;
    try {
      file = await store.source.ask<TextReply>({ ask: "scene", side: "a" });
      code.textContent = file.text;
    } catch (error) {
      page.report(error);
    }
  };
  details.addEventListener("toggle", () => void load());
  store.on("scene", () => void load());
  return details;
}

export function makeReportPanel(store: Store, page: Page): Panel {
  const list = element("dl", { class: "totals" });
  const notes = element("ul", { class: "notes" });
  const notesTitle = element("summary");
  const aboutScene = element("details", {}, notesTitle, notes);
  const [material, integrator] = [element("details", { open: true }), element("details", { open: true })];
  const table = new StepTable(store);
  const meshError = store.source.live ? makeMeshError(store, page) : null; // a recorded run shows it beside the view
  const panel = element("div", { class: "report" }, list, meshError, material, integrator, aboutScene, makeScene(store, page), table.element);
  let due = false;
  let drawn = -kPause; // time of the last drawing
  const draw = (): void => {
    due = false;
    drawn = performance.now();
    const side = store.side("a");
    drawTotals(list, side?.steps ?? []);
    const settings = side?.scene.settings ?? [];
    drawFormulas(material, settings, "material.model", "Material model");
    drawFormulas(integrator, settings, "time.integrator", "Integrator");
    const reported = side?.scene.notes ?? [];
    aboutScene.hidden = reported.length === 0;
    notesTitle.textContent = `Choices of the program for this scene: ${plural(reported.length, "note")}`;
    notes.replaceChildren(...reported.map((note) => element("li", {}, note)));
    table.draw();
  };
  const drawSoon = (): void => {
    if (!panel.isConnected || due) return;
    due = true;
    setTimeout(draw, Math.max(0, drawn + kPause - performance.now()));
  };
  for (const event of ["steps", "scene"] as const) store.on(event, drawSoon);
  return { name: "certificate", title: "Certificate", element: panel, show: drawSoon };
}

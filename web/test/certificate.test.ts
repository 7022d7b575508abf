// The certificate of a run: totals and the order of its rows.
import assert from "node:assert/strict";
import { test } from "node:test";
import { excess, kColumns, listed, totals, withValues } from "../src/panels/certificate";
import { estimatedStep, meshErrorText } from "../src/panels/meshError";
import type { StepRow } from "../src/protocol";
import { stepRow } from "./rowsOfSteps";

function row(step: number, values: Partial<StepRow>): StepRow {
  return stepRow({ step, residual: 0.1, residual_threshold: 1, min_det_F: 0.9, ...values });
}

const kSteps = [
  row(1, { residual: 0.5, min_det_F: 0.2, energy_slack: 2, decrement: 3, state_hash: "1111111111111111" }),
  row(2, { residual: 3, status: "iteration_limit", converged: false, ledger_error: -7, energy_bound: "broken", energy_slack: -1 }),
  row(3, { residual: null, residual_threshold: 0, min_det_F: null, energy_bound: "none", energy_slack: null, state_hash: null }),
];
const column = (title: string): (typeof kColumns)[number] => kColumns.find((c) => c.title === title)!;

test("worst rows come first, ties by time", () => {
  const order = (title: string): number[] => listed(kSteps, column(title), false).map(({ step }) => step);
  assert.deepEqual(order("residual / threshold"), [2, 1, 3]);
  assert.deepEqual(order("status"), [2, 1, 3]);
  assert.deepEqual(order("min det F"), [3, 1, 2]);
  assert.deepEqual(order("ledger error [J]"), [2, 1, 3]);
  assert.deepEqual(order("step"), [1, 2, 3]);
  assert.deepEqual(order("energy bound [J]"), [2, 1, 3]);
  assert.deepEqual(order("decrement [J]"), [1, 2, 3]);
});

test("the filter lists only unconverged steps", () => {
  assert.deepEqual(listed(kSteps, kColumns[0], true).map(({ step }) => step), [2]);
});

test("totals name the worst steps with thresholds", () => {
  const all = totals(kSteps);
  assert.equal(all.failed, 1);
  assert.equal(all.worstExcess?.step, 2);
  assert.equal(all.smallestVolume?.step, 1);
  assert.equal(all.largestError?.step, 2);
  assert.equal(excess(kSteps[2]), null);
  assert.equal(totals([]).worstExcess, null);
  assert.equal(all.held, 1);
  assert.equal(all.bounded, 2);
  assert.equal(all.smallestSlack?.step, 2);
  const noGuarantee = row(4, { energy_bound: "not_guaranteed", energy_slack: -3 });
  assert.equal(totals([...kSteps, noGuarantee]).smallestSlack?.step, 2);
  assert.equal(all.state?.state_hash, "0123456789abcdef");
});

test("the energy bound has its slack", () => {
  const reported = (row: StepRow): unknown => column("energy bound [J]").value(row);
  assert.deepEqual(kSteps.map(reported), ["holds by 2", "broken by 1", null]);
  assert.equal(reported(row(4, { energy_bound: "not_guaranteed", energy_slack: -3 })), "not guaranteed");
});

test("columns without any value are absent", () => {
  const titles = (steps: StepRow[]): string[] => withValues(steps).map(({ title }) => title);
  for (const title of ["reactions [N]", "moments [N m]"]) assert.ok(!titles(kSteps).includes(title), title);
  assert.ok(titles([...kSteps, row(4, { reactions: { left: [1, 0, 0, 0, 0, 0] } })]).includes("reactions [N]"));
  assert.deepEqual(withValues([]), kColumns);
});

test("a hash is shortened, its tooltip complete", () => {
  const state = column("state");
  assert.equal(state.value(row(1, {})), "01234567");
  assert.equal(state.whole?.(row(1, {})), "0123456789abcdef");
  assert.equal(state.value(kSteps[2]), null);
});

test("bad values are marked", () => {
  const bad = (row: StepRow): string[] => kColumns.filter((column) => column.isBad?.(row)).map(({ title }) => title);
  assert.deepEqual(bad(kSteps[0]), []);
  assert.deepEqual(bad(kSteps[1]), ["status", "residual / threshold", "energy bound [J]"]);
  assert.deepEqual(bad(row(4, { min_det_F: -0.5 })), ["min det F"]);
});

test("the last estimate of the mesh error is shown", () => {
  const text = "makes 'bar' about 9 % too stiff. `order = 2` would reach about 2 %.";
  const steps = [row(1, { mesh_error: "an earlier one" }), row(2, { mesh_error: text }), row(3, {})];
  assert.equal(estimatedStep(steps)?.step, 2);
  assert.equal(meshErrorText(steps[1]).replaceAll("\u00a0", " "), "mesh: makes 'bar' about 9 % too stiff. order = 2 would reach about 2 %. (step 2)");
  assert.equal(estimatedStep(kSteps), null);
});

test("moments have the name of their pin", () => {
  const moments = column("moments [N m]");
  assert.equal(moments.value(row(1, { reactions: { "beam.wall": [0, 9.5, 0, 1, 2, 3] } })), "beam.wall (1, 2, 3)");
  assert.equal(moments.value(kSteps[0]), null);
});

test("reactions have the name of their pin", () => {
  const reactions = column("reactions [N]");
  assert.equal(reactions.value(row(1, { reactions: { "beam.wall": [0, 9.5, 0, 1, 2, 3] } })), "beam.wall (0, 9.5, 0)");
  assert.equal(reactions.value(kSteps[0]), null);
});

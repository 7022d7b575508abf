// The certificate of a run: totals and the order of its rows.
import assert from "node:assert/strict";
import { test } from "node:test";
import { excess, kColumns, listed, totals } from "../src/panels/certificate";
import type { StepRow } from "../src/protocol";

function row(step: number, values: Partial<StepRow>): StepRow {
  const usual = { status: "converged", success: true, residual: 0.1, threshold: 1, min_det_F: 0.9, ledger_error: 0, iterations: [] };
  return { step, ...usual, ...values } as unknown as StepRow;
}

const kSteps = [
  row(1, { residual: 0.5, min_det_F: 0.2 }),
  row(2, { residual: 3, status: "iteration_limit", success: false, ledger_error: -7 }),
  row(3, { residual: null, threshold: 0, min_det_F: null }),
];
const column = (title: string): (typeof kColumns)[number] => kColumns.find((c) => c.title === title)!;

test("the worst rows come first, and ties in the order of time", () => {
  const order = (title: string): number[] => listed(kSteps, column(title), false).map(({ step }) => step);
  assert.deepEqual(order("residual / wanted"), [2, 1, 3]);
  assert.deepEqual(order("status"), [2, 1, 3]);
  assert.deepEqual(order("min det F"), [3, 1, 2]);
  assert.deepEqual(order("ledger error [J]"), [2, 1, 3]);
  assert.deepEqual(order("step"), [1, 2, 3]);
});

test("only steps that did not converge are listed when asked for", () => {
  assert.deepEqual(listed(kSteps, kColumns[0], true).map(({ step }) => step), [2]);
});

test("totals name the worst steps; what nobody asked for does not count", () => {
  const all = totals(kSteps);
  assert.equal(all.failed, 1);
  assert.equal(all.worstExcess?.step, 2);
  assert.equal(all.smallestVolume?.step, 1);
  assert.equal(all.largestError?.step, 2);
  assert.equal(excess(kSteps[2]), null);
  assert.equal(totals([]).worstExcess, null);
});

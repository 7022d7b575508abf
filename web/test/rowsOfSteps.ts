// Step rows for tests; fields that a test does not set are zero.
import type { IterationRow, StepRow } from "../src/protocol";
import { kUnknownStep } from "../src/stepFields";

export function stepRow(change: Partial<StepRow> = {}): StepRow {
  return {
    ...kUnknownStep,
    step: 1,
    time: 0.01,
    status: "converged",
    converged: true,
    iterations: [],
    residual: 1e-4,
    residual_threshold: 1e-3,
    decrement: 1e-9,
    min_det_F: 1,
    kinetic: 0,
    potential: [0],
    mouse_work: 0,
    tool_work: 0,
    pin_work: 0,
    damping_loss: 0,
    numerical_loss: 0,
    residual_work: 0,
    ledger_error: 0,
    energy_bound: "holds",
    energy_slack: 1,
    state_hash: "0123456789abcdef",
    seconds: 0.01,
    explanation: null,
    ...change,
  };
}

export function iterationRow(change: Partial<IterationRow> = {}): IterationRow {
  const seconds = { hessian: 1, factorize: 2, solve: 3, line_search: 4, gradient: 5 };
  return {
    value: 1,
    gradient_norm: 1,
    decrement: 1,
    alpha: 1,
    projected_elements: 0,
    linear_iterations: 0,
    seconds,
    trials: [],
    ...change,
  };
}

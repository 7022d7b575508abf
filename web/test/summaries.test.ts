import assert from "node:assert/strict";
import { test } from "node:test";
import { aboveLowest, pace, stepText, totalSeconds } from "../src/plots/summaries";
import { iterationRow, stepRow } from "./rowsOfSteps";

const withNorms = (norms: number[]): ReturnType<typeof stepRow> =>
  stepRow({ iterations: norms.map((gradient_norm) => iterationRow({ gradient_norm })) });

test("quadratic convergence differs from a steady pace", () => {
  assert.equal(pace([1, 1e-1, 1e-2, 1e-4, 1e-8]).pace, "squaring");
  assert.equal(pace([1, 0.5, 0.25, 0.125, 0.0625]).pace, "steady");
  assert.ok(Math.abs(pace([1, 0.5, 0.25, 0.125]).factor - 2) < 1e-12);
  assert.equal(pace([1, 0.3, 0.05, 0.003]).pace, "faster");
});

test("meaningless norms have no pace", () => {
  assert.equal(pace([1, 0.1]).pace, "none");
  assert.equal(pace([1, 2, 3]).pace, "none");
  assert.equal(pace([null, 0, 1]).pace, "none");
  assert.equal(pace([]).pace, "none");
});

test("a converged step has residual and pace", () => {
  assert.equal(
    stepText(withNorms([1, 1e-1, 1e-2, 1e-4]), true, []),
    "Converged in 4 iterations: the residual, 100 µN, is below the threshold of 1 mN. The gradient fell faster in each iteration, the last time by a factor of 100: near the minimum each iteration about squares the error.",
  );
});

test("a failure never reads like success", () => {
  const failed = stepRow({ converged: false, status: "iteration_limit", residual: 1, iterations: [iterationRow()] });
  assert.equal(
    stepText(failed, true, []),
    "Not converged (iteration limit) after 1 iteration: the residual, 1 N, is above the threshold of 1 mN.",
  );
  const explained = { ...failed, explanation: { cause: "no trial was accepted", place: "", remedy: "lower c." } };
  assert.equal(stepText(explained, true, []), "No trial was accepted. Lower c.");
  const byKey = { ...failed, explanation: { cause: "slow", place: "", remedy: 'solver.method = "newton"' } };
  assert.equal(stepText(byKey, true, []), `Slow. solver.method = "newton".`);
});

test("a rejected first trial is mentioned", () => {
  const trials = [
    { alpha: 1, value: 5, bound: 1, accepted: false },
    { alpha: 0.5, value: 0.5, bound: 1, accepted: true },
  ];
  assert.match(
    stepText(stepRow({ iterations: [iterationRow({ trials })] }), true, []),
    /In 1 iteration the line search rejected the first trial/,
  );
});

test("an explicit scheme minimizes nothing", () => {
  assert.match(stepText(stepRow(), false, []), /does not minimize/);
});

test("the lowest value is omitted", () => {
  assert.deepEqual(aboveLowest([3, null, 1, 2]), [2, null, null, 1]);
  assert.equal(totalSeconds(iterationRow()), 15);
});

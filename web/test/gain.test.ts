import assert from "node:assert/strict";
import { test } from "node:test";
import { hasBlownUp } from "../src/gain";
import type { StepRow } from "../src/protocol";
import { stepRow } from "./rowsOfSteps";

const rows = (of: (step: number) => Partial<StepRow>) =>
  Array.from({ length: 100 }, (_, i) => stepRow({ step: i + 1, ...of(i + 1) }));

test("free fall is no blow-up at any distance", () => {
  // Backward Euler, m = 1 kg, g = 10 m/s^2, h = 0.1 s: v = n g h, and 1/2 m (g h)^2 are lost in each step.
  const falling = rows((n) => ({ kinetic: 0.5 * n * n, numerical_loss: 0.5 }));
  assert.equal(hasBlownUp(falling, 100), false);
  // Forward Euler gains the same amount.
  assert.equal(hasBlownUp(rows((n) => ({ kinetic: 0.5 * n * n, numerical_loss: -0.5 })), 100), false);
});

test("energy without work is a blow-up", () => {
  const exploding = rows((n) => ({ kinetic: 4 ** n, numerical_loss: -0.75 * 4 ** n }));
  assert.equal(hasBlownUp(exploding, 100), true);
  assert.equal(hasBlownUp(rows((n) => (n < 50 ? { kinetic: 1 } : { kinetic: null, numerical_loss: null })), 100), true);
  assert.equal(hasBlownUp(rows((n) => (n < 50 ? { kinetic: 1 } : { kinetic: null, numerical_loss: null })), 40), false);
});

test("the initial state is no blow-up", () => {
  assert.equal(hasBlownUp([], 0), false);
});

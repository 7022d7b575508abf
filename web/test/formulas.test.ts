import assert from "node:assert/strict";
import test from "node:test";
import { formulasOf } from "../src/formulas";

test("formulas are bundled as MathML", () => {
  const [formula] = formulasOf("rosenbrock");
  assert.match(formula!, /^<math.*<msup>.*<\/math>$/s);
  assert.doesNotMatch(formula!, /<script|href|temml-error/);
});

test("parts of a demonstration share its formulas", () => {
  assert.equal(formulasOf("43-51_quadratic_model_surface").length, 3);
  assert.deepEqual(formulasOf("43-51_quadratic_model"), formulasOf("43-51_quadratic_model_surface"));
});

test("unknown pages have no formulas", () => {
  assert.deepEqual(formulasOf("01_title"), []);
});

test("integrators have their update rule", () => {
  assert.match(formulasOf("backward_euler")[0]!, /^<math.*<mi>h<\/mi>.*<\/math>$/s);
  assert.notDeepEqual(formulasOf("symplectic_euler"), formulasOf("forward_euler"));
});

test("materials have their energy density first", () => {
  assert.match(formulasOf("stvk")[0]!, /<mi>ψ<\/mi>/);
  assert.equal(formulasOf("stvk").length, 2);
});

import assert from "node:assert/strict";
import { test } from "node:test";
import { kMaterials } from "../src/materials";
import { choiceName, plainText, statusName } from "../src/names";

test("choices have display names", () => {
  assert.equal(choiceName("time.integrator", "backward_euler"), "Backward Euler");
  assert.equal(choiceName("solver.criterion", "absolute"), "Force in N");
  assert.equal(choiceName("solver.definiteness", "absolute"), "Absolute values");
  assert.equal(choiceName("material.model", "some_new_model"), "Some new model");
});

test("statuses have display names", () => {
  assert.equal(statusName("undefined"), "blew up");
  assert.equal(statusName("converged"), "converged");
  assert.equal(statusName("some_new_status"), "some new status");
});

test("tooltips contain no Markdown", () => {
  const text = "the scheme ([integrators](integrators.md)): `bdf2` is **second** order";
  assert.equal(plainText(text), "the scheme (integrators): bdf2 is second order");
});

test("every material has a source or is typical", () => {
  assert.equal(new Set(kMaterials.map(({ name }) => name)).size, kMaterials.length);
  for (const { name, young, poisson, density, source } of kMaterials) {
    assert.ok(young > 1e3 && young < 1e8 && poisson > 0 && poisson < 0.5, name);
    assert.ok(density > 500 && density < 2000, name);
    assert.match(source, /\(\d{4}\)|typical order of magnitude/, name);
  }
});

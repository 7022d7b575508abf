import assert from "node:assert/strict";
import { test } from "node:test";
import { kMaterials } from "../src/materials";
import { choiceName, plainText, refusalText, settingText, statusName } from "../src/names";

test("choices have display names", () => {
  assert.equal(choiceName("time.integrator", "backward_euler"), "Backward Euler");
  assert.equal(choiceName("solver.criterion", "absolute"), "Force in N");
  assert.equal(choiceName("solver.definiteness", "absolute"), "Absolute values");
  assert.equal(choiceName("material.model", "some_new_model"), "Some new model");
  assert.equal(choiceName("material.model", "neo_hookean_fibres"), "Neo-Hookean with fibres");
});

test("refused values are named by their setting", () => {
  const young = { label: "Young's modulus E" };
  assert.equal(refusalText("--set material.young=-5: young = -5; must be > 0 (try 1e5)", young), "Young's modulus must be positive.");
  assert.equal(refusalText("--set material.poisson=1: poisson = 1; must be > -1 and < 0.5 (try 0.485)", { label: "Poisson's ratio \u03bd" }), "Poisson's ratio must be > -1 and < 0.5.");
  assert.equal(refusalText("--set gravity=[0, : a list is not closed", { label: "Gravity" }), "Gravity: a list is not closed");
});

test("explanations name settings instead of keys", () => {
  const settings = [{ key: "solver.line_search.test", label: "Decrease test" }, { key: "solver.line_search.c", label: "Slope fraction c" }];
  const [place, remedy] = ["none", "textbook"].map((value) => `solver.line_search.test = "${value}"`);
  assert.equal(`${settingText(place!, settings, false)}. ${settingText(remedy!, settings, true)}.`, 'Line search is off. Choose "Textbook".');
  assert.equal(settingText("solver.line_search.c = 0.9", settings, false), "Slope fraction c is 0.9");
  assert.equal(settingText("solver.line_search.c = 1e-4", settings, true), "Set Slope fraction c to 1e-4");
  assert.equal(settingText("body beam, tet 7", settings, false), "body beam, tet 7");
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

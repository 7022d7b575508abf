import assert from "node:assert/strict";
import { test } from "node:test";
import { faultOfOverrides, parseOverrides, presets, toml } from "../src/presets";
import type { Scene, Setting } from "../src/protocol";

function scene(values: Record<string, Setting["value"]>, implicit = true): Scene {
  const settings = Object.entries(values).map(([key, value]) => ({ key, value }));
  return { implicit, h: 0.01, settings } as unknown as Scene;
}

const overridesOf = (of: Scene, title: string): string[] | undefined =>
  presets(of).find((preset) => preset.title === title)?.overrides;

test("side b gets the other value", () => {
  const title = "Gradient descent or Newton";
  assert.deepEqual(overridesOf(scene({ "solver.method": "newton" }), title), ['solver.method="gradient_descent"']);
  assert.deepEqual(overridesOf(scene({ "solver.method": "gradient_descent" }), title), ['solver.method="newton"']);
});

test("an explicit scene offers no minimizer comparison", () => {
  const explicit = scene({}, false);
  assert.deepEqual(overridesOf(explicit, "Explicit or implicit"), ['time.integrator="backward_euler"']);
  assert.equal(overridesOf(explicit, "Gradient descent or Newton"), undefined);
});

test("ten times a varying modulus is a formula", () => {
  const title = "Ten times as stiff";
  assert.deepEqual(overridesOf(scene({ "material.young": 1e5 }), title), ["material.young=1000000"]);
  assert.deepEqual(overridesOf(scene({ "material.young": "1e5 * X" }), title), ['material.young="10 * (1e5 * X)"']);
  assert.equal(overridesOf(scene({}), title), undefined);
});

test("values are written as TOML", () => {
  assert.equal(toml([0, "X", 2]), '[0, "X", 2]');
  assert.equal(toml(true), "true");
});

test("overrides are one per line, others rejected", () => {
  assert.deepEqual(parseOverrides("a.b=1\n\n  c = 2 \n"), ["a.b=1", "c = 2"]);
  assert.equal(faultOfOverrides(["a.b=1", 'body.bunny.pin.0.where="y < 0.1"']), "");
  assert.match(faultOfOverrides(["a.b"]), /'a.b' is not KEY=VALUE/);
  assert.match(faultOfOverrides([]), /The sides are equal/);
});

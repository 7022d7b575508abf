import assert from "node:assert/strict";
import { test } from "node:test";
import { entryTexts, matrixText, unitText, valueText, vectorText } from "../src/view/values";

test("only units with prefixes get one", () => {
  assert.equal(valueText(12345, "Pa", 3), "12.3 kPa");
  assert.equal(valueText(0.0042, "m"), "4.2 mm");
  assert.equal(valueText(15090, "J/m^3", 3), "15.1 kJ/m³");
  assert.equal(valueText(1000, "kg/m^3"), "1000 kg/m³");
  assert.equal(valueText(3e-7, "m^3"), "3e−7 m³");
  assert.equal(valueText(2, ""), "2");
  assert.equal(unitText("m/s^2"), "m/s²");
});

test("infinite values have a text", () => {
  assert.equal(valueText(null, "Pa"), "not finite");
  assert.equal(valueText(Infinity, ""), "not finite");
});

test("round-off beside large entries is 0", () => {
  assert.deepEqual(entryTexts([1, -3e-17, 0.25]), ["1", "0", "0.25"]);
  assert.deepEqual(entryTexts([1e-17, 2e-17]), ["1e−17", "2e−17"]);
  assert.equal(vectorText([1, 2, 3], "m"), "1  2  3 m");
});

test("matrix columns have equal widths", () => {
  const lines = matrixText([[1, -0.5, 0], [0, 1, 0], [0, 0, 1]], "").split("\n");
  assert.equal(lines.length, 3);
  assert.equal(new Set(lines.map((line) => line.length)).size, 1);
});

import assert from "node:assert/strict";
import { test } from "node:test";
import { numberText, parseNumber, toPosition, toValue } from "../src/panels/scale";

const young = { min: 1e3, max: 1e9, log: true, kind: "number" } as const;
const poisson = { min: 0, max: 0.49, log: false, kind: "number" } as const;

test("a logarithmic slider has equal decades", () => {
  assert.equal(toPosition(1e6, young), 0.5);
  assert.equal(toValue(0.5, young), 1e6);
  assert.equal(toValue(0, young), 1e3);
  assert.equal(toValue(1, young), 1e9);
});

test("values outside a slider's range are clamped", () => {
  assert.equal(toPosition(1e12, young), 1);
  assert.equal(toPosition(0, young), 0);
  assert.equal(toPosition(-1, young), 0);
  assert.equal(toPosition(-1, poisson), 0);
  assert.equal(toPosition(1, { min: 2, max: 2, log: true, kind: "number" }), 0);
});

test("an integer's slider gives integers", () => {
  assert.equal(toValue(0.337, { min: 1, max: 10, log: false, kind: "integer" }), 4);
});

test("a logarithmic range with 0 becomes linear", () => {
  assert.equal(toPosition(5, { min: 0, max: 10, log: true, kind: "number" }), 0.5);
});

test("short numbers read back equal", () => {
  for (const value of [0, 1, -9.81, 1e5, 12345.6, 1e-4, 2.5e-7, 0.01]) assert.equal(parseNumber(numberText(value)), value);
  assert.equal(numberText(1e5), "1e5");
  assert.equal(numberText(0.01), "0.01");
  assert.equal(numberText(15628.4790123), "15628.5");
});

test("rejects text that is no number", () => {
  for (const text of ["", " ", "1e", "2 * X", "NaN", "Infinity"]) assert.equal(parseNumber(text), null);
  assert.equal(parseNumber(" 0,5 "), 0.5);
});

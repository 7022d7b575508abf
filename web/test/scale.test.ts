import assert from "node:assert/strict";
import { test } from "node:test";
import { numberText, parseNumber, toPosition, toValue } from "../src/panels/scale";

const young = { min: 1e3, max: 1e9, log: true, kind: "number" } as const;
const poisson = { min: 0, max: 0.49, log: false, kind: "number" } as const;

test("a logarithmic slider gives each decade the same room", () => {
  assert.equal(toPosition(1e6, young), 0.5);
  assert.equal(toValue(0.5, young), 1e6);
  assert.equal(toValue(0, young), 1e3);
  assert.equal(toValue(1, young), 1e9);
});

test("a value outside of the slider's range is at its end", () => {
  assert.equal(toPosition(1e12, young), 1);
  assert.equal(toPosition(0, young), 0);
  assert.equal(toPosition(-1, young), 0);
  assert.equal(toPosition(-1, poisson), 0);
  assert.equal(toPosition(1, { min: 2, max: 2, log: true, kind: "number" }), 0);
});

test("an integer's slider gives integers", () => {
  assert.equal(toValue(0.337, { min: 1, max: 10, log: false, kind: "integer" }), 4);
});

test("a logarithmic range that reaches 0 is shown linearly", () => {
  assert.equal(toPosition(5, { min: 0, max: 10, log: true, kind: "number" }), 0.5);
});

test("numbers are written shortly and read back as they are", () => {
  for (const value of [0, 1, -9.81, 1e5, 12345.6, 1e-4, 2.5e-7, 0.01]) assert.equal(parseNumber(numberText(value)), value);
  assert.equal(numberText(1e5), "1e5");
  assert.equal(numberText(0.01), "0.01");
  assert.equal(numberText(15628.4790123), "15628.5");
});

test("what is no number is none", () => {
  for (const text of ["", " ", "1e", "2 * X", "NaN", "Infinity"]) assert.equal(parseNumber(text), null);
  assert.equal(parseNumber(" 0,5 "), 0.5);
});

import assert from "node:assert/strict";
import { test } from "node:test";
import { csv, plural, prefixOf, short, tickTexts, withUnit } from "../src/numbers";

test("SI prefixes leave one to three digits", () => {
  assert.equal(withUnit(0.01234, "J"), "12.34 mJ");
  assert.equal(withUnit(-1500, "J"), "−1.5 kJ");
  assert.equal(withUnit(999.99999, "N", 3), "1000 N");
  assert.equal(withUnit(1e-6, "s"), "1 µs");
  assert.equal(withUnit(0, "J"), "0 J");
  assert.equal(withUnit(1e-20, "J"), "1e−20 J");
  assert.equal(prefixOf(1000).letter, "k");
  assert.equal(prefixOf(Number.NaN).letter, "");
});

test("missing values are dashes", () => {
  assert.equal(withUnit(null, "J"), "–");
  assert.equal(short(undefined), "–");
  assert.equal(short(Number.NaN), "–");
  assert.equal(short(Infinity), "∞");
});

test("short numbers have no trailing zeros", () => {
  assert.equal(short(0.001), "0.001");
  assert.equal(short(1.5e-7), "1.5e−7");
  assert.equal(short(123456), "123456");
  assert.equal(short(2e9, 3), "2e9");
  assert.equal(plural(1, "iteration"), "1 iteration");
  assert.equal(plural(0, "iteration"), "0 iterations");
});

test("ticks differ from their neighbors", () => {
  assert.deepEqual(tickTexts([-0.5, 0, 0.5, 1]), ["−0.5", "0", "0.5", "1.0"]);
  assert.deepEqual(tickTexts([1000, 1500, 2000], 1000), ["1.0", "1.5", "2.0"]);
  assert.deepEqual(tickTexts([0, 2500, 5000, 7500], 1000), ["0", "2.5", "5.0", "7.5"]);
  assert.deepEqual(tickTexts([0, 0.025, 0.05]), ["0", "0.025", "0.050"]);
  const fine = tickTexts([391.1960001, 391.1960002, 391.1960003]);
  assert.equal(new Set(fine).size, 3);
  assert.deepEqual(tickTexts([]), []);
});

test("CSV keeps digits and quotes names", () => {
  const x = 0.1 + 0.2;
  assert.equal(
    csv(
      ["a", 'b,"c"'],
      [
        [1, x],
        [null, 2],
      ],
      2,
    ),
    `a,"b,""c"""\n1,\n${x},2\n`,
  );
});

test("numbers beyond all prefixes use powers", () => {
  assert.deepEqual(prefixOf(2.5e83), { factor: 1, letter: "" });
  assert.deepEqual(tickTexts([0, 1e83, 2e83]), ["0", "1e83", "2e83"]);
});

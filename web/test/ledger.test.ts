import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { balanceText, calmRange, CurveColors, explosionText, Ledger, ledgerColumns } from "../src/plots/ledger";
import { stepRow } from "./rowsOfSteps";

const potentials = ["elasticity", "gravity"];
const at = (ledger: Ledger, key: string): (number | null)[] =>
  ledger.columns[ledgerColumns(potentials).findIndex((c) => c.key === key)]!;

// The mouse and an obstacle add energy; damping and the integrator dissipate it. The ledger balances.
function steps(count: number): ReturnType<typeof stepRow>[] {
  let energy = 10;
  return Array.from({ length: count }, (_, i) => {
    const [mouse, obstacle, damping, numerical] = [0.5, 0.25, 0.2, 0.1 * i];
    energy += mouse + obstacle - damping - numerical;
    return stepRow({
      step: i + 1,
      time: 0.1 * (i + 1),
      kinetic: 0.25 * energy,
      potential: [0.5 * energy, 0.25 * energy],
      mouse_work: mouse,
      obstacle_work: obstacle,
      damping_loss: damping,
      numerical_loss: numerical,
    });
  });
}

test("works and losses sum to a constant balance", () => {
  const ledger = new Ledger(potentials);
  ledger.update(steps(50), 0);
  assert.equal(at(ledger, "mouse_work").at(-1), 25);
  assert.ok(at(ledger, "balance").every((value) => Math.abs(value! - 10) < 1e-12));
  assert.ok(ledger.drift().drift < 1e-12);
});

test("single rows and rewinds keep the sums right", () => {
  const rows = steps(30);
  const [whole, grown] = [new Ledger(potentials), new Ledger(potentials)];
  whole.update(rows.slice(0, 21), 0);
  for (let i = 1; i <= 30; ++i) grown.update(rows.slice(0, i), i - 1);
  grown.update(rows.slice(0, 21), 12);
  assert.deepEqual(grown.columns, whole.columns);
  assert.deepEqual(grown.drift(), whole.drift());
});

test("unexplained energy loss is a drift", () => {
  const rows = steps(10);
  rows[5]!.kinetic = rows[5]!.kinetic! - 1;
  const ledger = new Ledger(potentials);
  ledger.update(rows, 0);
  assert.ok(Math.abs(ledger.drift().drift - 1) < 1e-12);
  assert.match(balanceText(1, 10), /drifts by 1 J/);
  assert.match(balanceText(1e-9, 10), /flat to 1 nJ/);
});

test("unknown values stay unknown in sums", () => {
  const rows = steps(3);
  rows[1]!.mouse_work = null;
  const ledger = new Ledger(potentials);
  ledger.update(rows, 0);
  assert.deepEqual(at(ledger, "mouse_work"), [0.5, null, null]);
  assert.deepEqual(
    at(ledger, "balance").map((v) => v === null),
    [false, true, true],
  );
});

test("a ledger continues without its first rows", () => {
  const rows = steps(40);
  const [whole, late] = [new Ledger(potentials), new Ledger(potentials)];
  whole.update(rows, 0);
  late.update(rows.slice(0, 30), 0);
  late.update(rows.slice(20), 30);
  late.update(rows.slice(20), 40);
  assert.deepEqual(late.step, whole.step);
  assert.deepEqual(late.columns, whole.columns);
});

test("old steps are thinned out, sums stay", () => {
  const ledger = new Ledger(potentials);
  const row = stepRow({ mouse_work: 1, potential: [0, 0] });
  for (let from = 0; from < 300_000; from += 10_000)
    ledger.update(Array.from({ length: 10_000 }, (_, i) => ({ ...row, step: from + i + 1 })), from);
  assert.ok(ledger.step.length <= 100_000);
  assert.deepEqual([ledger.step[0], ledger.step.at(-1), ledger.step.at(-2)], [1, 300_000, 299_999]);
  assert.equal(at(ledger, "mouse_work").at(-1), 300_000);
  assert.ok(ledger.step.every((step, i) => i === 0 || step > ledger.step[i - 1]!));
});

test("a blown-up side does not flatten the other", () => {
  const [calm, wild, alike] = [new Ledger(potentials), new Ledger(potentials), new Ledger(potentials)];
  calm.update(steps(20), 0);
  alike.update(steps(10), 0);
  wild.update([...steps(5), stepRow({ step: 6, time: 0.6, kinetic: 1e60, potential: [1e64, 0] })], 0);
  assert.equal(calmRange(calm, alike), null);
  const range = calmRange(calm, wild)!;
  assert.deepEqual(range, calmRange(wild, calm));
  const values = calm.columns.flat().map((value) => value ?? 0);
  assert.ok(range[0] <= Math.min(...values) && range[1] >= Math.max(...values) && range[1] < 1e3);
});

test("zero columns are hidden until nonzero", () => {
  const ledger = new Ledger(["elasticity", "gravity", "probe"]);
  const still = stepRow({ step: 1, time: 0.1, kinetic: 0, potential: [2, 0, 0] });
  const moving = stepRow({ step: 2, time: 0.2, kinetic: 1, potential: [1, 0, 0], mouse_work: 0.5 });
  ledger.update([still], 0);
  assert.deepEqual(ledger.used(), ["potential_elasticity", "potential_total", "total", "balance"]);
  ledger.update([still, moving], 1);
  assert.ok(ledger.used().includes("kinetic") && ledger.used().includes("mouse_work"));
  assert.ok(!ledger.used().includes("potential_probe"));
  ledger.update([still, moving], 1);
  ledger.update([still], 1);
  assert.deepEqual(ledger.used(), ["potential_elasticity", "potential_total", "total", "balance"]);
});

// Coordinates in OKLab, where distances are differences that people see.
function lab(hex: string): number[] {
  const [r, g, b] = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
  const l = Math.cbrt(0.41222147 * r! + 0.53633254 * g! + 0.05144599 * b!);
  const m = Math.cbrt(0.2119035 * r! + 0.68069955 * g! + 0.10739696 * b!);
  const s = Math.cbrt(0.08830246 * r! + 0.28171884 * g! + 0.6299787 * b!);
  return [0.21045426 * l + 0.79361779 * m - 0.00407205 * s, 1.9779985 * l - 2.4285922 * m + 0.4505937 * s, 0.02590404 * l + 0.78277177 * m - 0.80867577 * s];
}

test("no two curves share a family of colors", () => {
  const css = readFileSync(`${import.meta.dirname}/../src/style.css`, "utf8");
  const colors = new CurveColors();
  const keys = ledgerColumns(["a", "b", "c", "d"]).map(({ key }) => key).filter((key) => !/tool|load|muscle|obstacle/.test(key));
  const names = keys.map((key) => colors.of(key).replace(/(\d+)/, "-$1"));
  assert.deepEqual(keys.map((key) => colors.of(key).replace(/(\d+)/, "-$1")), names, "the same at each call");
  for (const theme of [1, 2]) {
    const drawn = names.map((name) => lab(css.match(new RegExp(`--${name}: light-dark\\((#\\w+), (#\\w+)\\)`))![theme]!));
    drawn.forEach((p, i) => drawn.slice(0, i).forEach((q, j) => assert.ok(Math.hypot(...p.map((x, c) => x - q[c]!)) > 0.08, `${names[i]} and ${names[j]}`)));
  }
});

test("works of pins, loads and muscles are apart", () => {
  const ledger = new Ledger(potentials);
  ledger.update([stepRow({ kinetic: 1, potential: [1, 1], pin_work: 0.3 + 1e-17, load_work: 0.1, muscle_work: 0.2 })], 0);
  assert.deepEqual(["load_work", "muscle_work"].map((key) => at(ledger, key).at(-1)), [0.1, 0.2]);
  assert.ok(!ledger.used().includes("pin_work"), "round-off is no work of pins");
  ledger.update([stepRow({ kinetic: 1, potential: [1, 1], pin_work: 0.5, load_work: 0.1, muscle_work: 0.2 })], 0);
  assert.ok(Math.abs(at(ledger, "pin_work").at(-1)! - 0.2) < 1e-15 && ledger.used().includes("pin_work"));
  assert.ok(Math.abs(at(ledger, "balance").at(-1)! - 2.5) < 1e-12);
});

test("an explosion is no flat balance", () => {
  const [calm, wild] = [new Ledger(potentials), new Ledger(potentials)];
  calm.update(steps(50), 0);
  assert.equal(calm.exploded(), null);
  const made = 1e60;
  wild.update([...steps(5), stepRow({ step: 6, time: 0.6, kinetic: made, potential: [1, 0], numerical_loss: -made })], 0);
  assert.ok(wild.drift().drift < 1e-9 * made, "the books are balanced: the loss is negative");
  assert.equal(wild.exploded(), made + 1);
  assert.match(explosionText(made), /exploded: .* 1e60 J without work/);
  wild.update(steps(5), 5);
  assert.equal(wild.exploded(), null);
});

test("falls and mouse work are no explosions", () => {
  const fall = new Ledger(potentials);
  const row = (step: number, kinetic: number, more = {}): ReturnType<typeof stepRow> =>
    stepRow({ step, time: 0.1 * step, kinetic, potential: [0, -kinetic + 1e-9], ...more });
  fall.update([row(1, 0), row(2, 100), row(3, 1e6)], 0);
  assert.equal(fall.exploded(), null);
  const pulled = new Ledger(potentials);
  pulled.update([row(1, 0), stepRow({ step: 2, time: 0.2, kinetic: 50, potential: [0, 0], mouse_work: 50 })], 0);
  assert.equal(pulled.exploded(), null);
});

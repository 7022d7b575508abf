import assert from "node:assert/strict";
import { test } from "node:test";
import { balanceText, Ledger, ledgerColumns } from "../src/plots/ledger";
import { stepRow } from "./rowsOfSteps";

const potentials = ["elasticity", "gravity"];
const at = (ledger: Ledger, key: string): (number | null)[] =>
  ledger.columns[ledgerColumns(potentials).findIndex((c) => c.key === key)]!;

// Energy comes in by the mouse and goes out by damping and the integrator; nothing is lost from the books.
function steps(count: number): ReturnType<typeof stepRow>[] {
  let energy = 10;
  return Array.from({ length: count }, (_, i) => {
    const [mouse, damping, numerical] = [0.5, 0.2, 0.1 * i];
    energy += mouse - damping - numerical;
    return stepRow({
      step: i + 1,
      time: 0.1 * (i + 1),
      kinetic: 0.25 * energy,
      potential: [0.5 * energy, 0.25 * energy],
      mouse_work: mouse,
      damping_loss: damping,
      numerical_loss: numerical,
    });
  });
}

test("works and losses are summed up, and the balance is flat", () => {
  const ledger = new Ledger(potentials);
  ledger.update(steps(50), 0);
  assert.equal(at(ledger, "mouse_work").at(-1), 25);
  assert.ok(at(ledger, "balance").every((value) => Math.abs(value! - 10) < 1e-12));
  assert.ok(ledger.drift().drift < 1e-12);
});

test("rows may come one by one, and a rewind takes back the sums", () => {
  const rows = steps(30);
  const [whole, grown] = [new Ledger(potentials), new Ledger(potentials)];
  whole.update(rows.slice(0, 21), 0);
  for (let i = 1; i <= 30; ++i) grown.update(rows.slice(0, i), i - 1);
  grown.update(rows.slice(0, 21), 12);
  assert.deepEqual(grown.columns, whole.columns);
  assert.deepEqual(grown.drift(), whole.drift());
});

test("a step that loses energy from the books shows as a drift", () => {
  const rows = steps(10);
  rows[5]!.kinetic = rows[5]!.kinetic! - 1;
  const ledger = new Ledger(potentials);
  ledger.update(rows, 0);
  assert.ok(Math.abs(ledger.drift().drift - 1) < 1e-12);
  assert.match(balanceText(1, 10), /drifts by 1 J/);
  assert.match(balanceText(1e-9, 10), /flat to 1 nJ/);
});

test("what is not known stays unknown, also in sums", () => {
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

// Detects from the energy that a motion has blown up: the integrator and the solver's residuals have added more than
// half of the kinetic energy. A body in free fall does not do that, however far it moves.
import type { SideName, StepRow } from "./protocol";
import type { Store } from "./store";

const kShare = 0.5; // threshold relative to the kinetic energy

export function hasBlownUp(rows: readonly StepRow[], step: number): boolean {
  let gained = 0;
  let last: StepRow | null = null;
  for (const row of rows) {
    if (row.step > step) break;
    if (row.step === 0) continue; // initial state
    last = row;
    gained += (row.residual_work ?? NaN) - (row.numerical_loss ?? NaN);
  }
  return last !== null && !(gained <= kShare * (last.kinetic ?? NaN));
}

export function sideHasBlownUp(store: Store, side: SideName): boolean {
  return hasBlownUp(store.side(side)?.steps ?? [], store.state?.[side]?.step ?? 0);
}

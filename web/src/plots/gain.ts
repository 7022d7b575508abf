// Whether a motion has blown up: judged by its energy. The integrator and what the solver left over have added more than
// half of the kinetic energy; no body in free fall or in flight does that, however far it goes.
import type { StepRow } from "../protocol";

const kShare = 0.5; // of the kinetic energy

export function hasBlownUp(rows: readonly StepRow[], step: number): boolean {
  let gained = 0;
  let last: StepRow | null = null;
  for (const row of rows) {
    if (row.step > step) break;
    if (row.step === 0) continue; // the start
    last = row;
    gained += (row.residual_work ?? NaN) - (row.numerical_loss ?? NaN);
  }
  return last !== null && !(gained <= kShare * (last.kinetic ?? NaN));
}

// Generated from the description of step reports (src/dynamics/step_fields.cpp). Do not edit.
import type { MaybeNumber } from "./numbers";

export interface StepFields {
  step: number; // 0 is the start
  time: MaybeNumber; // time at the end of the step [s]
  status: string; // start in row 0; success: converged, round_off; otherwise budget, iteration_limit, stuck, no_descent, undefined, inaccurate, inverted, unstable
  converged: boolean; // whether the status is a success
  residual: MaybeNumber; // norm of M a + dV/dx + dD/dx over free vertices [N]
  residual_threshold: MaybeNumber; // its threshold [N]
  min_det_F: MaybeNumber; // smallest volume ratio of any tet; negative: inverted [1]
  kinetic: MaybeNumber; // kinetic energy [J]
  contacts: number; // pairs of surface features in contact
  min_gap: MaybeNumber; // smallest distance between surfaces in contact; 0 without contacts [m]
  min_gap_pair: string; // bodies or obstacles with this gap
  max_pressure: MaybeNumber; // largest contact pressure [Pa]
  gap_error: MaybeNumber; // bound of the gap that remains between surfaces in contact: their largest reach [m]
  contact_force_error: MaybeNumber; // statics: estimate of the relative excess of contact forces [1]
  friction_loss: MaybeNumber; // share of friction in damping_loss [J]
  friction_creep: MaybeNumber; // largest slip of a sticking contact in this step [m]
  friction_residual: MaybeNumber; // change of friction by the last update of normal forces [N]
  attachment_gap: MaybeNumber; // largest difference of the distance of attached points from its rest length [m]
  mesh_stiffness: MaybeNumber; // estimated excess of stiffness of the worst body; 0: not computed [1]
  mesh_energy: MaybeNumber; // estimated energy above the minimum [J]
  mesh_worst_tet: number; // tet with its largest density; -1: none
  mesh_error: string; // the estimate in words
  potential: MaybeNumber[]; // energy of each term of V and of viscoelastic branches; a dead load has -f . x, not zero at rest [J]
  pin_work: MaybeNumber; // work of moving pins, moving spring targets, time-dependent loads and muscles in this step [J]
  load_work: MaybeNumber; // share of moving spring targets and time-dependent loads in pin_work [J]
  muscle_work: MaybeNumber; // share of muscles in pin_work [J]
  obstacle_work: MaybeNumber; // work of moving obstacles [J]
  nonconservative_work: MaybeNumber; // work of wind, and of pressures on open patches beyond the change of their potential [J]
  damping_loss: MaybeNumber; // energy dissipated by damping and friction [J]
  viscoelastic_loss: MaybeNumber; // share of viscoelastic branches in damping_loss [J]
  numerical_loss: MaybeNumber; // energy dissipated by the integrator; in statics no loss: forces at the end of the step times its path minus the change of energy [J]
  residual_work: MaybeNumber; // work of the residual [J]
  ledger_error: MaybeNumber; // remaining imbalance [J]
  decrement: MaybeNumber; // Newton decrement -g.d / 2 of the last iteration [J]
  energy_bound: string; // holds, broken, not_guaranteed, none: the bound of backward Euler
  energy_slack: MaybeNumber; // bound minus energy [J]
  state_hash: string | null; // hash of the state
  seconds: MaybeNumber; // wall time [s]
}

// Values for a step that has not ended.
export const kUnknownStep: StepFields = {
  step: 0,
  time: null,
  status: "",
  converged: false,
  residual: null,
  residual_threshold: null,
  min_det_F: null,
  kinetic: null,
  contacts: 0,
  min_gap: null,
  min_gap_pair: "",
  max_pressure: null,
  gap_error: null,
  contact_force_error: null,
  friction_loss: null,
  friction_creep: null,
  friction_residual: null,
  attachment_gap: null,
  mesh_stiffness: null,
  mesh_energy: null,
  mesh_worst_tet: 0,
  mesh_error: "",
  potential: [],
  pin_work: null,
  load_work: null,
  muscle_work: null,
  obstacle_work: null,
  nonconservative_work: null,
  damping_loss: null,
  viscoelastic_loss: null,
  numerical_loss: null,
  residual_work: null,
  ledger_error: null,
  decrement: null,
  energy_bound: "",
  energy_slack: null,
  state_hash: null,
  seconds: null,
};

// The record of a time step. Its status is a success only if the step converged.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "contact/contact_cost.h"
#include "dynamics/initial_guess.h"
#include "energy/cavity.h"
#include "math/small.h"
#include "optimize/minimize.h"

namespace aspic {

struct Resultant {
  Vec3d force{};   // [N]
  Vec3d moment{};  // about the origin [N m]
};

// External forces, each summed over its vertices.
struct Resultants {
  std::vector<Resultant> pins;    // resultant of each of Model::pins, mean over the step
  std::vector<Resultant> loads;   // resultant of each of Model::loads, at the end of the step
  std::vector<Resultant> bodies;  // sum of all pins and loads on each body, mean over the step; 0 in equilibrium
  double time = 0;                // averaging time so far [s]
};

// Result of the check against the energy bound of backward Euler.
enum class EnergyBound {
  none,            // another scheme, or a dropped step
  not_guaranteed,  // the minimizer ended above E at q_s, or E at q_s is infinite
  holds,
  broken,
};
std::string_view to_string(EnergyBound bound);

struct StepReport : Work {  // work of all solves of the step and of this report
  int step = 0;             // 1 for the first
  double time = 0;          // time at the end of the step [s]

  Status status = Status::converged;                       // the worst over all solves
  Criterion criterion = Criterion::scale;                  // convergence test of the minimizations
  int iterations = 0, trials = 0, projected_hessians = 0;  // sums over all solves
  int carries = 0;                                         // Newton directions that carried bodies with obstacles
  int elements = 0;                                        // number of tets per evaluation
  double objective = 0, objective_gradient = 0;            // E and |g| at the end of the last minimization
  InitialGuess initial_guess = InitialGuess::none;         // initial guess of the last minimization
  int substeps = 1, rejected = 0;                          // accepted and rejected
  double residual = 0;  // |M a + dV/dx + dD/dx| over the free vertices; maximum over substeps [N]
  // For the body or region that is farthest from its threshold:
  double residual_threshold = 0;  // required residual [N]; 0 for explicit schemes
  double residual_round_off = 0;  // the round-off floor of the residual [N]
  int worst_vertex = -1;          // vertex with the largest residual
  double worst_residual = 0;      // its residual [N]
  double lost_accuracy = 0;       // fraction of forces or velocities lost to round-off; 0 if it is tolerable
  double decrement = 0;           // -g.d / 2 of the last iteration, maximum over solves [J]; 0 without iterations
  double min_det_F = 0;           // minimum over all tets at the end [1]; negative: inverted

  // Contact at the end of the step.
  int contacts = 0;          // pairs of features closer than their reach
  double min_gap = 0;        // smallest distance of these [m]; 0 without contacts
  std::string min_gap_pair;  // names of the parts that have it
  double max_pressure = 0;   // [Pa]
  double gap_error = 0;      // bound of the gap that remains between surfaces in contact: their largest reach [m]
  // Statics: estimate of the relative excess of contact forces, if pins and obstacles press bodies together: work of
  // the contact forces along their gaps over twice the elastic energy [1].
  double contact_force_error = 0;
  double friction_loss = 0;           // share of friction in damping_loss [J]
  double friction_creep = 0;          // largest slip of sticking contacts in the step [m]
  double friction_residual = 0;       // change of the friction forces by the last update of the normal forces [N]
  std::string friction_pair;          // parts where it is largest
  std::vector<CavityState> cavities;  // of each Cavity among Model::loads, at the end
  double step_limit = std::numeric_limits<double>::infinity();  // bound of the last step length by contact
  // Evaluations of lagged coefficients: normal forces of friction, rims of pressures. 1 without them, 0 without
  // minimization.
  int friction_passes = 0;

  // Ledger: kinetic + potential changes by pin_work + obstacle_work + nonconservative_work - damping_loss -
  // numerical_loss + residual_work. [J]
  double kinetic = 0;  // at the end of the step
  // One per term of V, then the energies stored by internal variables; named by Simulation::potential_names().
  std::vector<double> potential;
  double potential_total = 0;       // sum of `potential`
  double pin_work = 0;              // work of moving pins and moving targets in this step
  double load_work = 0;             // share of moving spring targets and time-dependent loads in pin_work
  double muscle_work = 0;           // share of muscles with changing activation in pin_work
  double obstacle_work = 0;         // work of moving obstacles on bodies, including friction, in this step
  std::vector<double> target_work;  // share of the moving targets of each of Model::loads
  double nonconservative_work = 0;  // work of wind, and of pressures on open patches beyond the loss of their potential
  double damping_loss = 0;          // energy dissipated by damping and friction in this step
  double viscoelastic_loss = 0;     // share of the terms with internal variables in damping_loss
  double numerical_loss = 0;        // energy dissipated by the integrator in this step
  double residual_work = 0;         // work of the residual forces
  double ledger_error = 0;          // difference of both sides
  Resultants resultants;            // external forces on pins, loads and bodies
  EnergyBound energy_bound = EnergyBound::none;
  double energy_slack = 0;  // bound minus energy; 0 without a bound [J]
  // Estimate of the discretization error, see MeshErrorEstimate: of the worst body, and of all; 0: none was computed.
  double mesh_stiffness = 0;         // [1]
  double mesh_energy = 0;            // [J]
  int mesh_worst_tet = -1;           // in the user's numbers
  std::string mesh_error;            // in words; empty: none was computed
  std::vector<double> mesh_density;  // of each tet of the model [J/m^3]
  std::uint64_t state_hash = 0;      // hash of the state at the end, see state_hash()
  double seconds = 0;                // wall time of the step
  double cpu_seconds = 0;            // CPU time of the process
  ContactCost contact_cost;
  double attachment_gap = 0;  // Attachment::largest_gap() of Model::loads at the end [m]
};

}  // namespace aspic

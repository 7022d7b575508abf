// What is known of a step after it was taken. A step that did not converge says so here.
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "dynamics/initial_guess.h"
#include "math/small.h"
#include "optimize/minimize.h"

namespace aspic {

using Consent = std::function<bool()>;  // asked between the parts of an adaptive step; empty: always given
inline constexpr double kNoTimeLimit = std::numeric_limits<double>::infinity();

struct Resultant {
  Vec3d force{};   // [N]
  Vec3d moment{};  // about the origin [N m]
};

// The forces that act from outside, each as a sum over vertices.
struct Resultants {
  std::vector<Resultant> pins;    // of each of Model::pins: what it exerts on its vertices, the mean over the step
  std::vector<Resultant> loads;   // of each of Model::loads, at the end of the step
  std::vector<Resultant> bodies;  // of each body: all pins and loads on it, the mean over the step; 0 in equilibrium
  double time = 0;                // over which the means are taken so far [s]
};

// Whether a step of backward Euler kept the bound that the scheme guarantees.
enum class EnergyBound {
  none,            // another scheme, or a step that was dropped
  not_guaranteed,  // the minimiser ended above E at q_s, or q_s has no energy
  holds,
  broken,
};
std::string_view to_string(EnergyBound bound);

struct StepReport : Work {  // of all its solves, and of what is reported here
  int step = 0;             // 1 for the first
  double time = 0;          // at the end of the step [s]

  Status status = Status::converged;
  Criterion criterion = Criterion::scale;
  int iterations = 0, trials = 0, projected_hessians = 0;  // of all its solves
  int elements = 0;                                        // tets: what an evaluation goes over
  double objective = 0, objective_gradient = 0;            // E and |g| at the end of the last minimisation
  InitialGuess initial_guess = InitialGuess::none;         // where that started
  int substeps = 1, rejected = 0;                          // parts it was taken in; parts tried that were too long
  double residual = 0;  // |M a + dV/dx + dD/dx| over the free vertices; of parts the largest [N]
  // Of the part of the model that is farthest from its threshold, such as one of several bodies:
  double residual_threshold = 0;  // the residual that was asked for [N]; 0 for a scheme without a solve
  double residual_round_off = 0;  // the part of a residual that double precision cannot tell from zero [N]
  int worst_vertex = -1;          // where most of the residual is left
  double worst_residual = 0;      // its size there [N]
  double lost_accuracy = 0;       // of weight, inertia or velocities, hidden by round-off: from 1e-3 to 1; else 0
  double decrement = 0;           // -g.d / 2 of the last iteration, of solves the largest; 0 without one [J]
  double min_det_F = 0;

  // The ledger: kinetic + potential changes by pin_work - damping_loss - numerical_loss + residual_work. [J]
  double kinetic = 0;
  std::vector<double> potential;  // one per term of V, named by Simulation::potential_names()
  double potential_total = 0;
  double pin_work = 0;              // by moving pins and moving targets of springs, in this step
  std::vector<double> target_work;  // of that, by the moving targets of each of Model::loads
  double damping_loss = 0;          // by damping terms, in this step
  double numerical_loss = 0;        // by the integrator, in this step
  double residual_work = 0;         // by the forces that the solve left over
  double ledger_error = 0;          // what does not add up
  Resultants resultants;
  EnergyBound energy_bound = EnergyBound::none;
  double energy_slack = 0;       // by how much the bound holds; 0 where there is none [J]
  std::uint64_t state_hash = 0;  // of the state at the end, see state_hash()
  double seconds = 0;            // wall time of the step
};

}  // namespace aspic

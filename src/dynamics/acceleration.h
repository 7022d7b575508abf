// Computes acc(q, v) from M acc = -dV/dx - C v by a solve with the mass matrix.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/integrator.h"

namespace aspic {

// The difference quotient that gives C v from a damping potential D, for a displacement h v in the time h.
enum class DampingDifference {
  forward,  // dD/dx at q + h v: first order in h where C depends on x
  central,  // half the difference to q - h v: second order
};

struct MotionPoint {
  double time;                   // [s]
  std::span<const double> q, v;  // [m], [m/s]
  DampingDifference difference;
  double weight;  // of its forces in those of the step
};

class Acceleration {
 public:
  // On entry `acc` holds the accelerations of pinned vertices, on return all of them [m/s^2]. Adds the forces times
  // at.weight to `forces`. Returns false if the mass solve failed.
  bool solve(const StepTools& tools, const MotionPoint& at, std::span<double> acc, StepForces& forces, Work& work);

  // Returns a bound of the residual M acc + G + C that the mass solve leaves [N].
  double noise() const { return noise_; }

 private:
  void add_damping(const StepTools& tools, const MotionPoint& at, double h, double scale);
  SolveReport solve_mass(const StepTools& tools, std::span<const double> force, std::span<double> acc);

  std::unique_ptr<LinearSolver> solver_;
  std::optional<BlockSparse> M_;
  std::vector<double> gradient_, damping_, drift_, force_, scratch_;
  bool factorized_ = false;
  double noise_ = 0;
};

}  // namespace aspic

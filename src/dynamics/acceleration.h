// acc(q, v) of M acc = -dV/dx - C v, by a solve with the mass matrix.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/integrator.h"

namespace aspic {

// How C v is taken from a damping potential D, whose force is that of a displacement h v over the time h.
enum class DampingDifference {
  forward,  // dD/dx at q + h v: first order in h where C depends on x
  central,  // half the difference to q - h v: second order
};

class Acceleration {
 public:
  // `acc` holds the accelerations of the pinned vertices before, all afterwards [m/s^2]. `time` is that of q and v.
  // Adds what acted, times `weight`, to `forces`. False: the mass matrix could not be solved with.
  bool solve(const StepTools& tools, double time, std::span<const double> q, std::span<const double> v,
             DampingDifference difference, double weight, std::span<double> acc, StepForces& forces, Work& work);

  // What the solve with the mass matrix may have left of the force, which is all that it leaves of M acc + G + C. [N]
  double noise() const { return noise_; }

 private:
  void add_damping(const StepTools& tools, std::span<const double> q, std::span<const double> v, double h,
                   double scale);
  SolveReport solve_mass(const StepTools& tools, std::span<const double> force, std::span<double> acc);

  std::unique_ptr<LinearSolver> solver_;
  std::optional<BlockSparse> M_;
  std::vector<double> gradient_, damping_, drift_, force_, scratch_;
  bool factorized_ = false;
  double noise_ = 0;
};

}  // namespace aspic

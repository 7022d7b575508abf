// Computes acc(q, v) from M acc = -dV/dx - C v with a mass matrix solve.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/integrator.h"

namespace aspic {

// Difference quotient that computes C v from a damping potential D, for a displacement h v in the time h.
enum class DampingDifference {
  forward,  // dD/dx at q + h v: first order in h if C depends on x
  central,  // half the difference to q - h v: second order
};

struct MotionPoint {
  double time;                   // [s]
  std::span<const double> q, v;  // [m], [m/s]
  DampingDifference difference;
  double weight;  // weight of its forces in the step's forces
};

class Acceleration {
 public:
  // On entry `acc` contains the accelerations of pinned vertices, on return those of all vertices [m/s^2]. Adds the
  // forces times at.weight to `forces`. Returns false if the mass solve failed.
  bool solve(const StepTools& tools, const MotionPoint& at, std::span<double> acc, StepForces& forces, Work& work);

  // Returns a bound of the residual M acc + G + C of the mass solve [N].
  double round_off() const { return round_off_; }

 private:
  void add_damping(const StepTools& tools, const MotionPoint& at, double h, double scale);
  void add_wind(const StepTools& tools, const MotionPoint& at);
  SolveReport solve_mass(const StepTools& tools, std::span<const double> force, std::span<double> acc);

  std::unique_ptr<LinearSolver> solver_;
  std::optional<BlockSparse> M_;
  std::vector<double> gradient_, damping_, drift_, force_, scratch_;
  bool factorized_ = false;
  double round_off_ = 0;
};

}  // namespace aspic

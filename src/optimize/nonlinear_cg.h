// Nonlinear conjugate gradients: p = -B^-1 g + beta p_previous; d is p scaled to the minimum of the quadratic model.
#pragma once
#include <vector>

#include "optimize/model_step.h"
#include "optimize/preconditioner.h"
#include "optimize/search_direction.h"

namespace aspic {

class NonlinearCG : public SearchDirection {
 public:
  explicit NonlinearCG(Preconditioner B) : B_(std::move(B)) {}
  std::string_view name() const override { return "nonlinear_cg"; }
  std::string description() const override;
  void begin() override;
  bool compute(const Iterate& at, std::span<double> d, DirectionReport& report) override;
  bool fall_back() override;  // restarts with d = -B^-1 g

 private:
  double beta(Objective& E, std::span<const double> g);

  Preconditioner B_;
  ModelStep length_;
  bool remembers_ = false, conjugate_ = false;  // a previous direction is stored; the last direction used it
  std::vector<double> p_, z_;                   // direction, B^-1 g
  std::vector<double> last_g_, last_z_;
};

}  // namespace aspic

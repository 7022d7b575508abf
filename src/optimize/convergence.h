// Convergence criteria of a minimization. Each part of the gradient is tested separately.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "optimize/minimize.h"

namespace aspic {

class Convergence {
 public:
  // Starts at the first iterate with its gradient g. E and options must outlive this minimization.
  void begin(Objective& E, const MinimizeOptions& options, std::span<const double> g);
  void measure(std::span<const double> g);  // measures the next iterate
  void note_hessian();                      // updates the round-off of the gradient after a new Hessian

  // Writes `reached` and `threshold` of the part that is farthest from its threshold; writes `reached` only if the
  // criterion tests the gradient.
  void describe(MinimizeReport& report);
  // Returns the norm of direction d that the criterion tests.
  double size_of_direction(std::span<const double> g, std::span<const double> d);
  // Returns whether a direction of this size, computed as reported, implies convergence.
  bool is_near_minimum(double size, const DirectionReport& made);
  // See HasParts::lost_accuracy(). 0 if the tolerance allows as much.
  double lost_accuracy(std::span<const double> x);
  // Failed line searches count as round-off where gradients are within this multiple of their rounding errors.
  static constexpr double kRoundOffMargin = 100;
  // Returns whether every part has converged or is within `margin` times its round-off.
  bool is_at_round_off(double margin) const;
  // Accounts for the share of unconverged parts in g, because linear solves measure the residual of all parts together.
  InnerAccuracy inner_accuracy(const MinimizeReport& report) const;

  bool tests_direction() const { return aspic::tests_direction(options_->criterion); }
  std::span<const double> thresholds() const { return thresholds_; }

 private:
  double threshold(size_t part) const;

  Objective* E_ = nullptr;
  HasParts* parts_of_E_ = nullptr;
  std::optional<WholePart> whole_;
  const MinimizeOptions* options_ = nullptr;
  std::vector<GradientPart> parts_;                            // measures of the last gradient
  std::vector<double> first_norms_, thresholds_, round_offs_;  // per part
  bool is_modified_ = false;                                   // whether the last direction used a modified Hessian
};

}  // namespace aspic

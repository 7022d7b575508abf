// Whether the iterates of a minimization have converged: each part of the gradient by itself.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "optimize/minimize.h"

namespace aspic {

class Convergence {
 public:
  // At the first iterate, where the gradient is g. Both stay while this is used.
  void begin(Objective& E, const MinimizeOptions& options, std::span<const double> g);
  void measure(std::span<const double> g);  // at the next iterate
  void note_hessian();                      // of the last direction: the round-off of the gradient depends on it

  // Threshold and size of the part that is farthest from its threshold; the size only where the criterion judges the
  // gradient.
  void describe(MinimizeReport& report);
  // Of a direction d: what the criterion sees of it.
  double size_of_direction(std::span<const double> g, std::span<const double> d);
  // Whether the direction that was made so, of that size, says that the minimum is near.
  bool is_near_minimum(double size, const DirectionReport& made);
  // How much of the known forces is hidden in the gradient at x.
  double lost_accuracy(std::span<const double> x) { return parts_of_E_->lost_accuracy(x, parts_); }
  // Whether every part has converged or is within `margin` times its round-off.
  bool is_at_round_off(double margin) const;
  // Linear solves see the whole of g, of which a part that has not converged may be a small share.
  InnerAccuracy inner_accuracy(const MinimizeReport& report) const;

  bool judges_direction() const { return aspic::judges_direction(options_->criterion); }
  std::span<const double> thresholds() const { return thresholds_; }

 private:
  double threshold(size_t part) const;

  Objective* E_ = nullptr;
  HasParts* parts_of_E_ = nullptr;
  std::optional<WholePart> whole_;
  const MinimizeOptions* options_ = nullptr;
  std::vector<GradientPart> parts_;                            // of the last gradient
  std::vector<double> first_norms_, thresholds_, round_offs_;  // of each part
  bool is_modified_ = false;                                   // the Hessian behind the last direction
};

}  // namespace aspic

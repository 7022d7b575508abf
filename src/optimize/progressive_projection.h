// Which elements are projected by progressively projected Newton [Fernandez-Fernandez et al. 2026]: those with a vertex
// whose residual is above a threshold. The threshold falls when a direction is of no use and rises with success, so
// that few elements lose their exact Hessians: those where most is left to be done.
#pragma once
#include <span>
#include <vector>

#include "linalg/projection.h"

namespace aspic {

class ProgressiveProjection {
 public:
  void begin() { threshold_ = kNone; }

  // At this residual g, 3 numbers per vertex; valid until the next call.
  Projection at(std::span<const double> g);
  bool is_complete() const { return covers_all_; }  // whether the last one covered every element
  void tighten(std::span<const double> g);          // cover more
  void relax();                                     // cover less

 private:
  static constexpr double kNone = -1;  // nothing is projected
  double threshold_ = kNone;
  bool covers_all_ = false;
  std::vector<char> marked_;
};

}  // namespace aspic

// Selection of elements with modified Hessians in progressively projected Newton [Fernandez-Fernandez et al. 2026]:
// those with a vertex whose residual exceeds a threshold. The threshold decreases after a failed direction and
// increases after a successful one, so that few elements are modified.
#pragma once
#include <span>
#include <vector>

#include "linalg/projection.h"

namespace aspic {

class ProgressiveProjection {
 public:
  void begin() { threshold_ = kNone; }

  // Returns the selection for the residual g, 3 entries per vertex. Valid until the next call.
  Projection at(std::span<const double> g);
  bool is_complete() const { return covers_all_; }  // whether the last selection contains every element
  void tighten(std::span<const double> g);          // selects more elements
  void relax();                                     // selects fewer elements

 private:
  static constexpr double kNone = -1;  // no element is modified
  double threshold_ = kNone;
  bool covers_all_ = false;
  std::vector<char> marked_;
};

}  // namespace aspic

// Relative residual eta of the linear systems of Newton's method: |H d + g| <= eta |g|. It is large far from the
// minimum and small near it, so that convergence is superlinear.
#pragma once
#include "optimize/search_direction.h"

namespace aspic {

// eta = 0.9 (|g| / |g_previous|)^2 with a safeguard [Eisenstat and Walker 1996, choice 2].
class Forcing {
 public:
  void begin() { last_norm_ = 0; }
  // Returns eta at the next iterate, or again at the same one, within the bounds of `accuracy`.
  double at(double gradient_norm, const InnerAccuracy& accuracy);

 private:
  double last_norm_ = 0;  // 0: none yet
  double eta_ = 0;
};

}  // namespace aspic

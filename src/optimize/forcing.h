// How exactly the linear systems of Newton's method are solved: |H d + g| <= eta |g|. Loose while the minimum is far
// away and tight near it, so that convergence stays superlinear.
#pragma once
#include "optimize/search_direction.h"

namespace aspic {

// eta = 0.9 (|g| / |g before|)^2, and not much below the eta before [Eisenstat and Walker 1996, choice 2].
class Forcing {
 public:
  void begin() { last_norm_ = 0; }
  // At the next iterate, or again at the same one; within what `accuracy` allows.
  double at(double gradient_norm, const InnerAccuracy& accuracy);

 private:
  double last_norm_ = 0;  // 0: there is none yet
  double eta_ = 0;
};

}  // namespace aspic

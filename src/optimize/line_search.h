// Backtracking line search: try alpha_max, then shrink by p until E has decreased enough.
#pragma once
#include <span>
#include <vector>

#include "base/deadline.h"
#include "optimize/objective.h"
#include "optimize/work.h"

namespace aspic {

enum class DecreaseTest {
  textbook,  // E(x + alpha d) <= E(x) + c alpha g.d   (Armijo)
  slide,     // E(x + alpha d) <= E(x) + c g.d         (as printed in the lecture: alpha is missing)
  none,      // accept alpha_max: Newton's method without a line search
};

struct LineSearchOptions {
  double alpha_max = 1;
  double sufficient_decrease = 1e-4;  // c, in (0, 1)
  double shrink = 0.5;                // p, in (0, 1)
  double tolerance = 1e-10;           // tol: smaller steps are given up as stuck
  DecreaseTest test = DecreaseTest::textbook;
  Deadline deadline = {};  // no further trial afterwards; the first is made
};

struct Trial {
  double alpha = 0;
  double value = 0;       // E(x + alpha d)
  double bound = 0;       // the largest value that the test accepts
  bool by_slope = false;  // the difference to E(x) drowns in round-off: judged by the slope at the trial
  bool accepted = false;
};

struct LineSearchResult {
  double alpha = 0;             // 0: stuck
  Evaluation value;             // at x + alpha d
  int gradients = 0;            // evaluated
  bool gradient_known = false;  // `trial_gradient` holds the gradient at the accepted trial
};

// Near convergence the differences of E drown in round-off; a trial whose value lies within that noise, when the
// decrease that is asked for does too, is judged by the slope there (approximate Wolfe condition, [Hager and Zhang
// 2005]). `trial` receives x + alpha d, and `trials` every one that was made.
LineSearchResult backtrack(Objective& E, std::span<const double> x, std::span<const double> d, const Evaluation& value,
                           double slope /* g.d */, const LineSearchOptions& options, std::span<double> trial,
                           std::span<double> trial_gradient, std::vector<Trial>& trials);

}  // namespace aspic

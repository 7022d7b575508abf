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
  double tolerance = 1e-10;           // tol: the search is stuck at smaller steps
  DecreaseTest test = DecreaseTest::textbook;
  Deadline deadline = {};  // no trials afterwards, except the first
};

struct Trial {
  double alpha = 0;
  double value = 0;       // E(x + alpha d)
  double bound = 0;       // the largest value that the test accepts
  bool by_slope = false;  // the difference to E(x) is below round-off; judged by the slope at the trial
  bool accepted = false;
};

struct LineSearchResult {
  double alpha = 0;             // 0: stuck
  Evaluation value;             // at x + alpha d
  int gradients = 0;            // evaluated
  bool gradient_known = false;  // `trial_gradient` holds the gradient at the accepted trial
};

// Searches along d from x. Near convergence differences of E are below round-off: if both the difference and the
// required decrease are, the slope at the trial decides (approximate Wolfe condition, [Hager and Zhang 2005]). Writes x
// + alpha d to `trial`, its gradient to `trial_gradient` if computed, and all trials to `trials`.
LineSearchResult backtrack(Objective& E, std::span<const double> x, std::span<const double> d, const Evaluation& value,
                           double slope /* g.d */, const LineSearchOptions& options, std::span<double> trial,
                           std::span<double> trial_gradient, std::vector<Trial>& trials);

}  // namespace aspic

// Backtracking line search: try alpha_max, then shrink by p until E has decreased enough.
#pragma once
#include <span>

#include "optimize/objective.h"

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
};

struct LineSearchResult {
  double alpha = 0;  // 0: stuck
  double value = 0;  // E(x + alpha d)
  int trials = 0;
  bool gradient_known = false;  // `trial_gradient` holds the gradient at the accepted trial
};

// Near convergence the differences of E drown in round-off; a trial whose value lies within that noise is then judged
// by the slope there (approximate Wolfe condition, [Hager and Zhang 2005]). `trial` receives x + alpha d.
LineSearchResult backtrack(Objective& E, std::span<const double> x, std::span<const double> d, double value,
                           double slope /* g.d */, const LineSearchOptions& options, std::span<double> trial,
                           std::span<double> trial_gradient);

}  // namespace aspic

// Backtracking line search: starts with alpha_max and multiplies it by p until E decreases sufficiently.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "base/stop_token.h"
#include "optimize/objective.h"
#include "optimize/work.h"

namespace aspic {

enum class DecreaseTest {
  textbook,  // E(x + alpha d) <= E(x) + c alpha g.d   (Armijo)
  slide,     // E(x + alpha d) <= E(x) + c g.d (as printed in the lecture: alpha is missing)
  none,      // accept alpha_max: Newton's method without a line search
};

struct SearchLine;

struct LineSearchOptions {
  double alpha_max = 1;               // first step length, > 0
  double sufficient_decrease = 1e-4;  // c, in (0, 1)
  double shrink = 0.5;                // p, in (0, 1)
  double tolerance = 1e-10;           // smallest alpha; the search then ends as stuck
  DecreaseTest test = DecreaseTest::textbook;
  // Replaces backtracking, if set: returns alpha, which is accepted up to max_step() wherever E is finite. 0: stuck.
  std::function<double(const SearchLine&)> custom = {};
};

// A step length that the search tested.
struct Trial {
  double alpha = 0;
  double value = 0;       // E(x + alpha d)
  double bound = 0;       // largest accepted value
  bool by_slope = false;  // tested by the slope, because the difference to E(x) is below round-off
  bool accepted = false;
};

// A line to search: x + alpha d, with E(x) and the slope g.d there.
struct SearchLine {
  Objective& E;
  std::span<const double> x, d;
  Evaluation value;
  double slope;
  StopToken stop = {};             // ends the search after the first trial
  std::span<const double> g = {};  // gradient at x
};

// Output vectors of a search. The caller sizes `trial` and `gradient` like x.
struct LineSearchScratch {
  std::vector<double> trial;     // the last trial x + alpha d
  std::vector<double> gradient;  // gradient at `trial`, if computed
  std::vector<Trial> trials;     // all trials
};

struct LineSearchResult {
  double alpha = 0;             // 0: stuck
  Evaluation value;             // at x + alpha d
  int gradients = 0;            // number of evaluated gradients
  bool gradient_known = false;  // LineSearchScratch::gradient belongs to the accepted trial
};

// Searches along the line. Near convergence, differences of E are below round-off. If both the difference and the
// required decrease are, the slope at the trial decides (approximate Wolfe condition, [Hager and Zhang 2005]).
LineSearchResult backtrack(const SearchLine& line, const LineSearchOptions& options, LineSearchScratch& scratch);

}  // namespace aspic

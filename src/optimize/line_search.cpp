#include "optimize/line_search.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

double allowed_value(double value, double alpha, double slope, const LineSearchOptions& options) {
  const double reach = options.test == DecreaseTest::slide ? 1.0 : alpha;
  return value + options.sufficient_decrease * reach * slope;
}

}  // namespace

LineSearchResult backtrack(Objective& E, std::span<const double> x, std::span<const double> d, double value,
                           double slope, const LineSearchOptions& options, std::span<double> trial,
                           std::span<double> trial_gradient) {
  const double noise = E.value_round_off();
  LineSearchResult result;
  double alpha = std::min(options.alpha_max, E.max_step(x, d));
  for (; alpha >= options.tolerance; alpha *= options.shrink) {
    for (size_t i = 0; i < x.size(); ++i) trial[i] = x[i] + alpha * d[i];
    const double trial_value = E.value(trial);
    ++result.trials;
    bool accepted = options.test == DecreaseTest::none;
    if (!accepted && std::abs(trial_value - value) <= noise) {
      E.gradient(trial, trial_gradient);
      accepted = result.gradient_known = E.dot(trial_gradient, d) <= (2 * options.sufficient_decrease - 1) * slope;
    } else if (!accepted) {
      accepted = trial_value <= allowed_value(value, alpha, slope, options);  // false for what is not a number
    }
    if (accepted) {
      result.alpha = alpha;
      result.value = trial_value;
      return result;
    }
  }
  return result;
}

}  // namespace aspic

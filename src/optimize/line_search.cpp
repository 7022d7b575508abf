#include "optimize/line_search.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

double allowed_value(double value, double alpha, double slope, const LineSearchOptions& options) {
  if (options.test == DecreaseTest::none) return INFINITY;
  const double reach = options.test == DecreaseTest::slide ? 1.0 : alpha;
  return value + options.sufficient_decrease * reach * slope;
}

// Accepts the step length of a custom search.
LineSearchResult take_custom(const SearchLine& line, const LineSearchOptions& options, LineSearchScratch& scratch) {
  const double alpha = std::min(options.custom(line), line.E.max_step(line.x, line.d));
  if (!(alpha > 0) || !std::isfinite(alpha)) return {};
  for (size_t i = 0; i < line.x.size(); ++i) scratch.trial[i] = line.x[i] + alpha * line.d[i];
  const Evaluation there = line.E.evaluate(scratch.trial);
  const bool is_accepted = std::isfinite(there.value);
  scratch.trials.push_back({.alpha = alpha, .value = there.value, .bound = INFINITY, .accepted = is_accepted});
  if (!is_accepted) return {};
  return {.alpha = alpha, .value = there};
}

}  // namespace

LineSearchResult backtrack(const SearchLine& line, const LineSearchOptions& options, LineSearchScratch& scratch) {
  const auto& [E, x, d, value, slope, stop, g] = line;
  auto& [trial, gradient, trials] = scratch;
  LineSearchResult result;
  trials.clear();
  if (options.custom) return take_custom(line, options, scratch);
  double alpha = std::min(options.alpha_max, E.max_step(x, d));
  while (alpha >= options.tolerance) {
    for (size_t i = 0; i < x.size(); ++i) trial[i] = x[i] + alpha * d[i];
    const Evaluation there = E.evaluate(trial);
    Trial& now = trials.emplace_back(Trial{alpha, there.value, allowed_value(value.value, alpha, slope, options)});
    if (options.test == DecreaseTest::none) {
      now.accepted = true;
    } else if (std::abs(now.value - value.value) <= value.round_off && value.value - now.bound <= value.round_off) {
      E.gradient(trial, gradient);
      ++result.gradients;
      now.by_slope = true;
      now.accepted = E.dot(gradient, d) <= (2 * options.sufficient_decrease - 1) * slope;
    } else {
      now.accepted = now.value <= now.bound;  // false for NaN
    }
    if (now.accepted) {
      result.alpha = alpha;
      result.value = there;
      result.gradient_known = now.by_slope;
      return result;
    }
    if (stop.stopped()) return result;
    alpha *= options.shrink;
  }
  return result;
}

}  // namespace aspic

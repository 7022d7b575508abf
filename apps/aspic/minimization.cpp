#include <fmt/format.h>

#include "aspic/interrupt.h"
#include "aspic/minimize.h"
#include "base/error.h"
#include "optimize/test_functions.h"

namespace aspic::cli {
namespace {

void check(const SolverOptions& solver) {
  const auto require = [](bool holds, const char* option, double value, const char* range) {
    if (!holds) throw InvalidInput(fmt::format("{} {}: must be {}", option, value, range));
  };
  const LineSearchOptions& search = solver.minimize.line_search;
  require(solver.minimize.tolerance >= 0, "--tolerance", solver.minimize.tolerance, "0 or more");
  require(search.alpha_max > 0 && search.alpha_max <= 1e6, "--alpha-max", search.alpha_max, "positive, at most 1e6");
  const double c = search.sufficient_decrease, p = search.shrink;
  require(c > 0 && c < 1, "--decrease", c, "between 0 and 1");
  require(p > 0 && p <= 0.99, "--shrink", p, "positive, at most 0.99");
  require(search.tolerance >= 1e-16, "--alpha-min", search.tolerance, "1e-16 or more");
}

Planar planar(std::span<const double> x) { return {x[0], x[1]}; }

}  // namespace

Problem known_problem(const std::string& name) {
  const TestFunction info = test_function_info(name);
  return {.name = info.name,
          .formula = info.formula,
          .function = make_test_function(info.name),
          .start = info.start,
          .minimizer = info.minimizer,
          .minimum = info.minimum,
          .region = std::pair(info.lower, info.upper)};
}

Minimization minimize(const Problem& problem, const SolverOptions& options, const ShowIteration& show) {
  check(options);
  const auto direction = make_search_direction(options);
  Minimization done{.method = options.method, .definiteness = definiteness_of(options)};
  std::vector<double> x = {problem.start[0], problem.start[1], 0};
  const auto observe = [&](const LiveIteration& live) {
    done.iterations.push_back({static_cast<const Iteration&>(live),
                               planar(live.x),
                               planar(live.d),
                               planar(live.x_next),
                               {live.tried.begin(), live.tried.end()}});
    if (show) show(done.iterations.back(), live);
  };
  MinimizeOptions stoppable = options.minimize;
  stoppable.stop = StopToken([] { return interrupt_signal() != 0; });
  done.report = Minimizer().minimize(*problem.function, *direction, x, stoppable, observe);
  done.end = planar(x);
  return done;
}

}  // namespace aspic::cli

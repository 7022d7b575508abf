#include "viewer/replies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "optimize/landscape.h"
#include "optimize/test_functions.h"
#include "scene/expression_function.h"
#include "scene/scene_document.h"
#include "scene/solver_options.h"
#include "viewer/settings.h"

namespace aspic::viewer {
namespace {

constexpr int kMaxIterations = 500, kMaxSamples = 101;
constexpr double kFarthestStart = 1e6;  // maximum coordinate of a start

struct Problem {
  std::unique_ptr<PlanarFunction> function;
  std::string formula, remarks;
  std::optional<Planar> minimizer;
  Planar lower{{-2, -2}}, upper{{2, 2}};
};

Problem problem_of(const std::string& name, const Planar& start) {
  for (const TestFunction& known : test_functions())
    if (known.name == name)
      return {make_test_function(name), known.formula, known.remarks, known.minimizer, known.lower, known.upper};
  Problem problem{.function = std::make_unique<ExpressionFunction>(name),
                  .formula = name,
                  .remarks = "derivatives by finite differences",
                  .minimizer = std::nullopt};
  // Without a known range, shows the start and the origin.
  for (int i = 0; i < 2; ++i) {
    const double reach = std::max(2.0, 1.25 * std::abs(start[i]));
    problem.lower[i] = -reach, problem.upper[i] = reach;
  }
  return problem;
}

// Reads the keys of [solver] that the page may set.
SolverOptions options_of(const Json& settings) {
  if (!settings.is_object() || settings.size() > 40) refuse("function.settings", settings, "an object is expected");
  std::vector<std::string> overrides;
  const Table defaults = read_scene_document("[[body]]\nshape = { box = { upper = [1, 1, 1], cells = [1, 1, 1] } }\n",
                                             "the function's settings");
  for (const auto& [key, value] : settings.items()) {
    std::string in_scene = key;
    if (key == "line_search.shrink") in_scene = "line_search.p";
    overrides.push_back(setting_override(defaults, "solver." + in_scene, value));
  }
  const Table document = read_scene_document(to_toml(defaults), "the function's settings", overrides);
  SolverOptions options = solver_options(*document.find("solver"));
  options.minimize.max_iterations = std::min(options.minimize.max_iterations, kMaxIterations);
  options.time_budget = 0;
  return options;
}

struct Seen {  // the recorded minimization
  std::vector<IterationRow> rows;
  Json path = Json::array();
  std::vector<CurvePoint> curve;
  QuadraticModel model;
  std::vector<Trial> tried;
};

Json point(double x, double y, double value) { return {{"x", x}, {"y", y}, {"value", value}}; }

std::string describe(const MinimizeReport& report) {
  switch (report.status) {
    case Status::converged:
      return fmt::format("converged after {} iterations", report.iterations);
    case Status::round_off:
      return fmt::format("reached the round-off floor after {} iterations", report.iterations);
    case Status::iteration_limit:
      return fmt::format("not converged: the limit of {} iterations was reached", report.iterations);
    case Status::stuck:
      return fmt::format("stuck after {} iterations: no trial along the direction decreases f enough",
                         report.iterations);
    case Status::no_descent:
      return fmt::format("no descent direction after {} iterations: the Hessian is not positive definite there",
                         report.iterations);
    case Status::undefined:
      return fmt::format("after {} iterations f or its gradient is not finite", report.iterations);
    default:
      return std::string(to_string(report.status));
  }
}

Json surface_values(const PlanarFunction& f, const Problem& problem, int samples) {
  Json values = Json::array();
  const auto coordinate = [&](int axis, int i) {
    return problem.lower[axis] + (problem.upper[axis] - problem.lower[axis]) * i / (samples - 1);
  };
  for (int row = 0; row < samples; ++row)
    for (int column = 0; column < samples; ++column)
      values.push_back(f.at({coordinate(0, column), coordinate(1, row)}));
  return values;
}

Json to_json(const QuadraticModel& m) {
  return {{"center", m.center}, {"value", m.value},   {"gradient", m.gradient},
          {"xx", m.hessian.xx}, {"xy", m.hessian.xy}, {"yy", m.hessian.yy}};
}

Planar start_of(Arguments& question) {
  const Json& value = question.value("start");
  Planar start{};
  bool fits = value.is_array() && value.size() == 2;
  for (size_t i = 0; fits && i < 2; ++i) {
    fits = value[i].is_number() && std::abs(value[i].get<double>()) <= kFarthestStart;
    if (fits) start[i] = value[i].get<double>();
  }
  if (!fits) refuse("function.start", value, "two numbers of size at most 1e6 are expected");
  return start;
}

}  // namespace

Json function_reply(Arguments& question) {
  const std::string name = question.text("name", kMaxExpressionLength);
  const Planar start = start_of(question);
  const SolverOptions options = options_of(question.value("settings"));
  const int iteration = question.integer("iteration", 0, kMaxIterations);
  const int samples = std::clamp(question.integer("samples", 2, 1'000'000), 2, kMaxSamples);
  question.finish();
  const Problem problem = problem_of(name, start);
  PlanarFunction& f = *problem.function;
  if (!std::isfinite(f.at(start)))
    throw InvalidInput(
        fmt::format("f is not finite at the start ({:g}, {:g}); choose another one", start[0], start[1]));

  Seen seen;
  seen.model = f.model(start);
  const auto observe = [&](const LiveIteration& live) {
    seen.rows.push_back({static_cast<const Iteration&>(live), {live.tried.begin(), live.tried.end()}});
    seen.path.push_back(point(live.x[0], live.x[1], live.value));
    if (live.index == iteration) {
      seen.model = f.model({live.x[0], live.x[1]});
      seen.curve = curve_along(live, options.minimize.line_search.sufficient_decrease);
      seen.tried.assign(live.tried.begin(), live.tried.end());
    }
  };
  std::vector<double> x = {start[0], start[1], 0};
  const auto direction = make_search_direction(options);
  const MinimizeReport report = Minimizer().minimize(f, *direction, x, options.minimize, observe);
  seen.path.push_back(point(x[0], x[1], f.at({x[0], x[1]})));
  Json rows = Json::array();
  for (const IterationRow& row : seen.rows) rows.push_back(viewer::to_json(row));
  return {{"lower", problem.lower},
          {"upper", problem.upper},
          {"formula", problem.formula},
          {"remarks", problem.remarks},
          {"minimizer", problem.minimizer ? Json(*problem.minimizer) : Json(nullptr)},
          {"samples", samples},
          {"value", surface_values(f, problem, samples)},
          {"status", to_string(report.status)},
          {"text", describe(report)},
          {"path", std::move(seen.path)},
          {"iterations", std::move(rows)},
          {"model", to_json(seen.model)},
          {"curve", viewer::to_json(seen.curve)},
          {"trials", viewer::to_json(seen.tried)}};
}

}  // namespace aspic::viewer

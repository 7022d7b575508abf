// Pages 38 to 42: the generic loop with d = -gradient, which zigzags.
#include <fmt/format.h>

#include <cmath>

#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"
#include "aspic/minimize.h"
#include "base/stopwatch.h"
#include "optimize/gradient_descent.h"
#include "optimize/newton.h"

namespace aspic::cli::lecture {
namespace {

// Angles between consecutive steps of a path.
struct Turns {
  int count = 0, sharp = 0;  // sharp: more than a right angle
  double share() const { return count > 0 ? static_cast<double>(sharp) / count : 0; }
};
Turns turns_of(const Minimization& path) {
  Turns turns;
  for (size_t k = 1; k < path.iterations.size(); ++k) {
    const Planar &a = path.iterations[k - 1].direction, &b = path.iterations[k].direction;
    ++turns.count;
    turns.sharp += a[0] * b[0] + a[1] * b[1] < 0;
  }
  return turns;
}

void write_path(const Sheet& sheet, const std::string& name, const Minimization& path) {
  CsvFile table = sheet.table(name, {"iteration", "x", "y", "value", "gradient_norm", "alpha", "trials"});
  for (const IterationRecord& r : path.iterations)
    table.append(CsvRow()
                     .add(r.iteration.index)
                     .add(r.x[0])
                     .add(r.x[1])
                     .add(r.iteration.value)
                     .add(r.iteration.gradient_norm)
                     .add(r.iteration.alpha)
                     .add(r.iteration.trials));
}

void descend_in_the_plane(const std::string& function, Planar start, double least_ratio, Sheet& sheet) {
  Problem problem = known_problem(function);
  problem.start = start;
  SolverOptions options;
  options.minimize.tolerance = 1e-6;
  options.minimize.max_iterations = 100000;
  options.method = "gradient_descent";
  const Minimization descent = minimize(problem, options);
  options.method = "newton";
  const Minimization newton = minimize(problem, options);
  write_path(sheet, function + "_gradient_descent.csv", descent);
  write_path(sheet, function + "_newton.csv", newton);
  const auto distance = [&](const Minimization& m) {
    return std::hypot(m.end[0] - (*problem.minimizer)[0], m.end[1] - (*problem.minimizer)[1]);
  };
  sheet.show(function + ": iterations of gradient descent", descent.report.iterations, "");
  sheet.show(function + ": iterations of Newton's method", newton.report.iterations, "");
  // |g| <= 1e-6 leaves |x - x*| <= 1e-6 / the least eigenvalue of H there: 0.4 for Rosenbrock, 0.86 for the two bumps.
  const std::string why = "|g| <= 1e-6 over the least eigenvalue of H at the minimum, at least 0.39";
  sheet.at_most(function + ": gradient descent ends from the minimum", distance(descent), 1e-6 / 0.39, "", why);
  sheet.at_most(function + ": Newton's method ends from the minimum", distance(newton), 1e-6 / 0.39, "", why);
  const double ratio = static_cast<double>(descent.report.iterations) / newton.report.iterations;
  if (least_ratio > 0) {
    sheet.at_least(function + ": iterations of gradient descent / of Newton's method", ratio, least_ratio, "",
                   "the valley's condition number at the minimum is 2500");
    sheet.at_least(function + ": share of turns by more than a right angle", turns_of(descent).share(), 0.3, "",
                   "it zig-zags across the valley");
  }
  sheet.draw_by(function + ".png", function + ": gradient descent and Newton's method", [&](const auto& path) {
    draw_paths(path, problem.formula, problem, {descent, newton});
  });
  sheet.draw_by(function + "_surface.png", function + " as a surface, with the model at the start",
                [&](const auto& path) { draw_model(path, problem, newton, 0); });
}

struct Descent {
  MinimizeReport report;
  Vector value, gradient;  // per iteration
  double seconds = 0;
};

Descent descend(OpenStep& step, SearchDirection& direction) {
  Descent result;
  Vector q = step.start;
  Stopwatch stopwatch;
  result.report = Minimizer().minimize(step.E, direction, q, {.max_iterations = 20000, .tolerance = 1e-3},
                                       [&](const LiveIteration& iteration) {
                                         result.value.push_back(iteration.value);
                                         result.gradient.push_back(iteration.gradient_norm);
                                       });
  result.seconds = stopwatch.lap();
  return result;
}

Vector counted(size_t n) {
  Vector numbers(n);
  for (size_t i = 0; i < n; ++i) numbers[i] = static_cast<double>(i + 1);
  return numbers;
}

}  // namespace

void show_gradient_descent(const Stage& stage, Sheet& sheet) {
  descend_in_the_plane("two_bump", {-0.3, 0.9}, 0, sheet);
  descend_in_the_plane("rosenbrock", {-1, -0.5}, 100, sheet);

  OpenStep step(in_motion(stage.on_real_mesh("05_swing")));
  sheet.keep(step.scene);
  GradientDescent steepest;
  Newton newton(make_linear_solver("auto"));
  const Descent slow = descend(step, steepest), fast = descend(step, newton);
  CsvFile table = sheet.table("step.csv", {"method", "iteration", "value", "gradient_norm"});
  for (const auto& [name, d] : {std::pair("gradient_descent", &slow), std::pair("newton", &fast)})
    for (size_t i = 0; i < d->value.size(); ++i)
      table.append(CsvRow().add(name).add(static_cast<int>(i)).add(d->value[i]).add(d->gradient[i]));
  sheet.equals("real step: both converged", is_success(slow.report.status) && is_success(fast.report.status), 1, "",
               "to the same tolerance, 1e-3 of the forces");
  sheet.show("real step: iterations of gradient descent", slow.report.iterations, "");
  sheet.show("real step: iterations of Newton's method", fast.report.iterations, "");
  sheet.at_least("real step: iterations of gradient descent / of Newton's method",
                 static_cast<double>(slow.report.iterations) / fast.report.iterations, 10, "",
                 "M + h^2 K is far from a multiple of the identity");
  sheet.show("real step: time of gradient descent", slow.seconds, "s");
  sheet.show("real step: time of Newton's method", fast.seconds, "s");
  sheet.draw("step.svg", "One step of the real mesh, to the same tolerance",
             Chart{"gradient descent against Newton",
                   {"iteration", AxisScale::logarithmic},
                   {"|dE/dq| [kg m]", AxisScale::logarithmic},
                   {{"gradient descent", counted(slow.gradient.size()), slow.gradient},
                    {"Newton", counted(fast.gradient.size()), fast.gradient, SeriesStyle::line_and_points}}});
}

}  // namespace aspic::cli::lecture

// Pages 53 to 62: Newton's method with and without a line search.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "aspic/landscape_picture.h"
#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"
#include "aspic/minimize.h"
#include "optimize/landscape.h"
#include "optimize/newton.h"
#include "optimize/solver.h"
#include "optimize/test_functions.h"

namespace aspic::cli::lecture {
namespace {

const SolverOptions& solver_of(const OpenStep& step) { return step.scene.simulation.options().solver; }

Newton newton_of(const OpenStep& step) {
  return Newton(make_linear_solver(solver_of(step).linear), definiteness_of(solver_of(step)));
}

struct Attempt {
  std::string name;
  MinimizeReport report;
  Vector value, gradient, alpha;  // per iteration
  Vector q;                       // final position
};

Attempt attempt(OpenStep& step, DecreaseTest test) {
  Attempt result{test == DecreaseTest::none ? "without line search" : "with line search", {}, {}, {}, {}, step.start};
  Newton newton = newton_of(step);
  MinimizeOptions options = solver_of(step).minimize;
  options.line_search.test = test;
  result.report = Minimizer().minimize(step.E, newton, result.q, options, [&](const LiveIteration& iteration) {
    result.value.push_back(iteration.value);
    result.gradient.push_back(iteration.gradient_norm);
    result.alpha.push_back(iteration.alpha);
  });
  result.value.push_back(result.report.value);
  result.gradient.push_back(result.report.gradient_norm);
  return result;
}

int rises(const Attempt& a) {
  int count = 0;
  for (size_t i = 1; i < a.value.size(); ++i) count += !(a.value[i] <= a.value[i - 1]);
  return count;
}

Vector indices(size_t n) {
  Vector numbers(n);
  for (size_t i = 0; i < n; ++i) numbers[i] = static_cast<double>(i);
  return numbers;
}

}  // namespace

void show_pure_newton(const Stage& stage, Sheet& sheet) {
  OpenStep step(stage.on_real_mesh("53_hard_step"));
  sheet.keep(step.scene);
  const Attempt pure = attempt(step, DecreaseTest::none), careful = attempt(step, DecreaseTest::textbook);
  CsvFile table = sheet.table("iterations.csv", {"method", "iteration", "value", "gradient_norm"});
  for (const Attempt* a : {&pure, &careful})
    for (size_t i = 0; i < a->value.size(); ++i)
      table.append(CsvRow().add(a->name).add(static_cast<int>(i)).add(a->value[i]).add(a->gradient[i]));

  sheet.remark(fmt::format("the same step, start, Hessian and tolerance; without a line search: {}, with one: {}",
                           to_string(pure.report.status), to_string(careful.report.status)));
  sheet.equals("without line search: converged", is_success(pure.report.status), 0, "",
               fmt::format("it is expected to fail within {} iterations", solver_of(step).minimize.max_iterations));
  sheet.at_least("without line search: iterations that raise E", rises(pure), 1, "", "it overshoots");
  const double last = pure.report.gradient_norm / pure.report.threshold;
  sheet.at_least("without line search: |gradient| at the end / tolerance", std::isfinite(last) ? last : INFINITY, 1e3,
                 "", "far from converged");
  sheet.equals("with line search: converged", is_success(careful.report.status), 1, "", "on the same step");
  sheet.show("with line search: iterations", careful.report.iterations, "");
  sheet.equals("with line search: iterations that raise E", rises(careful), 0, "", "each trial must decrease E");
  sheet.at_most("with line search: |gradient| at the end / tolerance",
                careful.report.gradient_norm / careful.report.threshold, 1, "", "converged");
  // Without a line search E exceeds 1e180: the axis ends where the curve with one can still be read.
  const auto chart = [&](const std::string& label, Vector Attempt::*y) {
    return Chart{"one step of a real mesh",
                 {"iteration"},
                 {label, AxisScale::logarithmic, {}, 1e3 * (careful.*y).front()},
                 {{pure.name, indices((pure.*y).size()), pure.*y, SeriesStyle::line_and_points},
                  {careful.name, indices((careful.*y).size()), careful.*y, SeriesStyle::line_and_points}}};
  };
  sheet.draw("gradient.svg", "The gradient by iteration; without a line search it leaves the axis",
             chart("|dE/dq| [kg m]", &Attempt::gradient));
  sheet.draw("value.svg", "E by iteration; without a line search it leaves the axis",
             chart("E [kg m^2]", &Attempt::value));
  sheet.draw("step.png", "The start of the step, and its end with a line search",
             MeshPicture{.panels = {{"start", surface_at(step.model(), step.start)},
                                    {"end", surface_at(step.model(), careful.q)}},
                         .eye = {{0.4, 0.3, 1}},
                         .up = {{0, 1, 0}}});
}

void show_overshoot(const Stage&, Sheet& sheet) {
  Problem problem = known_problem("rosenbrock");
  problem.start = {0, 0};
  const Minimization done = minimize(problem, {});
  const IterationRecord& first = done.iterations.front();
  const Planar full = {first.x[0] + first.direction[0], first.x[1] + first.direction[1]};
  const QuadraticModel model = problem.function->model(first.x);
  const double start = problem.function->at(first.x);
  CsvFile table = sheet.table("trials.csv", {"alpha", "value", "bound", "accepted"});
  for (const Trial& t : first.tried) table.append(CsvRow().add(t.alpha).add(t.value).add(t.bound).add(t.accepted));

  // By hand at (0, 0): E = 1, g = (-2, 0), H = diag(2, 200), d = (1, 0), the model is 0 and E is 100 at (1, 0).
  sheet.at_most("distance of the model's minimizer from (1, 0)", std::hypot(full[0] - 1, full[1]), 1e-12, "",
                "H d = -g by hand");
  sheet.at_most("the model's change at its minimizer", model.at(full) - start, -1 + 1e-12, "", "its minimum is E = 0");
  sheet.at_most("|E at the model's minimizer - 100|", std::abs(problem.function->at(full) - 100), 1e-10, "",
                "by hand: 100 (0 - 1)^2");
  sheet.at_least("E there / at the start", problem.function->at(full) / start, 2, "", "Newton overshoots");
  sheet.at_most("E at the backtracked point / at the start", problem.function->at(first.next) / start, 1 - 1e-6, "",
                "a shorter step along the same direction lies lower");
  sheet.equals("the accepted alpha", first.iteration.alpha, 0.25, "", "by hand: 1 and 1/2 lie higher, 1/4 lies lower");
  sheet.at_most("distance from (1, 1) at the end", std::hypot(done.end[0] - 1, done.end[1] - 1), 1e-6 / 0.39, "",
                "|g| <= 1e-6 over the least eigenvalue of H there");
  sheet.show("iterations", done.report.iterations, "");
  sheet.draw_by("model.png", "The surface, the model, its minimizer and the backtracked point",
                [&](const auto& path) { draw_model(path, problem, done, 0); });
  sheet.draw_by("path.svg", "The path with the rejected trials",
                [&](const auto& path) { draw_paths(path, problem.formula, problem, {done}); });
}

namespace {

// Curve of an iteration that rejects trials: the first with one or two rejections, which are visible together with the
// accepted trial, otherwise the first with any.
struct Curve {
  int iteration = -1;
  double slope = 0, measured_slope = 0, value = 0;  // d'g, and the same by differences
  std::vector<Trial> tried;
  std::vector<CurvePoint> points;
};

Curve curve_through(const LiveIteration& it, double sufficient_decrease) {
  Curve curve{it.index, dot(it.g, it.d), 0, it.value, {it.tried.begin(), it.tried.end()}, {}};
  constexpr double kSmall = 1e-5;
  const Vector ahead = plus(it.x, kSmall, it.d), behind = plus(it.x, -kSmall, it.d);
  curve.measured_slope = (it.E.value(ahead) - it.E.value(behind)) / (2 * kSmall);
  curve.points = curve_along(it, sufficient_decrease, 81);
  return curve;
}

Curve curve_of(OpenStep& step, const LineSearchOptions& search) {
  Curve curve;
  Vector q = step.start;
  Newton newton = newton_of(step);
  bool is_found = false;
  MinimizeOptions options = solver_of(step).minimize;
  options.line_search = search;
  options.stop = StopToken([&] { return is_found; });
  Minimizer().minimize(step.E, newton, q, options, [&](const LiveIteration& it) {
    const bool is_clear = it.tried.size() == 2 || it.tried.size() == 3;
    if (is_clear || (it.tried.size() > 3 && curve.iteration < 0)) curve = curve_through(it, search.sufficient_decrease);
    is_found = is_found || is_clear;
  });
  return curve;
}

void write_curve(const Sheet& sheet, const Curve& curve) {
  CsvFile table = sheet.table("curve.csv", {"alpha", "value", "model", "textbook_bound", "slide_bound"});
  for (const CurvePoint& p : curve.points)
    table.append(CsvRow().add(p.alpha).add(p.value).add(p.model).add(p.textbook_bound).add(p.slide_bound));
}

void draw_curve(const Curve& curve, const std::string& name, const std::string& caption, Sheet& sheet) {
  Chart chart = line_search_chart(
      {.at = {1, curve.iteration}, .value = curve.value, .tried = curve.tried, .curve = curve.points, .slice = {}});
  chart.y.label = "E [kg m^2]";
  sheet.draw(name, caption, chart);
}

// Rosenbrock from (0, 0), where alpha must shrink to 1/4.
MinimizeReport overshoot_with(double tol) {
  Rosenbrock E;
  Newton newton(make_linear_solver("cholesky"));
  Vector x = {0, 0, 0};
  MinimizeOptions options;
  options.line_search.tolerance = tol;
  return Minimizer().minimize(E, newton, x, options);
}

void check_settings(OpenStep& step, Sheet& sheet) {
  const LineSearchOptions other{.alpha_max = 2, .sufficient_decrease = 0.3, .shrink = 0.7};
  const Curve curve = curve_of(step, other);
  draw_curve(curve, "other_settings.svg", "alpha_max = 2, p = 0.7, c = 0.3: the two lines are distinct", sheet);
  double worst = 0, alpha = other.alpha_max;
  for (const Trial& t : curve.tried) {
    worst = std::max(worst, std::abs(t.alpha / alpha - 1));
    alpha *= other.shrink;
  }
  sheet.at_least("alpha_max = 2, p = 0.7, c = 0.3: trials", static_cast<double>(curve.tried.size()), 2, "",
                 "at least one was rejected");
  sheet.at_most("the same: |alpha_k / (alpha_max p^k) - 1|", worst, 1e-14, "", "the sequence of the slide");
}

}  // namespace

void show_backtracking(const Stage& stage, Sheet& sheet) {
  OpenStep step(stage.on_real_mesh("53_hard_step"));
  sheet.keep(step.scene);
  const LineSearchOptions search;
  const Curve curve = curve_of(step, search);
  CsvFile table = sheet.table("trials.csv", {"alpha", "value", "bound", "accepted"});
  for (const Trial& t : curve.tried) table.append(CsvRow().add(t.alpha).add(t.value).add(t.bound).add(t.accepted));
  sheet.at_least("trials", static_cast<double>(curve.tried.size()), 2, "", "at least one was rejected");
  int wrong = 0;
  double off = 0;
  for (const Trial& t : curve.tried) {
    const double textbook = curve.value + search.sufficient_decrease * t.alpha * curve.slope;
    wrong += t.accepted != (t.value <= textbook);
    off = std::max(off, std::abs(t.bound - textbook));
  }
  sheet.equals("trials judged against E + c alpha d'g", wrong, 0, "", "rejected above the line, accepted below");
  sheet.at_most("|bound - (E + c alpha d'g)| / E", off / std::abs(curve.value), 1e-14, "", "the line of the textbook");
  sheet.at_most("slope of E along d at 0 against d'g, relative", std::abs(curve.measured_slope / curve.slope - 1), 1e-4,
                "", "central differences over alpha = 1e-5; their error falls with the square of it");
  write_curve(sheet, curve);
  draw_curve(curve, "curve.svg", fmt::format("E along d in iteration {} of a step of the real mesh", curve.iteration),
             sheet);
  check_settings(step, sheet);

  const MinimizeReport stuck = overshoot_with(0.3), fine = overshoot_with(1e-10);
  sheet.equals("tol = 0.3 on Rosenbrock from (0, 0): stuck", stuck.status == Status::stuck, 1, "",
               "1 and 1/2 lie higher, and 1/4 is shorter than tol");
  sheet.equals("tol = 1e-10 on the same: converged", fine.status == Status::converged, 1, "", "1/4 is accepted");
  sheet.remark(
      "\"Or you get stuck\": when no alpha >= tol decreases E enough, the minimization ends as `stuck`, never as "
      "converged. The reasons are a tol that is too large (as here), a wrong gradient, or an E whose "
      "differences are below round-off.");
}

}  // namespace aspic::cli::lecture

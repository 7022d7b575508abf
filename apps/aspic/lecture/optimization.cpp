// Pages 26 to 32: a step as the root of an equation and as a minimum.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"
#include "optimize/derivative_check.h"
#include "optimize/newton.h"

namespace aspic::cli::lecture {
namespace {

struct Root {
  Vector q;
  std::vector<double> residuals;
};

// Newton's method for the equation r(q) = 0 with the derivative M + h^2 d2V/dq2. Never evaluates E.
Root find_root(OpenStep& step) {
  Root root{step.start, {}};
  const auto solver = make_linear_solver("cholesky");
  Vector d(root.q.size());
  for (int i = 0; i < 30; ++i) {
    const Vector r = step.residual(root.q);
    root.residuals.push_back(norm(r));
    if (i >= 2 && root.residuals[i] >= 0.5 * root.residuals[i - 1]) break;  // round-off
    const BlockSparse& H = step.E.hessian(root.q, {Definiteness::exact});
    if (i == 0) solver->analyze(*H.pattern);
    if (!solver->factorize(H)) break;
    solver->solve(r, d, 1e-12);
    root.q = plus(root.q, -1, d);
  }
  return root;
}

void write_derivatives(const Sheet& sheet, const DerivativeReport& check) {
  CsvFile table = sheet.table("derivatives.csv", {"relative_step", "gradient_error", "hessian_error"});
  for (size_t i = 0; i < check.gradient.step.size(); ++i)
    table.append(CsvRow().add(check.gradient.step[i]).add(check.gradient.error[i]).add(check.hessian.error[i]));
}

}  // namespace

void show_optimization(const Stage& stage, Sheet& sheet) {
  OpenStep step(in_motion(stage.on_real_mesh("05_swing")));
  sheet.keep(step.scene);
  const Vector d = smooth_direction(step);
  const Vector q = plus(step.start, 0.05, d);
  Vector g(q.size());
  step.E.gradient(q, g);
  const Vector r = step.residual(q);
  sheet.at_most("|dE/dq - (M (q - q~) + h^2 dV/dq)| / |dE/dq|", norm(plus(g, -1, r)) / norm(g), 1e-12, "",
                "the same sums in another order");
  const DerivativeReport check =
      check_derivatives(differentiable(step.E), q,
                        {.length = 0.1 / std::sqrt(static_cast<double>(q.size())), .fixed = fixed_entries(step)});
  write_derivatives(sheet, check);
  sheet.at_most("gradient of E against differences of E, relative", check.gradient.smallest_error, 1e-8, "",
                "the best width has two thirds of the 16 digits; the sum over the tets loses more");
  sheet.at_most("order of that error, distance from 2", std::abs(check.gradient.order - 2), 0.2, "",
                "central differences are of second order");

  const Root root = find_root(step);
  Vector minimum = step.start;
  Newton newton(make_linear_solver("cholesky"));
  const MinimizeReport report = Minimizer().minimize(step.E, newton, minimum, {.tolerance = 1e-13});
  Vector g_root(q.size()), g_minimum(q.size());
  step.E.gradient(root.q, g_root);
  step.E.gradient(minimum, g_minimum);
  // E is at least as curved as the inertia where V is convex, so a gradient g means a distance of at most g / m.
  const double bound = (norm(g_root) + norm(g_minimum) + 2 * step.E.scales().gradient_round_off) / step.smallest_mass();
  sheet.at_most("|root of the equation - minimizer of E|", max_abs(plus(root.q, -1, minimum)), bound, "m",
                "remaining norm of both gradients over the least eigenvalue of M");
  sheet.at_most("the bound itself", bound, 1e-3 * max_abs(plus(minimum, -1, step.q_t)), "m",
                "it must be below a thousandth of the motion of the step");
  sheet.show("iterations of root finding", static_cast<double>(root.residuals.size()) - 1, "");
  sheet.show("iterations of minimizing", report.iterations, "");
  sheet.at_most("E at the minimizer - E at the start", step.E.value(minimum) - step.E.value(step.start), 0, "kg m^2",
                "a minimum is not above the start");
  CsvFile residuals = sheet.table("root_finding.csv", {"iteration", "residual_kg_m"});
  Vector iteration;
  for (size_t i = 0; i < root.residuals.size(); ++i) {
    iteration.push_back(static_cast<double>(i));
    residuals.append(CsvRow().add(static_cast<int>(i)).add(root.residuals[i]));
  }
  sheet.draw("root_finding.svg", "Newton's method on the equation",
             Chart{"M (q - q~) + h^2 dV/dq = 0",
                   {"iteration"},
                   {"|residual| [kg m]", AxisScale::logarithmic},
                   {{"", iteration, root.residuals, SeriesStyle::line_and_points}}});
}

void show_one_minimization_per_step(const Stage& stage, Sheet& sheet) {
  constexpr int kSteps = 20;
  Scene scene = stage.on_real_mesh("05_swing");
  sheet.keep(scene);
  std::vector<int> begun(kSteps, 0);
  CsvFile table = sheet.table("steps.csv", {"step", "minimizations", "iterations", "values", "status"});
  int taken = 0;
  const Run result = run(
      scene.simulation, kSteps,
      [&](const StepReport& r) {
        table.append(CsvRow().add(r.step).add(begun[taken]).add(r.iterations).add(r.trials).add(to_string(r.status)));
        ++taken;
      },
      [&](const LiveIteration& iteration) { begun[taken] += iteration.index == 0; });
  sheet.equals("time steps", taken, kSteps, "", "all were taken");
  sheet.equals("fewest minimizations in a step", *std::min_element(begun.begin(), begun.end()), 1, "", "for each one");
  sheet.equals("most minimizations in a step", *std::max_element(begun.begin(), begun.end()), 1, "", "and no more");
  sheet.equals("minimizations that converged", kSteps - result.unconverged, kSteps, "", "all of them");
  sheet.show("iterations per minimization", static_cast<double>(result.iterations) / kSteps, "");
}

}  // namespace aspic::cli::lecture

// Pages 43 to 51: Newton's method minimizes the quadratic approximation.
#include <fmt/format.h>

#include <cmath>

#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"
#include "aspic/minimize.h"
#include "dynamics/velocity_form.h"
#include "optimize/derivative_check.h"
#include "optimize/newton.h"

namespace aspic::cli::lecture {
namespace {

// Difference of E and its model at x + s d.
struct Departure {
  Vector s, error;
};

Departure departure(Objective& E, const Vector& x, const Vector& d) {
  Vector g(x.size()), Hd(x.size());
  const double value = E.value(x);
  E.gradient(x, g);
  E.hessian(x, {Definiteness::exact}).multiply(d, Hd);
  Departure result;
  for (const double s : {1.0, 0.5, 0.25, 0.125, 0.0625}) {
    const double model = value + s * dot(g, d) + s * s / 2 * dot(d, Hd);
    result.s.push_back(s);
    result.error.push_back(std::abs(E.value(plus(x, s, d)) - model));
  }
  return result;
}

// |H d + g| / |g| for the Newton direction.
double residual_of_direction(Objective& E, const Vector& x) {
  Vector g(x.size()), d(x.size()), Hd(x.size());
  E.gradient(x, g);
  Newton newton(make_linear_solver("cholesky"));
  DirectionReport report;
  if (!newton.compute({E, x, g, {.loosest = 1e-12}}, d, report)) return INFINITY;
  E.hessian(x, {report.projected ? Definiteness::clamped : Definiteness::exact}).multiply(d, Hd);
  return norm(plus(Hd, 1, g)) / norm(g);
}

// |gradient| after one full step / before; zero for a quadratic function.
double gradient_left(Objective& E, Vector x) {
  Newton newton(make_linear_solver("cholesky"));
  Vector g(x.size());
  E.gradient(x, g);
  const double before = norm(g);
  MinimizeOptions one;
  one.max_iterations = 1;
  one.tolerance = 0;
  one.line_search.test = DecreaseTest::none;
  Minimizer().minimize(E, newton, x, one);
  E.gradient(x, g);
  return norm(g) / before;
}

// Uniform expansion of the body by a few percent, for which third derivatives of all tets add up.
Vector swelling(const OpenStep& step) {
  Vector d(step.start.size());
  for (size_t i = 0; i < d.size(); ++i) d[i] = step.start[i] - step.start[i % 3];
  step.pins.set_zero(d);
  return scaled(d, 0.05 / max_abs(d));
}

void show_on_rosenbrock(Sheet& sheet) {
  Problem problem = known_problem("rosenbrock");
  problem.start = {-0.8, 0.3};  // H is positive definite here
  const Vector x = {-0.8, 0.3, 0};
  const Departure d = departure(*problem.function, x, {0.05, 0.02, 0});
  sheet.at_most("Rosenbrock: order of E - model along d, distance from 3", std::abs(observed_order(d.s, d.error) - 3),
                0.1, "", "the model has the value, the slope and the curvature; the next term is below 10 %");
  sheet.at_most("Rosenbrock: |H d + g| / |g|", residual_of_direction(*problem.function, x), 1e-12, "",
                "the model's gradient is zero at its minimizer");
  const Minimization done = minimize(problem, {});
  sheet.draw_by("model.png", "Rosenbrock's function and its quadratic model at the start, with the model's minimizer",
                [&](const auto& path) { draw_model(path, problem, done, 0); });
}

}  // namespace

void show_quadratic_model(const Stage& stage, Sheet& sheet) {
  show_on_rosenbrock(sheet);
  OpenStep step(in_motion(stage.on_real_mesh("05_swing")));
  sheet.keep(step.scene);
  const Vector d = swelling(step);
  const Departure real = departure(step.E, step.start, d);
  CsvFile table = sheet.table("departure.csv", {"s", "error"});
  for (size_t i = 0; i < real.s.size(); ++i) table.append(CsvRow().add(real.s[i]).add(real.error[i]));
  sheet.at_most("real step: order of E - model along d, distance from 3",
                std::abs(observed_order(real.s, real.error) - 3), 0.2, "", "tangent to second order");
  sheet.at_most("real step: |H d + g| / |g|", residual_of_direction(step.E, step.start), 1e-10, "",
                "a factorization solves to round-off times the condition number, below 1e5");

  VelocityForm form(step.E, step.q_t, step.h);
  const Vector v = scaled(plus(step.start, -1, step.q_t), 1 / step.h);
  const DerivativeReport check = check_derivatives(
      differentiable(form), v, {.length = 10 / std::sqrt(static_cast<double>(v.size())), .fixed = fixed_entries(step)});
  sheet.at_most("gradient of E(v) against differences of E(v), relative", check.gradient.smallest_error, 1e-8, "",
                "M (v - v_i) + h dV/dq; the best width has two thirds of the 16 digits; the sum loses more");
  sheet.at_most("Hessian of E(v) against differences of the gradient, relative", check.hessian.smallest_error, 1e-8, "",
                "M + h^2 d2V/dq2");

  OpenStep quadratic(in_motion(stage.on_real_mesh("05_swing", {"material.model=linear"})));
  sheet.at_most("linear material: |gradient| after one step / before", gradient_left(quadratic.E, quadratic.start),
                1e-9, "", "E is quadratic, so the model's minimizer is that of E, but for round-off");
  sheet.show("neo-Hookean: |gradient| after one step / before", gradient_left(step.E, step.start), "",
             "E is not quadratic: more steps are needed");
  sheet.draw("departure.svg", "Distance between E and its model along a direction, on a step of the real mesh",
             Chart{"tangent to second order",
                   {"s", AxisScale::logarithmic},
                   {"|E - model| [kg m^2]", AxisScale::logarithmic},
                   {{"", real.s, real.error, SeriesStyle::line_and_points}}});
}

}  // namespace aspic::cli::lecture

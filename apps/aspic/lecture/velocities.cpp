// Pages 36 to 40: the same minimization in velocities.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"
#include "dynamics/velocity_form.h"
#include "optimize/gradient_descent.h"
#include "optimize/newton.h"

namespace aspic::cli::lecture {
namespace {

// Objective in other units: E / unit over the same x.
class Rescaled : public Objective {
 public:
  Rescaled(Objective& E, double unit) : E_(E), unit_(unit) {}
  Evaluation evaluate(std::span<const double> x) override {
    const Evaluation E = E_.evaluate(x);
    return {E.value / unit_, E.round_off / unit_};
  }
  void gradient(std::span<const double> x, std::span<double> g) override {
    E_.gradient(x, g);
    for (double& gi : g) gi /= unit_;
  }
  const BlockSparse& evaluate_hessian(std::span<const double> x, const Projection& projection) override {
    H_ = E_.hessian(x, projection);
    for (Mat3d& block : H_->block) block = (1 / unit_) * block;
    return *H_;
  }
  ObjectiveScales scales() const override { return {.gradient = E_.scales().gradient / unit_}; }

 private:
  Objective& E_;
  double unit_;
  std::optional<BlockSparse> H_;
};

std::vector<Vector> iterates(Objective& E, SearchDirection& direction, Vector x, int most) {
  std::vector<Vector> visited = {x};
  Minimizer().minimize(E, direction, x, {.max_iterations = most}, [&](const LiveIteration& iteration) {
    visited.emplace_back(iteration.x_next.begin(), iteration.x_next.end());
  });
  return visited;
}

Vector position_of(VelocityForm& form, const Vector& v) {
  const auto q = form.position(v);
  return {q.begin(), q.end()};
}

// Largest distance between the iterates of the two forms; infinite if their numbers differ.
double distance(const std::vector<Vector>& q, const std::vector<Vector>& v, VelocityForm& form) {
  if (q.size() != v.size()) return INFINITY;
  double most = 0;
  for (size_t k = 0; k < q.size(); ++k) most = std::max(most, max_abs(plus(position_of(form, v[k]), -1, q[k])));
  return most;
}

// E(v) as on the slide, from its parts.
double printed_E(const OpenStep& step, const Vector& v) {
  const Vector dv = plus(v, -1, scaled(plus(step.predicted, -1, step.q_t), 1 / step.h));
  return dot(dv, mass_times(step.model(), dv)) / 2 + potential(step.model(), plus(step.q_t, step.h, v));
}

}  // namespace

void show_velocity_form(const Stage& stage, Sheet& sheet) {
  OpenStep step(in_motion(stage.on_real_mesh("05_swing")));
  sheet.keep(step.scene);
  VelocityForm form(step.E, step.q_t, step.h);
  const double h = step.h;
  const Vector d = smooth_direction(step);
  double least = INFINITY, most = -INFINITY, size = 0;
  for (int k = -3; k <= 3; ++k) {
    const Vector v = plus(step.qdot, 3.0 * k, d);
    const double E_q = step.E.value(plus(step.q_t, h, v)), E_v = h * h * printed_E(step, v);
    least = std::min(least, E_q - E_v);
    most = std::max(most, E_q - E_v);
    size = std::max({size, std::abs(E_q), std::abs(E_v)});
  }
  sheet.at_most("E(q) - h^2 E(v): spread over 7 velocities, relative to E", (most - least) / size, 1e-11, "",
                "a constant but for round-off in sums over all tets");
  Vector g_q(step.start.size()), g_v(step.start.size());
  const Vector v0 = scaled(plus(step.start, -1, step.q_t), 1 / h);
  step.E.gradient(step.start, g_q);
  form.gradient(v0, g_v);
  sheet.at_most("|dE/dq| / |dE/dv| / h, distance from 1", std::abs(norm(g_q) / norm(g_v) / h - 1), 1e-12, "",
                "the chain rule: dE/dv = h dE/dq / h^2");

  Newton newton_q(make_linear_solver("cholesky")), newton_v(make_linear_solver("cholesky"));
  const auto q = iterates(step.E, newton_q, step.start, 50), v = iterates(form, newton_v, v0, 50);
  // The error of H d = -g is the round-off of the gradient over the smallest eigenvalue of H >= M.
  const double noise = 4 * step.E.scales().gradient_round_off / step.smallest_mass() + 4 * kEpsilon * max_abs(step.q_t);
  sheet.show("Newton iterations", static_cast<double>(q.size()) - 1, "");
  sheet.at_most("Newton: largest distance between the iterates of both forms", distance(q, v, form), noise, "m",
                "round-off of the gradient over the least eigenvalue of M");
  sheet.at_least("Newton: length of the first step", max_abs(plus(q[1], -1, q[0])), 1e3 * noise, "m",
                 "the iterates do move");

  GradientDescent descent;
  Rescaled same_values(step.E, h * h);
  const auto descent_q = iterates(step.E, descent, step.start, 5), descent_v = iterates(form, descent, v0, 5),
             descent_scaled = iterates(same_values, descent, step.start, 5);
  sheet.at_most("gradient descent on E(q) and on E(v): largest distance of 5 iterates",
                distance(descent_q, descent_v, form), noise, "m",
                "the factor h^2 between the values cancels the change of variables");
  Newton newton_scaled(make_linear_solver("cholesky"));
  const auto newton_s = iterates(same_values, newton_scaled, step.start, 50);
  sheet.at_most("Newton on E(q) / h^2 and on E(v): largest distance", distance(newton_s, v, form), noise, "m",
                "Newton's method is invariant under linear changes of variables");
  const double ratio =
      norm(plus(descent_scaled[1], -1, descent_scaled[0])) / norm(plus(descent_v[1], -1, descent_v[0])) / h;
  sheet.show("gradient descent on E(q) / h^2: first step / that on E(v)", ratio, "",
             "of one function, written over q or over v");
  const double apart = distance(descent_scaled, descent_v, form);
  sheet.at_least("gradient descent on E(q) / h^2 and on E(v): largest distance of 5 iterates", apart, 1e3 * noise, "m",
                 "gradient descent depends on the units of the variables");
  sheet.remark(
      "Newton's iterates are the same points in both forms. So are those of gradient descent, because E(q) = h^2 E(v): "
      "the factor h^2 cancels the change of variables. For the same function, E(q) / h^2 over q and E(v) over v, "
      "gradient descent takes different paths, and Newton's method the same.");
  CsvFile table = sheet.table("iterates.csv", {"iteration", "newton_distance_m"});
  for (size_t k = 0; k < std::min(q.size(), v.size()); ++k)
    table.append(CsvRow().add(static_cast<int>(k)).add(max_abs(plus(position_of(form, v[k]), -1, q[k]))));
}

}  // namespace aspic::cli::lecture

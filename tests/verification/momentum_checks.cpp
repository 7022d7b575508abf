// Linear and angular momentum over many steps.
#include <algorithm>

#include "mesh/generators.h"
#include "reference/models.h"
#include "verification/families.h"

namespace aspic::verify {

Momenta momenta(const Simulation& simulation) {
  std::vector<double> p(simulation.state().q.size());
  simulation.model().mass->multiply(simulation.state().qdot, p);
  Momenta sum{{}, {}};
  for (size_t i = 0; i < p.size(); i += 3) {
    const double* q = &simulation.state().q[i];
    const Vec3d pi{{p[i], p[i + 1], p[i + 2]}};
    sum.linear = sum.linear + pi;
    sum.angular = sum.angular + cross(Vec3d{{q[0], q[1], q[2]}}, pi);
  }
  return sum;
}

Simulation spinning_box(const std::string& integrator, double h, const Vec3d& gravity, double young) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.young = young, .gravity = gravity});
  State start = at_rest(model.mesh);
  for (size_t i = 0; i < start.q.size(); i += 3) {
    start.qdot[i] = -6 * start.q[i + 1] + 2;
    start.qdot[i + 1] = 6 * start.q[i];
    start.q[i + 2] *= 1.2;
  }
  SimulationOptions options{.h = h, .integrator = integrator, .solver = {}};
  options.solver.minimize.tolerance = 1e-13;
  return Simulation(std::move(model), start, options);
}

namespace {

void check_linear(const Subject& subject, Findings& found) {
  const double h = 0.005;
  const Vec3d gravity{{0, -9.81, 0}};
  for (const std::string integrator : {"backward_euler", "bdf2", "tr_bdf2", "midpoint", "trapezoid"}) {
    Simulation simulation = spinning_box(subject.replacement(integrator), h, gravity, 1e4);
    const Vec3d start = momenta(simulation).linear;
    double worst = 0;
    for (int i = 1; i <= 20; ++i) {
      take_steps(simulation, 1, integrator);
      const Vec3d expected = start + (1000 * h * i) * gravity;
      worst = std::max(worst, norm(momenta(simulation).linear - expected) / norm(start));
    }
    found.expect_small(integrator + ": |p - p0 - m g t| / |p0|, largest of 20 steps", worst, 1e-9,
                       "each solve has a residual of 1e-13 of the balancing forces");
  }
}

void check_angular(const Subject& subject, Findings& found) {
  const std::string name = "midpoint";
  Simulation simulation = spinning_box(subject.replacement(name), 0.02, {}, 1e4);
  const Vec3d start = momenta(simulation).angular;
  double worst = 0;
  for (int i = 0; i < 50; ++i) {
    take_steps(simulation, 1, name);
    worst = std::max(worst, norm(momenta(simulation).angular - start) / norm(start));
  }
  found.expect_small("midpoint: |L - L0| / |L0|, largest of 50 steps", worst, 1e-10,
                     "each solve has a residual of 1e-13 of the balancing forces");
}

// L = sum q x M v changes by h sum v_new x (M v_old), so backward Euler does not conserve it.
void check_angular_euler(const Subject& subject, Findings& found) {
  const double h = 0.01;
  Simulation simulation = spinning_box(subject.replacement("backward_euler"), h, {}, 1e4);
  double worst = 0, lost = 0;
  const double first = norm(momenta(simulation).angular);
  for (int i = 0; i < 10; ++i) {
    const Vec3d before = momenta(simulation).angular;
    std::vector<double> Mv(simulation.state().q.size());
    simulation.model().mass->multiply(simulation.state().qdot, Mv);
    take_steps(simulation, 1, "backward_euler");
    Vec3d change{};
    for (size_t k = 0; k < Mv.size(); k += 3) {
      const double* w = &simulation.state().qdot[k];
      change = change + h * cross(Vec3d{{w[0], w[1], w[2]}}, Vec3d{{Mv[k], Mv[k + 1], Mv[k + 2]}});
    }
    worst = std::max(worst, norm(momenta(simulation).angular - before - change) / first);
    lost += norm(change);
  }
  found.expect_small("backward_euler: |dL - h sum v_new x M v_old| / |L0|, largest of 10 steps", worst, 1e-8,
                     "each solve has a residual of 1e-13 of the balancing forces");
  found.expect("backward_euler: the loss is significant (sum |dL| > 1e-3 |L0|)",
               {lost > 1e-3 * first ? 1.0 : 0.0, 1, 0}, "yes or no");
}

}  // namespace

void add_momentum_checks(std::vector<Check>& checks) {
  checks.push_back({"invariants",
                    "linear_momentum",
                    "Linear momentum changes by the impulse of gravity",
                    "A box spins, vibrates and falls; implicit integrators of one step or more.",
                    "Newton's second law",
                    check_linear,
                    {},
                    {R"tex(p(t) = p_0 + m g t)tex"}});
  checks.push_back({"invariants",
                    "angular_momentum",
                    "The midpoint rule conserves angular momentum",
                    "A soft box spins and vibrates freely.",
                    "Conservation of angular momentum",
                    check_angular,
                    {"Hairer1996"},
                    {R"tex(L(t) = L_0)tex"}});
  checks.push_back({"invariants",
                    "angular_momentum_of_backward_euler",
                    "Loss of angular momentum by backward Euler",
                    "The same box.",
                    "The update of the scheme",
                    check_angular_euler,
                    {},
                    {R"tex(L_{n+1} - L_n = h \sum_i v_{n+1, i} \times (M v_n)_i)tex"}});
}

}  // namespace aspic::verify

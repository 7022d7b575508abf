// What theory says of each integrator: its damping and frequency, its invariants, its path of free fall.
#include "dynamics/integrator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "dynamics/oscillator_test.h"

namespace aspic {
namespace {

using namespace testing_models;

// r of the oscillation after its first steps: those of a scheme that begins otherwise have died away.
std::complex<double> measured_factor(const std::string& integrator, double h) {
  Simulation simulation = oscillator({.h = h, .integrator = integrator, .solver = {}});
  for (int i = 0; i < 40; ++i) simulation.step();
  std::vector<double> x;
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(is_success(simulation.step().status)) << integrator;
    x.push_back(oscillator_position(simulation));
  }
  return factor_per_step(x);
}

TEST(Integrators, DampAndDelayAnOscillatorAsTheirFormulasSay) {
  struct Expected {
    double energy_after_one_period, frequency_ratio;
  };
  const double x = 0.1;  // w h
  const std::map<std::string, Expected> expected = {
      {"backward_euler", {.535156, .99669}},
      {"linearly_implicit_euler", {.535156, .99669}},
      {"bdf2", {.996940, .99671}},
      {"tr_bdf2", {.999954, .99960}},
      {"midpoint", {1, .99917}},
      {"trapezoid", {1, .99917}},
      {"symplectic_euler", {1, 1.00042}},
      {"forward_euler", {std::pow(1.01, 20 * std::numbers::pi), .99669}},
      {"rk4", {1 - std::pow(x, 5) / 72 * 2 * std::numbers::pi, 1 - std::pow(x, 4) / 120}}};
  for (const auto& [integrator, value] : expected) {
    const std::complex<double> r = measured_factor(integrator, 0.01);
    const double periods = 2 * std::numbers::pi / x;  // in steps
    EXPECT_NEAR(std::pow(std::norm(r), periods), value.energy_after_one_period,
                6e-7 * std::max(1.0, value.energy_after_one_period))
        << integrator;
    EXPECT_NEAR(std::arg(r) / x, value.frequency_ratio, 6e-6) << integrator;
  }
  EXPECT_EQ(expected.size() + 1, integrator_names().size()) << "all but quasi_static";
}

double oscillator_energy(const Simulation& s) {
  const double x = oscillator_position(s), v = oscillator_velocity(s);
  return 0.5 * v * v + 50 * x * x;
}

TEST(Integrators, EulersMethodsGainLoseAndKeepEnergyOfAnOscillatorByFixedFactors) {
  for (const auto& [integrator, factor] : {std::pair{"forward_euler", 1.01}, {"backward_euler", 1 / 1.01}}) {
    Simulation simulation = oscillator({.h = 0.01, .integrator = integrator, .solver = {}});
    for (int i = 0; i < 100; ++i) {
      const double before = oscillator_energy(simulation);
      simulation.step();
      EXPECT_NEAR(oscillator_energy(simulation) / before, factor, 1e-12) << integrator;
    }
  }
  Simulation simulation = oscillator({.h = 0.01, .integrator = "symplectic_euler", .solver = {}});
  const double E = oscillator_energy(simulation);
  // q moves with the new velocity, so the shadow energy has + h/2 w^2 x v.
  const auto invariant = [&] {
    return oscillator_energy(simulation) -
           0.5 * 0.01 * 100 * oscillator_position(simulation) * oscillator_velocity(simulation);
  };
  for (int i = 0; i < 1000; ++i) {
    simulation.step();
    EXPECT_GE(oscillator_energy(simulation), .95238 * E);
    EXPECT_LE(oscillator_energy(simulation), 1.05264 * E);
    EXPECT_NEAR(invariant(), E, 1e-11 * E);
  }
}

TEST(Integrators, AreOfTheirOrderWithDampingAndAMovingTarget) {
  // x'' + c x' + k (x - s(t)) = 0 with c = 2, k = 100 and s such that x = cos 3t.
  const double c = 2, k = 100, w = 3;
  const auto target = [=](double t) { return ((k - w * w) * std::cos(w * t) - c * w * std::sin(w * t)) / k; };
  for (const std::string& integrator : integrator_names()) {
    const auto scheme = make_integrator(integrator);
    if (scheme->is_static()) continue;
    const auto error = [&](double h) {
      Simulation s = oscillator({.h = h, .integrator = integrator, .solver = {}},
                                {.stiffness = k, .damping = c, .offset = target});
      for (int i = 0; i < std::lround(1 / h); ++i) s.step();
      return std::abs(oscillator_position(s) - std::cos(w)) + std::abs(oscillator_velocity(s) + w * std::sin(w));
    };
    const double h = 0.004;
    EXPECT_NEAR(std::log2(error(h) / error(h / 2)), scheme->order(), 0.1) << integrator;
  }
}

TEST(Integrators, FallFreelyAsTheirFormulasSay) {
  // After n steps: backward, linearly implicit and symplectic Euler g h^2 n(n+1)/2, forward Euler g h^2 n(n-1)/2, and
  // those of higher order the parabola.
  const int n = 20;
  const double h = 0.01, g = 9.81;
  const std::map<std::string, double> first_order = {{"backward_euler", n * (n + 1) / 2.0},
                                                     {"linearly_implicit_euler", n * (n + 1) / 2.0},
                                                     {"symplectic_euler", n * (n + 1) / 2.0},
                                                     {"forward_euler", n * (n - 1) / 2.0}};
  for (const std::string& integrator : integrator_names()) {
    if (integrator == "quasi_static") continue;
    const double steps = first_order.contains(integrator) ? first_order.at(integrator) : n * n / 2.0;
    SimulationOptions options{.h = h, .integrator = integrator, .solver = {}};
    options.solver.minimize.tolerance = 1e-14;
    // Soft enough for the explicit schemes to be stable.
    Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.young = 1e3});
    Simulation simulation = simulate(std::move(model), options);
    for (int i = 0; i < n; ++i) ASSERT_TRUE(is_success(simulation.step().status)) << integrator;
    for (int v = 0; v < simulation.model().mesh.vertex_count(); ++v)
      EXPECT_NEAR(simulation.state().q[3 * v + 1], simulation.model().mesh.rest[v][1] - g * h * h * steps, 1e-12)
          << integrator;
  }
}

Model spinning_box(State& start) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.young = 1e4, .gravity = {}});
  start = at_rest(model.mesh);
  for (size_t i = 0; i < start.q.size(); i += 3) {
    start.qdot[i] = -6 * start.q[i + 1] + 2;
    start.qdot[i + 1] = 6 * start.q[i];
    start.q[i + 2] *= 1.2;
  }
  return model;
}

// Sum of p, and of x cross p.
std::pair<Vec3d, Vec3d> momenta(const Simulation& simulation) {
  std::vector<double> p(simulation.state().q.size());
  simulation.model().mass->multiply(simulation.state().qdot, p);
  Vec3d linear{}, angular{};
  for (size_t i = 0; i < p.size(); i += 3) {
    const double* q = &simulation.state().q[i];
    const Vec3d pi{{p[i], p[i + 1], p[i + 2]}};
    linear = linear + pi;
    angular = angular + cross(Vec3d{{q[0], q[1], q[2]}}, pi);
  }
  return {linear, angular};
}

TEST(Integrators, MidpointConservesLinearAndAngularMomentum) {
  State start;
  Model model = spinning_box(start);
  SimulationOptions options{.h = 0.02, .integrator = "midpoint", .solver = {}};
  options.solver.minimize.tolerance = 1e-13;
  Simulation simulation(std::move(model), start, options);
  const auto [linear, angular] = momenta(simulation);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(is_success(simulation.step().status));
    const auto [p, L] = momenta(simulation);
    for (int r = 0; r < 3; ++r) {
      EXPECT_NEAR(p[r], linear[r], 1e-10 * 1000);
      EXPECT_NEAR(L[r], angular[r], 1e-10 * angular[2]);
    }
  }
}

TEST(Integrators, LoseTheEnergyOfAStiffBodyInTheOrderOfTheirDamping) {
  std::map<std::string, double> left;  // kinetic + potential after 50 steps, relative to the start
  for (const char* integrator : {"backward_euler", "bdf2", "tr_bdf2", "midpoint"}) {
    State start;
    Model model = spinning_box(start);
    Simulation simulation(std::move(model), start, {.h = 0.02, .integrator = integrator, .solver = {}});
    double energy = simulation.kinetic_energy(), lost = 0;
    for (const double V : simulation.potential_energies()) energy += V;
    for (int i = 0; i < 50; ++i) lost += simulation.step().numerical_loss;
    left[integrator] = 1 - lost / energy;
  }
  EXPECT_LT(left["backward_euler"], left["bdf2"]);
  EXPECT_LT(left["bdf2"], left["tr_bdf2"]);
  EXPECT_LT(left["tr_bdf2"], left["midpoint"]);
  EXPECT_NEAR(left["midpoint"], 1, 0.01);
}

}  // namespace
}  // namespace aspic

#include "reference/integrators.h"

#include <cmath>
#include <numbers>

#include "base/check.h"
#include "dynamics/integrator.h"
#include "energy/rayleigh_damping.h"
#include "mesh/generators.h"

namespace aspic::verify {

Model oscillator_model(const OscillatorOptions& options) {
  const auto target = [offset = options.offset](const Vec3d& X, double t) { return X + Vec3d{{offset(t), 0, 0}}; };
  Model model = ModelBuilder({{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}, {{0, 1, 2, 3}}, {}})
                    .material("neo_hookean", std::vector<MaterialParameters>(1))  // without stiffness
                    .density(24)
                    .mass(MassKind::lumped)
                    .springs(
                        "springs", [](const Vec3d&) { return true; }, options.stiffness, target)
                    .build();
  if (options.damping > 0) model.damping.push_back(make_rayleigh_damping(*model.mass, options.damping, nullptr, 0));
  return model;
}

Simulation oscillator(SimulationOptions options, const OscillatorOptions& physics) {
  Model model = oscillator_model(physics);
  State start = at_rest(model.mesh);
  for (size_t i = 0; i < start.q.size(); i += 3) start.q[i] += 1;
  options.solver.minimize.tolerance = 1e-15;
  return Simulation(std::move(model), std::move(start), std::move(options));
}

double oscillator_energy(const Simulation& s) {
  const double x = oscillator_position(s), v = oscillator_velocity(s);
  return 0.5 * v * v + 50 * x * x;
}

std::complex<double> factor_per_step(std::span<const double> x) {
  ASPIC_CHECK(x.size() == 4);
  const double determinant = x[1] * x[1] - x[0] * x[2];
  const double trace = (x[2] * x[1] - x[0] * x[3]) / determinant;
  const double product = (x[2] * x[2] - x[1] * x[3]) / determinant;
  return {trace / 2, std::sqrt(product - trace * trace / 4)};
}

std::vector<std::string> integrators_in_time() {
  std::vector<std::string> names = integrator_names();
  std::erase_if(names, [](const std::string& name) { return make_integrator(name)->facts().is_static(); });
  return names;
}

const std::map<std::string, Oscillation>& expected_oscillations() {
  static const double x = 0.1;  // w h
  static const std::map<std::string, Oscillation> expected = {
      {"backward_euler", {.535156, .99669}},
      {"linearly_implicit_euler", {.535156, .99669}},
      {"bdf2", {.996940, .99671}},
      {"tr_bdf2", {.999954, .99960}},
      {"midpoint", {1, .99917}},
      {"trapezoid", {1, .99917}},
      {"symplectic_euler", {1, 1.00042}},
      {"forward_euler", {std::pow(1.01, 20 * std::numbers::pi), .99669}},
      {"rk4", {1 - std::pow(x, 5) / 72 * 2 * std::numbers::pi, 1 - std::pow(x, 4) / 120}}};
  return expected;
}

Oscillation measured_oscillation(const std::string& integrator) {
  Simulation simulation = oscillator({.h = 0.01, .integrator = integrator, .solver = {}});
  take_steps(simulation, 40, integrator);
  double x[4];
  for (double& position : x) {
    take_steps(simulation, 1, integrator);
    position = oscillator_position(simulation);
  }
  const std::complex<double> r = factor_per_step(x);
  return {std::pow(std::norm(r), 2 * std::numbers::pi / 0.1), std::arg(r) / 0.1};
}

double expected_fall(const std::string& integrator, int n) {
  const double steps = n;
  if (integrator == "forward_euler") return steps * (n - 1) / 2;
  const bool is_early =
      integrator == "backward_euler" || integrator == "linearly_implicit_euler" || integrator == "symplectic_euler";
  return is_early ? steps * (n + 1) / 2 : steps * n / 2;
}

double free_fall_error(const std::string& integrator, double expected) {
  const double h = 0.01, g = 9.81;
  SimulationOptions options{.h = h, .integrator = integrator, .solver = {}};
  options.solver.minimize.tolerance = 1e-14;
  // The box is soft enough for stability of the explicit schemes.
  Simulation simulation = simulate(make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.young = 1e3}), options);
  take_steps(simulation, kFallSteps, integrator);
  const double fall = g * h * h * expected;
  return largest_difference(simulation.state().q, at_vertices(simulation.model().mesh, [fall](const Vec3d& X) {
                              return X - Vec3d{{0, fall, 0}};
                            }));
}

double driven_oscillator_error(const std::string& integrator, double h) {
  // x'' + c x' + k (x - s(t)) = 0 with s such that x = cos w t.
  const double c = 2, k = 100, w = 3;
  const auto target = [=](double t) { return ((k - w * w) * std::cos(w * t) - c * w * std::sin(w * t)) / k; };
  Simulation s =
      oscillator({.h = h, .integrator = integrator, .solver = {}}, {.stiffness = k, .damping = c, .offset = target});
  take_steps(s, static_cast<int>(std::lround(1 / h)), integrator);
  return std::abs(oscillator_position(s) - std::cos(w)) + std::abs(oscillator_velocity(s) + w * std::sin(w));
}

}  // namespace aspic::verify

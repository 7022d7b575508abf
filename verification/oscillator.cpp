#include "verification/oscillator.h"

#include <cmath>

#include "base/check.h"
#include "energy/rayleigh_damping.h"

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

}  // namespace aspic::verify

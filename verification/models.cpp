#include "verification/models.h"

#include <stdexcept>

#include "base/check.h"
#include "math/vectors.h"

namespace aspic::verify {

ModelBuilder model_of(TetMesh mesh, const ModelOptions& options) {
  ModelBuilder builder(std::move(mesh));
  builder.material(options.material, {.young = options.young, .poisson = options.poisson})
      .density(options.density)
      .mass(options.mass)
      .gravity(options.gravity);
  return builder;
}

void take_steps(Simulation& simulation, int count, const std::string& what) {
  for (int i = 0; i < count; ++i) {
    const StepReport report = simulation.step();
    if (!is_success(report.status))
      throw std::runtime_error(what + ": step " + std::to_string(report.step) + " did not converge: it is " +
                               std::string(to_string(report.status)));
  }
}

std::vector<Mode> lowest_modes(const Model& model, int count) {
  Modes found = vibration_modes(model, at_rest(model.mesh).q, count);
  if (found.status != ModesStatus::converged) throw std::runtime_error(message(found.status));
  return std::move(found.modes);
}

std::vector<double> frequencies(const Model& model, int count) {
  std::vector<double> found;
  for (const Mode& mode : lowest_modes(model, count)) found.push_back(mode.frequency);
  return found;
}

double largest_difference(std::span<const double> a, std::span<const double> b) {
  ASPIC_CHECK(a.size() == b.size());
  std::vector<double> d(a.size());
  for (size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
  return max_abs(d);
}

}  // namespace aspic::verify

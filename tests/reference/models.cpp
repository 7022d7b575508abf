#include "reference/models.h"

#include <algorithm>
#include <stdexcept>

#include "base/check.h"
#include "math/vectors.h"
#include "mesh/generators.h"

namespace aspic::verify {
void hold_plane(Model& model, int axis, std::vector<int> vertices) {
  if (vertices.empty()) vertices = vertices_where(model.mesh, [](const Vec3d&) { return true; });
  for (const Pin& pin : model.pins)
    if (pin.directions.empty())
      std::erase_if(vertices, [&](int v) {
        return std::find(pin.vertices.begin(), pin.vertices.end(), v) != pin.vertices.end();
      });
  Vec3d normal{};
  normal[axis] = 1;
  model.pins.push_back({"plane", std::move(vertices), {}, {normal}});
}

TetMesh make_layer(int length, int height, double thickness,
                   const std::function<std::array<double, 2>(double, double)>& place) {
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, thickness}}, {length, height, 1});
  for (Vec3d& X : mesh.rest) {
    const auto [x, y] = place(X[0], X[1]);
    X = {{x, y, X[2]}};
  }
  return mesh;
}

PlaneModuli plane_stress(double young, double poisson) {
  return {young * (1 + 2 * poisson) / ((1 + poisson) * (1 + poisson)), poisson / (1 + poisson)};
}

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

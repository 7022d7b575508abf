#include "reference/statics.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "energy/linear_load.h"

namespace aspic::verify {

std::vector<int> boundary_vertices(const TetMesh& mesh) {
  std::vector<int> vertices = boundary_surface(mesh).tet_vertex;
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

Simulation equilibrium(Model model, int steps, const std::string& what, double tolerance) {
  SimulationOptions options{.h = 1.0 / steps, .integrator = "quasi_static", .solver = {}};
  options.solver.minimize.tolerance = tolerance;
  Simulation simulation = simulate(std::move(model), options);
  take_steps(simulation, steps, what);
  return simulation;
}

std::vector<double> elastic_forces(const Simulation& simulation) {
  std::vector<double> g(simulation.state().q.size());
  for (const auto& term : simulation.model().elasticity) term->add_gradient(simulation.state().q, 1, g);
  return g;
}

Vec3d sum_over(const std::vector<int>& vertices, const std::vector<double>& values) {
  Vec3d sum{};
  for (const int v : vertices) sum = sum + Vec3d{{values[3 * v], values[3 * v + 1], values[3 * v + 2]}};
  return sum;
}

std::unique_ptr<Energy> make_growing_load(std::vector<double> force, std::function<double(double time)> factor) {
  const auto grow = [force, factor](double time, std::span<double> sum) {
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += factor(time) * force[i];
  };
  return make_linear_load("growing_load", std::vector<double>(force.size(), 0.0), grow);
}

std::vector<double> traction_on(const TetMesh& mesh, const std::function<bool(const Vec3d&)>& is_loaded,
                                const Vec3d& traction) {
  std::vector<double> force(3 * mesh.rest.size());
  for (const Face& face : faces_where(mesh, is_loaded)) add_traction(mesh.rest, face, traction, force);
  return force;
}

std::vector<Face> faces_where(const TetMesh& mesh, const Predicate& is_part) {
  std::vector<Face> patch = boundary_faces(mesh, 0, mesh.tet_count());
  std::erase_if(patch, [&](const Face& face) {
    return !std::all_of(face.corners.begin(), face.corners.end(), [&](int v) { return is_part(mesh.rest[v]); });
  });
  return patch;
}

Extrapolation extrapolate(const std::vector<double>& values) {
  ASPIC_CHECK(values.size() >= 3);
  const double* v = values.data() + values.size() - 3;
  const double ratio = (v[1] - v[0]) / (v[2] - v[1]);
  return {std::log2(ratio), v[2] + (v[2] - v[1]) / (ratio - 1)};
}

double richardson(const std::vector<double>& values, double order) {
  ASPIC_CHECK(values.size() >= 2);
  const double fine = values.back(), coarse = values[values.size() - 2];
  return fine + (fine - coarse) / (std::exp2(order) - 1);
}

}  // namespace aspic::verify

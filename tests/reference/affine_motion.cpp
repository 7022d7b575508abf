#include <algorithm>
#include <cmath>

#include "energy/linear_load.h"
#include "mesh/generators.h"
#include "reference/integrators.h"

namespace aspic::verify {
namespace {

const Mat3d kB = {{0.3, 0.1, 0, -0.2, 0.1, 0.2, 0.1, 0, -0.2}};
double s(double t) { return std::sin(3 * t + 0.5) - std::sin(0.5); }
Vec3d moved(const Vec3d& X, double t) { return X + s(t) * (kB * X); }
Vec3d velocity(const Vec3d& X, double t) { return 3 * std::cos(3 * t + 0.5) * (kB * X); }
Vec3d acceleration(const Vec3d& X, double t) { return -9 * std::sin(3 * t + 0.5) * (kB * X); }

// The dead load that moves the model in this way: M x'' + dV/dx.
std::unique_ptr<Energy> make_affine_load(const Model& model) {
  const auto add = [mesh = model.mesh, &mass = *model.mass, &elasticity = *model.elasticity[0]](
                       double time, std::span<double> force) {
    std::vector<double> inertia(force.size());
    mass.multiply(at_vertices(mesh, [&](const Vec3d& X) { return acceleration(X, time); }), inertia);
    for (size_t i = 0; i < force.size(); ++i) force[i] += inertia[i];
    elasticity.add_gradient(at_vertices(mesh, [&](const Vec3d& X) { return moved(X, time); }), 1, force);
  };
  return make_linear_load("affine_load", std::vector<double>(3 * model.mesh.rest.size(), 0.0), add);
}

}  // namespace

double affine_motion_error(const std::string& integrator, double h, Held held) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.young = 1e3, .gravity = {}});
  const auto is_held = [held](const Vec3d& X) {
    const auto outer = [](double c) { return c < 1e-9 || c > 1 - 1e-9; };
    return held == Held::on_one_face ? X[0] < 1e-9 : std::any_of(X.a, X.a + 3, outer);
  };
  if (held != Held::nowhere) model.pins.push_back({"held", vertices_where(model.mesh, is_held), moved});
  model.loads.push_back(make_affine_load(model));
  State start = at_rest(model.mesh);
  start.qdot = at_vertices(model.mesh, [](const Vec3d& X) { return velocity(X, 0); });
  SimulationOptions options{.h = h, .integrator = integrator, .solver = {}};
  options.solver.minimize.tolerance = 1e-13;
  Simulation simulation(std::move(model), start, options);
  take_steps(simulation, static_cast<int>(std::lround(0.4 / h)), integrator);
  return largest_difference(simulation.state().q,
                            at_vertices(simulation.model().mesh, [](const Vec3d& X) { return moved(X, 0.4); }));
}

}  // namespace aspic::verify

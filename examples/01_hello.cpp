// A cube of jelly hangs from its top face and sags under its own weight.
//
// Each step of backward Euler minimises, over the positions x of all vertices,
//   E(x) = 1/2 (x - x~)' M (x - x~) + h^2 V(x),   x~ = q + h qdot,
// where V is elastic energy plus weight; the minimiser is the next q.
#include <cstdio>
#include <vector>

#include "dynamics/simulation.h"
#include "energy/linear_load.h"
#include "mesh/generators.h"

using namespace aspic;

int main() {
  const double density = 1000;  // [kg/m^3]
  const double edge = 0.1;      // [m]
  const MaterialParameters jelly{.lame = lame_from_young_poisson(5e3 /* [Pa] */, 0.4)};

  // What does not change: the mesh, its mass, the terms of V, and what is held.
  Model model;
  model.mesh = make_box({0, 0, 0}, {edge, edge, edge}, {4, 4, 4});
  const TetMesh& mesh = model.mesh;
  model.bodies = {{"jelly", 0, mesh.vertex_count(), 0, mesh.tet_count()}};
  model.density.assign(mesh.tet_count(), density);
  model.mass = std::make_unique<MassMatrix>(mesh, model.density, MassKind::consistent);
  model.elasticity.push_back(
      make_tet_elasticity("neo_hookean", mesh, 0, std::vector<MaterialParameters>(mesh.tet_count(), jelly)));

  std::vector<double> weight(3 * mesh.vertex_count());  // [N]
  for (int t = 0; t < mesh.tet_count(); ++t) add_body_force(mesh, t, {0, -9.81 * density, 0}, weight);
  model.loads.push_back(make_linear_load("gravity", weight));

  Pin top{.name = "top", .vertices = {}, .motion = {}};
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    if (mesh.rest[i][1] == edge) top.vertices.push_back(i);
  }
  model.pins.push_back(top);

  // What changes: the positions and velocities. The jelly starts at rest in its rest shape.
  State start;
  for (const Vec3d& X : mesh.rest) start.q.insert(start.q.end(), {X[0], X[1], X[2]});
  start.qdot.assign(start.q.size(), 0.0);

  SimulationOptions options;
  options.h = 0.01;  // [s]
  Simulation simulation(std::move(model), start, options);
  for (int i = 1; i <= 50; ++i) {
    const StepReport report = simulation.step();
    if (!is_success(report.status)) {
      std::printf("step %d did not converge\n", i);
      return 1;
    }
    if (i % 10 == 0) {
      std::printf("t = %.1f s: the corner is at y = %.4f m (%d iterations)\n", report.time, simulation.state().q[1],
                  report.iterations);
    }
  }
  return simulation.state().q[1] < 0 ? 0 : 1;  // vertex 0 was at the origin
}

// The lecture's loop written out: for each time step, minimise
//   E(q) = 1/2 (q - q~)' M (q - q~) + h^2 V(q),   q~ = q + h qdot,
// by Newton's method with backtracking line search. `Simulation` does the same with more care; both must agree.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "dynamics/incremental_potential.h"
#include "dynamics/simulation.h"
#include "energy/linear_load.h"
#include "linalg/linear_solver.h"
#include "mesh/generators.h"

using namespace aspic;
using Vector = std::vector<double>;

Model hanging_bar() {
  Model model;
  model.mesh = make_box({0, 0, 0}, {0.4, 0.1, 0.1}, {8, 2, 2});
  const TetMesh& mesh = model.mesh;
  model.bodies = {{"bar", 0, mesh.vertex_count(), 0, mesh.tet_count()}};
  model.density.assign(mesh.tet_count(), 1000.0);  // [kg/m^3]
  model.mass = std::make_unique<MassMatrix>(mesh, model.density, MassKind::consistent);
  const MaterialParameters rubber{.lame = lame_from_young_poisson(1e5 /* [Pa] */, 0.4)};
  model.elasticity.push_back(
      make_tet_elasticity("neo_hookean", mesh, 0, std::vector<MaterialParameters>(mesh.tet_count(), rubber)));
  Vector weight(3 * mesh.vertex_count());  // [N]
  for (int t = 0; t < mesh.tet_count(); ++t) add_body_force(mesh, t, {0, -9810, 0}, weight);
  model.loads.push_back(make_linear_load("gravity", weight));
  Pin wall{.name = "wall", .vertices = {}, .motion = {}};
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (mesh.rest[i][0] == 0) wall.vertices.push_back(i);
  model.pins.push_back(wall);
  return model;
}

double norm(const Vector& v) { return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0)); }

int main() {
  const double h = 0.01;  // [s]
  Model model = hanging_bar();
  State start;
  for (const Vec3d& X : model.mesh.rest) start.q.insert(start.q.end(), {X[0], X[1], X[2]});
  start.qdot.assign(start.q.size(), 0.0);

  const Pins pins(model.pins, start.q);
  IncrementalPotential E(model, pins);
  const auto solver = make_linear_solver("cholesky");
  solver->analyze(E.pattern());

  Vector q = start.q, qdot = start.qdot, predicted = q, g(q.size()), d(q.size()), trial(q.size());
  for (int step = 1; step <= 20; ++step) {
    const Vector before = q;
    for (size_t i = 0; i < q.size(); ++i) predicted[i] = q[i] + h * qdot[i];
    E.begin_step(predicted, 1, h * h);

    int iteration = 0;  // the guess is q itself
    for (E.gradient(q, g); norm(g) > 1e-10; E.gradient(q, g), ++iteration) {
      if (iteration == 50) return std::printf("step %d did not converge\n", step), 1;
      if (!solver->factorize(E.hessian(q, {Definiteness::clamped}))) return 1;
      solver->solve(g, d, 0);  // H d = g, then turned round
      double slope = 0;
      for (size_t i = 0; i < d.size(); ++i) slope -= g[i] * d[i];
      const Evaluation at_q = E.evaluate(q);
      for (double alpha = 1;; alpha *= 0.5) {
        for (size_t i = 0; i < q.size(); ++i) trial[i] = q[i] - alpha * d[i];
        if (E.value(trial) <= at_q.value + at_q.round_off + 1e-4 * alpha * slope || alpha < 1e-10) break;
      }
      q = trial;
    }
    for (size_t i = 0; i < q.size(); ++i) qdot[i] = (q[i] - before[i]) / h;
    if (step % 5 == 0)
      std::printf("t = %.2f s: the tip is at y = %.6f m (%d iterations)\n", step * h, q.end()[-2], iteration);
  }

  Simulation simulation(hanging_bar(), start, {.h = h, .solver = {}});
  for (int step = 0; step < 20; ++step) simulation.step();
  double difference = 0;
  for (size_t i = 0; i < q.size(); ++i) difference = std::max(difference, std::abs(q[i] - simulation.state().q[i]));
  std::printf("Simulation differs by at most %.1e m\n", difference);
  return difference < 1e-6 ? 0 : 1;
}

#include "scene/sag.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/model_builder.h"
#include "dynamics/simulation.h"
#include "mesh/components.h"

namespace aspic {
namespace {

constexpr double kLongStep = 1;  // [s]; motions above one hertz come to rest in it

// Returns `held` and the vertices of every part without one of them.
std::vector<int> with_loose_parts(const TetMesh& mesh, std::vector<int> held) {
  std::vector<char> is_fixed(mesh.vertex_count(), 1);  // vertices of no tet stay fixed
  for (const Tet& tet : mesh.tets)
    for (const int v : tet) is_fixed[v] = 0;
  for (const int v : held) is_fixed[v] = 1;
  for (const std::vector<int>& part : tet_components(mesh)) {
    const bool is_loose = std::none_of(part.begin(), part.end(), [&](int t) {
      return std::any_of(mesh.tets[t].begin(), mesh.tets[t].end(), [&](int v) { return is_fixed[v] != 0; });
    });
    if (!is_loose) continue;
    for (const int t : part)
      for (const int v : mesh.tets[t]) is_fixed[v] = 1;
  }
  held.clear();
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (is_fixed[v]) held.push_back(v);
  return held;
}

}  // namespace

double sag(TetMesh mesh, std::vector<int> held, const SagOptions& options) {
  for (int t = 0; t < mesh.tet_count(); ++t)
    if (!(volume(mesh, t) > 0)) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> X = at_rest(mesh).q;
  std::vector<int> fixed = with_loose_parts(mesh, std::move(held));
  // A long step instead of statics, so that bodies on hinges have a solution.
  SimulationOptions statics{.h = kLongStep, .integrator = "backward_euler"};
  statics.solver.minimize.tolerance = 1e-3;
  Simulation simulation(ModelBuilder(std::move(mesh))
                            .material("linear", {.young = options.young, .poisson = options.poisson})
                            .density(options.density)
                            .mass(MassKind::lumped)
                            .gravity(options.gravity)
                            .pin("held", std::move(fixed))
                            .build(),
                        statics);
  if (!is_success(simulation.step().status)) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double>& q = simulation.state().q;
  double largest = 0;
  for (size_t i = 0; i < q.size(); i += 3)
    largest = std::max(largest, std::hypot(q[i] - X[i], q[i + 1] - X[i + 1], q[i + 2] - X[i + 2]));
  return largest;
}

}  // namespace aspic

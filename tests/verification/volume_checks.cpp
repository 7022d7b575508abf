// Locking of nearly incompressible bodies.
#include <cmath>
#include <string>

#include "mesh/generators.h"
#include "mesh/tet_nodes.h"
#include "reference/models.h"
#include "reference/statics.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

constexpr double kTraction = 1e-5;  // [Pa], with E = 1 Pa: small strains

// Work of a traction along y on the end of a beam 2 x 1 x 1, divided by its square, for n cells per unit.
double compliance(int n, int order, const std::string& material) {
  TetMesh mesh = make_box({{0, 0, 0}}, {{2, 1, 1}}, {2 * n, n, n});
  if (order == 2) mesh = raise_order(std::move(mesh));
  const std::vector<double> force =
      traction_on(mesh, [](const Vec3d& X) { return X[0] > 2 - 1e-9; }, {{0, kTraction, 0}});
  Model model = model_of(mesh, {.material = material, .young = 1, .poisson = 0.4999, .gravity = {}})
                    .pin("wall", [](const Vec3d& X) { return X[0] == 0; })
                    .load(make_growing_load(force))
                    .build();
  const Simulation simulation = equilibrium(std::move(model), 1, "nearly incompressible beam", 1e-6);
  double work = 0;
  for (size_t i = 0; i < force.size(); ++i)
    work += force[i] * (simulation.state().q[i] - simulation.model().mesh.rest[i / 3][static_cast<int>(i % 3)]);
  return work / (kTraction * kTraction);
}

void check_locking(const Subject& subject, Findings& found) {
  constexpr double kLimit = 35.96;
  const std::string material = subject.replacement("neo_hookean");
  const auto expect = [&](int n, double error, double tolerance) {
    const double measured = compliance(n, 2, material) / kLimit - 1;
    found.expect("quadratic tets, " + std::to_string(n) + " cells per unit: error of the compliance",
                 {measured, error, tolerance}, "measured before; the limit is known to 2e-3");
  };
  expect(2, -0.028, 0.004);
  if (subject.quick) return;
  expect(4, -0.0135, 0.003);
  expect(8, -0.006, 0.003);
  found.expect("linear tets, 8 cells per unit: error of the compliance",
               {compliance(8, 1, material) / kLimit - 1, -0.78, 0.01}, "they lock");
}

}  // namespace

void add_volume_checks(std::vector<Check>& checks) {
  checks.push_back({"statics",
                    "beam_incompressible",
                    "A nearly incompressible beam",
                    "A beam 2 x 1 x 1, nu = 0.4999, clamped, with a small traction on its end.",
                    "The limit of quadratic tets on meshes of up to 52 920 degrees of freedom",
                    check_locking,
                    {"Simo1985"}});
}

}  // namespace aspic::verify

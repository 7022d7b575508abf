// Patch tests: linear tets hold affine states exactly, on any mesh.
#include <algorithm>
#include <cmath>

#include "mesh/generators.h"
#include "verify/families.h"
#include "verify/statics.h"

namespace aspic::verify {
namespace {

TetMesh irregular_box(BoxCut cut) {
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {4, 4, 4}, cut);
  const auto inner = [](double c) { return c > 1e-9 && c < 1 - 1e-9; };
  for (Vec3d& X : mesh.rest)
    if (std::all_of(X.a, X.a + 3, inner))
      X = X + Vec3d{{0.04 * std::sin(9 * X[1]), 0.03 * std::cos(7 * X[2]), -0.02 * std::sin(8 * X[0])}};
  return mesh;
}

struct Patch {
  double position, stress;  // largest errors, relative to the body and to the largest stress
};

Patch patch_error(const TetMesh& mesh, const std::string& material, double poisson) {
  const Mat3d F = {{1.2, 0.1, 0, -0.15, 0.9, 0.1, 0.05, 0, 1.1}};
  Model model = make_model(mesh, {.material = material, .young = 1, .poisson = poisson, .gravity = {}});
  model.pins.push_back(
      {"boundary", boundary_vertices(mesh), [F](const Vec3d& X, double t) { return (1 - t) * X + t * (F * X); }});
  const Simulation simulation = equilibrium(std::move(model), 2, material, 1e-13);
  const double position =
      largest_difference(simulation.state().q, at_vertices(mesh, [F](const Vec3d& X) { return F * X; }));
  const std::vector<double> cauchy = simulation.tet_fields().cauchy;
  double spread = 0;
  for (int r = 0; r < 6; ++r) {
    double least = INFINITY, most = -INFINITY;
    for (size_t t = r; t < cauchy.size(); t += 6) least = std::min(least, cauchy[t]), most = std::max(most, cauchy[t]);
    spread = std::max(spread, most - least);
  }
  return {position, spread / largest(cauchy)};
}

void check_patch(const Subject& subject, Findings& found) {
  struct Shape {
    const char* name;
    TetMesh mesh;
  };
  std::vector<Shape> shapes = {{"distorted box", irregular_box(BoxCut::kuhn)}};
  if (!subject.quick) {
    shapes.push_back({"distorted box of five tets per cell", irregular_box(BoxCut::five)});
    shapes.push_back({"sphere", make_sphere(0.5, 0.2)});
  }
  for (const Shape& shape : shapes)
    for (const MaterialInfo& info : materials()) {
      const Patch patch = patch_error(shape.mesh, subject.taken_for(info.name), 0.4);
      const std::string reason = "the solve leaves 1e-13 of the forces";
      found.expect_small(info.name + ", " + shape.name + ": largest error of a position / size", patch.position, 1e-12,
                         reason);
      found.expect_small(info.name + ", " + shape.name + ": spread of the stress / stress", patch.stress, 1e-11,
                         reason);
    }
}

}  // namespace

void add_patch_checks(std::vector<Check>& checks) {
  checks.push_back({"patch",
                    "affine",
                    "Patch test: an affine state, held at the boundary",
                    "The boundary is stretched and sheared by one F; every vertex inside must find F X and every tet "
                    "the same stress, whatever the mesh.",
                    "Linear elements hold linear fields",
                    {"Irons1972"},
                    check_patch});
}

}  // namespace aspic::verify

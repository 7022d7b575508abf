// Patch tests: tets represent affine states exactly on any mesh.
#include <algorithm>
#include <cmath>

#include "math/vectors.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"
#include "reference/statics.h"
#include "reference/uniaxial.h"
#include "verification/families.h"

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
  double position, stress;  // largest errors, relative to the body size and the largest stress
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
  return {position, spread / max_abs(cauchy)};
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
  shapes.push_back({"distorted box of quadratic tets", raise_order(irregular_box(BoxCut::kuhn))});
  for (const Shape& shape : shapes)
    for (const MaterialInfo& info : materials()) {
      const Patch patch = patch_error(shape.mesh, subject.replacement(info.name), 0.4);
      const std::string reason = "the relative residual of the solve is 1e-13";
      found.expect_small(info.name + ", " + shape.name + ": largest error of a position / size", patch.position, 1e-12,
                         reason);
      found.expect_small(info.name + ", " + shape.name + ": spread of the stress / stress", patch.stress, 1e-11,
                         reason);
    }
}

constexpr double kHalfDigit = 5.1e-9;  // half a digit of the table

struct Pulled {
  double lateral, stress;  // as in Uniaxial; stress from the reaction of the pulled face
  double balance;          // sum of the reactions over the pulling force
};

// Unit cube, rotated by R, between three symmetry planes through its corner; the opposite face moves to a stretch.
Pulled pull_between_planes(const UniaxialReference& row, const std::string& material, const Mat3d& R) {
  TetMesh mesh = irregular_box(BoxCut::kuhn);
  std::vector<Pin> pins;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d n = R * Vec3d{{axis == 0 ? 1. : 0., axis == 1 ? 1. : 0., axis == 2 ? 1. : 0.}};
    pins.push_back({"plane", vertices_where(mesh, [=](const Vec3d& X) { return X[axis] < 1e-9; }), {}, {n}});
  }
  const Vec3d along = pins[0].directions[0], across = pins[1].directions[0];
  const auto move = [=](const Vec3d& X, double t) { return X + (std::min(t, 1.0) * (row.stretch - 1)) * along; };
  pins.push_back({"pulled", vertices_where(mesh, [](const Vec3d& X) { return X[0] > 1 - 1e-9; }), move, {along}});
  const int corner = vertices_where(mesh, [](const Vec3d& X) { return X[1] > 1 - 1e-9; }).front();
  for (Vec3d& X : mesh.rest) X = R * X;
  Model model = make_model(std::move(mesh), {.material = material, .young = 1, .poisson = row.poisson, .gravity = {}});
  model.pins = std::move(pins);
  Simulation simulation = equilibrium(std::move(model), 4, material, 1e-13);
  const Resultants sums = simulation.step().resultants;
  const Vec3d pull = sums.pins.back().force, rest = sums.bodies.at(0).force;
  return {dot(across, point(simulation.state().q, corner)), dot(along, pull),
          std::sqrt(dot(rest, rest) / dot(pull, pull))};
}

void check_planes(const Subject& subject, Findings& found) {
  const Mat3d turn =
      from_columns<double>({{2. / 3, 2. / 3, 1. / 3}}, {{-2. / 3, 1. / 3, 2. / 3}}, {{1. / 3, -2. / 3, 2. / 3}});
  for (const UniaxialReference& row : uniaxial_table()) {
    const bool is_steep = row.material == std::string("stvk") && row.stretch < 1;  // this bar buckles inside
    if (is_steep || (subject.quick && row.stretch != 1.5)) continue;
    for (const bool is_turned : {false, true}) {
      const Pulled pulled =
          pull_between_planes(row, subject.replacement(row.material), is_turned ? turn : identity3<double>());
      const std::string name = std::string(row.material) + ", nu = " + std::to_string(row.poisson).substr(0, 4) +
                               ", stretch " + std::to_string(row.stretch).substr(0, 3) +
                               (is_turned ? ", planes turned" : "");
      const std::string reason = "half a digit of the table";
      found.expect(name + ": lateral stretch", {pulled.lateral, row.expected.lateral, kHalfDigit}, reason);
      found.expect(name + ": reaction / area", {pulled.stress, row.expected.stress, kHalfDigit}, reason, "Pa");
      found.expect_small(name + ": sum of the reactions / pull", pulled.balance, 1e-11,
                         "the relative residual of the solve is 1e-13");
    }
  }
}

}  // namespace

void add_patch_checks(std::vector<Check>& checks) {
  checks.push_back({"patch",
                    "affine",
                    "Patch test: an affine state, held at the boundary",
                    "The boundary is stretched and sheared by one F; every vertex inside must find F X and every tet "
                    "the same stress, whatever the mesh.",
                    "Linear and quadratic elements represent linear fields",
                    check_patch,
                    {"Irons1972"},
                    {R"tex(x = F X)tex"}});
  checks.push_back({"patch", "symmetry_planes", "One eighth of a bar between symmetry planes",
                    "Three faces of a cube slide on planes, which hold them along their normals, and the opposite one "
                    "is moved: the state is uniaxial, the reaction its stress, however planes and cube are turned.",
                    "The table of uniaxial states, printed to 8 decimals", check_planes});
}

}  // namespace aspic::verify

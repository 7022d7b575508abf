#include "mesh/generators.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "mesh/surface.h"
#include "mesh/surface_orientation.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

double smallest_dihedral(const TetMesh& mesh) {
  double smallest = 180;
  for (int t = 0; t < mesh.tet_count(); ++t) smallest = std::min(smallest, dihedral_range(corners(mesh, t))[0]);
  return smallest;
}

int euler_characteristic(const TriMesh& surface) {
  return surface.vertex_count() - surface.triangle_count() / 2;  // V - E + F with 2 E = 3 F
}

// Returns whether each directed edge occurs once, with its opposite: the surface is closed, edge-manifold and oriented.
bool is_closed_and_oriented(const TriMesh& surface) {
  std::map<std::pair<int, int>, int> uses;
  for (const Triangle& t : surface.triangles)
    for (int i = 0; i < 3; ++i) ++uses[{t[i], t[(i + 1) % 3]}];
  return std::all_of(uses.begin(), uses.end(), [&](const auto& use) {
    const auto opposite = uses.find({use.first.second, use.first.first});
    return use.second == 1 && opposite != uses.end() && opposite->second == 1;
  });
}

void expect_sound(const TetMesh& mesh, int euler) {
  for (int t = 0; t < mesh.tet_count(); ++t) ASSERT_GT(volume(mesh, t), 0) << "tet " << t;
  const BoundarySurface boundary = boundary_surface(mesh);
  EXPECT_TRUE(is_closed_and_oriented(boundary.surface));
  EXPECT_EQ(euler_characteristic(boundary.surface), euler);
  // The mesh is conforming: if two tets shared only half a face, the boundary would contain both halves twice.
  EXPECT_NEAR(enclosed_volume(boundary.surface), total_volume(mesh), 1e-12 * total_volume(mesh));
  std::set<int> used;
  for (const Tet& tet : mesh.tets) used.insert(tet.begin(), tet.end());
  EXPECT_EQ(static_cast<int>(used.size()), mesh.vertex_count());
}

TEST(Box, HasExactVolumeForBothCuts) {
  for (BoxCut cut : {BoxCut::kuhn, BoxCut::five}) {
    const TetMesh mesh = make_box({{-1, 0, 2}}, {{1, 0.5, 5}}, {4, 3, 5}, cut);
    expect_sound(mesh, 2);
    EXPECT_NEAR(total_volume(mesh), 3, 3 * 1e-14);
    EXPECT_EQ(mesh.tet_count(), 4 * 3 * 5 * (cut == BoxCut::kuhn ? 6 : 5));
  }
}

TEST(Box, NumbersVerticesWithZFastest) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{4, 1, 1}}, {8, 2, 2});
  const int i = 3, j = 1, k = 2;
  const Vec3d& x = mesh.rest[(i * 3 + j) * 3 + k];
  EXPECT_EQ(x[0], 1.5);
  EXPECT_EQ(x[1], 0.5);
  EXPECT_EQ(x[2], 1);
}

TEST(Box, CutsFirstKuhnCellAlongDiagonal) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
  const std::vector<Tet> expected = {{0, 4, 6, 7}, {0, 4, 7, 5}, {0, 2, 7, 6},
                                     {0, 2, 3, 7}, {0, 1, 5, 7}, {0, 1, 7, 3}};
  EXPECT_EQ(mesh.tets, expected);
}

TEST(Box, ReachesUpperCornerExactly) {
  const TetMesh mesh = make_box({{0.1, 0.1, 0.1}}, {{0.7, 0.7, 0.7}}, {3, 3, 3});
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(mesh.rest.back()[axis], 0.7);
}

TEST(Cylinder, IsValidAtAnySize) {
  for (double size : {5.0, 1.0, 0.4, 0.1}) {
    SCOPED_TRACE(size);
    const TetMesh mesh = make_cylinder(1, 2, size);
    expect_sound(mesh, 2);
    const int sides = 6 * std::max(1, static_cast<int>(std::lround(1 / size)));
    const double polygon = sides / 2.0 * std::sin(2 * std::numbers::pi / sides);  // area of the regular polygon
    EXPECT_NEAR(total_volume(mesh), 2 * polygon, 1e-12);
    if (size <= 1) {
      EXPECT_GT(smallest_dihedral(mesh), 33);
    }
  }
}

TEST(RoundShapes, HaveAsManyTetsAsPredicted) {
  for (const double size : {0.03, 0.1, 0.25, 7.0}) {
    EXPECT_EQ(tets_in_cylinder(0.2, 1, size), make_cylinder(0.2, 1, size).tet_count());
    EXPECT_EQ(tets_in_torus(1, 0.2, size), make_torus(1, 0.2, size).tet_count());
  }
  EXPECT_EQ(tets_in_cylinder(1e-6, 1e6, 1e-3), 18e9);
  EXPECT_EQ(tets_in_cylinder(1, 1e300, 1e-300), std::numeric_limits<double>::infinity());
}

TEST(Sphere, IsValidAtAnySize) {
  for (double size : {3.0, 1.0, 0.5, 0.2, 0.1}) {
    SCOPED_TRACE(size);
    const TetMesh mesh = make_sphere(1, size);
    expect_sound(mesh, 2);
    EXPECT_GT(smallest_dihedral(mesh), 36);
  }
}

TEST(Sphere, ConvergesQuadraticallyToBall) {
  const double ball = 4 * std::numbers::pi / 3;
  const double coarse = ball - total_volume(make_sphere(1, 0.2)), fine = ball - total_volume(make_sphere(1, 0.1));
  EXPECT_GT(fine, 0);
  EXPECT_NEAR(coarse / fine, 4, 0.2);
}

TEST(Torus, IsValidAndHasOneHole) {
  for (double size : {1.0, 0.3, 0.1, 0.04}) {
    SCOPED_TRACE(size);
    const TetMesh mesh = make_torus(1, 0.3, size);
    expect_sound(mesh, 0);
    if (size <= 0.3) {
      EXPECT_GT(smallest_dihedral(mesh), 28.5);
    }
  }
  expect_sound(make_torus(1, 0.999, 0.1), 0);
  expect_sound(make_torus(1, 0.01, 0.1), 0);
}

TEST(Torus, VolumeConvergesQuadratically) {
  const double solid = 2 * std::numbers::pi * std::numbers::pi * 0.4 * 0.4;
  const double coarse = solid - total_volume(make_torus(1, 0.4, 0.1));
  const double fine = solid - total_volume(make_torus(1, 0.4, 0.05));
  EXPECT_GT(fine, 0);
  EXPECT_NEAR(coarse / fine, 4, 0.2);
}

}  // namespace
}  // namespace aspic

// Default reach, overlaps and enclosed parts of small meshes.
#include "contact/contact_reach.h"

#include <gtest/gtest.h>

#include <numeric>

#include "contact/barrier.h"
#include "contact/overlaps.h"
#include "mesh/generators.h"
#include "mesh/surface.h"

namespace aspic {
namespace {

// Boxes and obstacles; `q`: positions of the vertices of all boxes.
struct Parts {
  ContactMesh mesh;
  std::vector<double> q;

  void add_box(const std::string& name, const Vec3d& lower, const Vec3d& upper, int cells, bool is_obstacle = false) {
    const TetMesh box = make_box(lower, upper, {cells, cells, cells});
    std::vector<int> rows(box.rest.size());
    std::iota(rows.begin(), rows.end(), static_cast<int>(q.size() / 3));
    if (is_obstacle) rows.clear();
    mesh.add({.name = name, .is_obstacle = is_obstacle, .young = 1e5}, box.rest,
             boundary_triangles(box, 0, box.tet_count()), rows);
    for (const Vec3d& X : box.rest)
      if (!is_obstacle) q.insert(q.end(), X.a, X.a + 3);
  }
  ContactLaw law(int a, int b) const { return Barrier(mesh, {}).laws()(a, b); }
};

TEST(ContactReach, IsTenthOfEdgeWhenNothingIsClose) {
  Parts parts;
  parts.add_box("lower", {}, {{1, 1, 1}}, 2);
  parts.add_box("upper", {{0, 2, 0}}, {{1, 3, 1}}, 4);
  EXPECT_EQ(parts.law(0, 1).basis, ReachBasis::edge);
  EXPECT_DOUBLE_EQ(parts.law(0, 1).reach, parts.mesh.parts[1].mean_edge / 10);
  EXPECT_EQ(reason_of(parts.law(0, 1)), "1/10 of the mean edge of the finer surface");
  const double in_statics = Barrier(parts.mesh, {.reach_per_edge = kStaticReachPerEdge}).laws()(0, 1).reach;
  EXPECT_DOUBLE_EQ(in_statics, parts.mesh.parts[1].mean_edge / 50);
}

TEST(ContactReach, IsFifthOfGapAtStart) {
  Parts parts;
  parts.add_box("lower", {}, {{1, 1, 1}}, 2);
  parts.add_box("upper", {{0.1, 1.01, 0.1}}, {{0.9, 2, 0.9}}, 2);
  parts.mesh.add_plane({.name = "floor"}, {{0, -0.004, 0}}, {{0, 1, 0}});
  EXPECT_EQ(parts.law(1, 0).basis, ReachBasis::gap);
  EXPECT_NEAR(parts.law(1, 0).reach, 0.002, 1e-8);
  EXPECT_NEAR(parts.law(0, 1).edge_reach, kGuardReach * 0.002, 1e-8);
  EXPECT_NEAR(parts.law(0, 2).reach, 0.0008, 1e-8);
  EXPECT_EQ(parts.law(1, 2).basis, ReachBasis::edge);
  EXPECT_EQ(Barrier(parts.mesh, {}).value(parts.q, {}), 0);
  // Given positions count, not those at rest.
  std::vector<double> lifted = parts.q;
  for (size_t i = 1; i < lifted.size(); i += 3) lifted[i] += i > lifted.size() / 2 ? 1 : 0;
  EXPECT_EQ(Barrier(parts.mesh, {.start = lifted}).laws()(0, 1).basis, ReachBasis::edge);
  EXPECT_EQ(Barrier(parts.mesh, {.reach = 0.01}).laws()(0, 1).reach, 0.01);
}

TEST(ContactReach, OfTouchingSurfacesIsSmall) {
  Parts parts;
  parts.add_box("lower", {}, {{1, 1, 1}}, 2);
  parts.add_box("upper", {{0.1, 1, 0.1}}, {{0.9, 2, 0.9}}, 2);
  EXPECT_EQ(parts.law(0, 1).basis, ReachBasis::touching);
  EXPECT_DOUBLE_EQ(parts.law(0, 1).reach, touching_reach(parts.law(0, 1)));
  const Barrier inflated(parts.mesh, {.overlapping = {{0, 1}}});
  EXPECT_EQ(inflated.laws()(0, 1).basis, ReachBasis::edge);
}

TEST(ContactReach, IsTenthOfThickness) {
  Parts parts;
  parts.add_box("card", {}, {{1, 0.01, 1}}, 2);
  parts.add_box("cube", {{0, 5, 0}}, {{1, 6, 1}}, 2);
  EXPECT_NEAR(least_thickness(parts.mesh, 0, 0.1), 0.01, 1e-12);
  EXPECT_TRUE(std::isinf(least_thickness(parts.mesh, 1, 0.1)));
  EXPECT_EQ(parts.law(1, 0).basis, ReachBasis::thickness);
  EXPECT_NEAR(parts.law(1, 0).reach, 0.001, 1e-12);
  EXPECT_EQ(parts.law(1, 1).basis, ReachBasis::edge);
  // The edge of a wedge is thin, but only a small part of its area is.
  Parts wedge;
  TetMesh mesh = make_box({}, {{1, 1, 1}}, {8, 8, 8});
  for (Vec3d& X : mesh.rest) X[1] *= 0.001 + X[0];
  wedge.mesh.add({.name = "wedge"}, mesh.rest, boundary_triangles(mesh, 0, mesh.tet_count()),
                 std::vector<int>(mesh.rest.size(), 0));
  EXPECT_GT(least_thickness(wedge.mesh, 0, 1), 0.01);
}

TEST(Touches, SeparateTouchingBoxes) {
  Parts parts;
  parts.add_box("lower", {}, {{1, 1, 1}}, 2);
  parts.add_box("upper", {{0.25, 1, 0.25}}, {{0.75, 2, 0.75}}, 3);
  const Barrier barrier(parts.mesh, {});
  int own[2] = {0, 0};
  for (const Touch& touch : barrier.touches(parts.q, 0)) {
    const int part = barrier.mesh().part[touch.point];
    ++own[part];
    EXPECT_NEAR(touch.away[1], part == 0 ? -1 : 1, 1e-12);
    EXPECT_GE(touch.by, barrier.laws()(0, 1).reach);
  }
  EXPECT_GT(own[0], 0);
  EXPECT_GT(own[1], 0);
  constexpr size_t kLower = 27;  // vertices of the lower box
  for (size_t i = 3 * kLower + 1; i < parts.q.size(); i += 3) parts.q[i] += 0.01;
  EXPECT_EQ(Barrier(parts.mesh, {.start = parts.q}).touches(parts.q, 0).size(), 0U);
}

TEST(Overlaps, NeedleAndCapsulePierceFace) {
  Parts parts;
  parts.add_box("cube", {}, {{1, 1, 1}}, 2);
  EXPECT_TRUE(overlaps(parts.mesh, parts.mesh.rest).pairs.empty());
  const std::vector<Vec3d> line = {{{0.3, 0.3, 0.3}}, {{0.3, 0.32, -0.2}}, {{0.3, 0.34, -0.7}}};
  Parts needle = parts;
  needle.mesh.add({.name = "needle", .is_obstacle = true}, line, std::vector<Triangle>{{0, 1, 2}}, {});
  ASSERT_EQ(overlaps(needle.mesh, needle.mesh.rest).pairs.size(), 1U);
  EXPECT_EQ(overlaps(needle.mesh, needle.mesh.rest).pairs[0].parts, (std::array{0, 1}));
  Parts capsule = parts;
  capsule.mesh.add_capsule({.name = "capsule", .offset = 0.01}, {line[0], line[2]});
  EXPECT_EQ(overlaps(capsule.mesh, capsule.mesh.rest).pairs.size(), 1U);
  Parts beside = parts;
  beside.mesh.add_capsule({.name = "capsule", .offset = 0.01}, {Vec3d{{2, 0, 0}}, Vec3d{{2, 1, 0}}});
  EXPECT_TRUE(overlaps(beside.mesh, beside.mesh.rest).pairs.empty());
}

TEST(Overlaps, EnclosedPartsAreNamed) {
  Parts parts;
  parts.add_box("cube", {}, {{1, 1, 1}}, 2);
  parts.add_box("core", {{0.4, 0.4, 0.4}}, {{0.6, 0.6, 0.6}}, 1, true);
  parts.mesh.add_capsule({.name = "ball", .offset = 0.05}, {Vec3d{{0.2, 0.2, 0.2}}, Vec3d{{0.2, 0.2, 0.2}}});
  parts.add_box("drum", {{-1, -1, -1}}, {{2, 2, 2}}, 1, true);
  parts.add_box("outside", {{3, 0, 0}}, {{4, 1, 1}}, 1);
  const std::vector<Enclosed> found = enclosed_parts(parts.mesh, parts.mesh.rest);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].inner, 0);
  EXPECT_EQ(found[0].outer, 3);
  EXPECT_EQ(found[1].inner, 1);
  EXPECT_EQ(found[1].outer, 0);
  EXPECT_EQ(found[2].inner, 2);
  EXPECT_EQ(found[2].outer, 0);
}

}  // namespace
}  // namespace aspic

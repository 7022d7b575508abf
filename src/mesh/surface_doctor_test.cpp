#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "mesh/doctor.h"
#include "mesh/doctor_test.h"
#include "mesh/generators.h"
#include "mesh/self_intersection.h"
#include "mesh/surface.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TetMesh cube_of_tets() { return make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}); }
TriMesh ball() { return boundary_surface(make_sphere(1, 0.3)).surface; }

TriMesh joined(TriMesh a, const TriMesh& b, const Vec3d& offset) {
  const int first = a.vertex_count();
  for (const Vec3d& x : b.vertices) a.vertices.push_back(x + offset);
  for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({first + i, first + j, first + k});
  return a;
}

TEST(DoctorOfSurfaces, AcceptsCleanSurfaces) {
  for (const TetMesh& mesh :
       {cube_of_tets(), make_sphere(1, 0.2), make_cylinder(0.5, 2, 0.2), make_torus(1, 0.3, 0.1)}) {
    TriMesh surface = boundary_surface(mesh).surface;
    EXPECT_THAT(names(diagnose(surface)), IsEmpty());
    for (Vec3d& x : surface.vertices) x = turned(x) + Vec3d{{0.3, 0.1, 0.7}};  // flat faces are no longer exactly flat
    EXPECT_THAT(names(diagnose(surface)), IsEmpty());
  }
}

TEST(DoctorOfSurfaces, FindsHole) {
  TriMesh surface = ball();
  surface.triangles.erase(surface.triangles.begin() + 4);
  const Finding finding = found(surface, "open_surface");
  EXPECT_EQ(finding.indices.size(), 3u);
  EXPECT_THAT(finding.message, HasSubstr("3 edges around 1 hole "));
  EXPECT_TRUE(has_errors(diagnose(surface)));
}

// Every triangle has its own corners, as in an STL file with seven digits.
TriMesh soup(const TriMesh& surface, double error) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> rounding(-error, error);
  TriMesh result;
  for (const Triangle& triangle : surface.triangles) {
    const int first = result.vertex_count();
    for (const int v : triangle)
      result.vertices.push_back(surface.vertices[v] + Vec3d{{rounding(random), rounding(random), rounding(random)}});
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

TEST(DoctorOfSurfaces, MergesCornersThatAgreeUpToRounding) {
  const TriMesh clean = ball();
  TriMesh surface = soup(clean, 2e-7);
  const Finding finding = found(surface, "open_surface");
  EXPECT_THAT(finding.message, HasSubstr("of these edges agree with another one within 1e-6 of the diagonal"));
  EXPECT_THAT(finding.remedy, HasSubstr("merge their corners with --repair"));
  EXPECT_THAT(repair(surface), ElementsAre(HasSubstr("corners of open edges into others that agree up to rounding")));
  EXPECT_EQ(surface.vertex_count(), clean.vertex_count());
  EXPECT_THAT(names(diagnose(surface)), IsEmpty());
}

TEST(DoctorOfSurfaces, KeepsCornersOfClosedDetails) {
  TriMesh tiny = ball();
  for (Vec3d& x : tiny.vertices) x = 1e-8 * x;
  TriMesh surface = joined(ball(), tiny, {{3, 0, 0}});
  EXPECT_THAT(repair(surface), IsEmpty());
  TriMesh apart = soup(ball(), 1e-3);
  EXPECT_THAT(repair(apart), IsEmpty()) << "beyond the tolerance";
}

// A square of 4 x 4 quads, bent about the z axis by the given angle.
TriMesh bent_square(double angle) {
  TriMesh sheet;
  constexpr int n = 4;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double s = static_cast<double>(i) / n, t = static_cast<double>(j) / n;
      const double x = angle == 0 ? s : std::sin(angle * s) / angle,
                   y = angle == 0 ? 0 : (1 - std::cos(angle * s)) / angle;
      sheet.vertices.push_back({{x, y, t}});
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      sheet.triangles.insert(sheet.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
    }
  return sheet;
}

TEST(DoctorOfSurfaces, NamesPlanarMeshesAndSheets) {
  TriMesh planar = bent_square(0);
  for (Vec3d& x : planar.vertices) x = turned(x);
  EXPECT_THAT(found(planar, "planar_mesh").message, HasSubstr("encloses no volume"));
  EXPECT_THAT(found(bent_square(2), "sheet").message, HasSubstr("encloses no volume"));
  TriMesh open = boundary_surface(cube_of_tets()).surface;
  std::erase_if(open.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](int v) { return open.vertices[v][2] == 1; });
  });
  EXPECT_THAT(names(diagnose(open)), testing::Contains("open_surface"));
}

TEST(DoctorOfSurfaces, FindsAndFlipsMisorientedTriangles) {
  const TriMesh clean = ball();
  TriMesh surface = clean;
  std::swap(surface.triangles[9][1], surface.triangles[9][2]);
  EXPECT_THAT(found(surface, "inconsistent_orientation").indices, testing::Contains(9));
  EXPECT_THAT(repair(surface), ElementsAre("flipped 1 triangles with the wrong orientation"));
  EXPECT_EQ(surface.triangles, clean.triangles);
}

TEST(DoctorOfSurfaces, DoesNotAdviseFlippingOneSidedSheet) {
  TriMesh strip;  // Moebius strip: five quads, the last joined to the first with a half twist
  for (int i = 0; i < 5; ++i) {
    const double angle = 2 * std::numbers::pi * i / 5;
    for (const double side : {-0.2, 0.2}) {
      const double radius = 1 + side * std::cos(angle / 2);
      strip.vertices.push_back({{radius * std::cos(angle), radius * std::sin(angle), side * std::sin(angle / 2)}});
    }
    const int a = 2 * i, b = a + 1, c = i < 4 ? a + 2 : 1, d = i < 4 ? a + 3 : 0;
    strip.triangles.insert(strip.triangles.end(), {{a, c, b}, {b, c, d}});
  }
  const Finding finding = found(strip, "inconsistent_orientation");
  EXPECT_THAT(finding.remedy, HasSubstr("one-sided"));
}

TEST(DoctorOfSurfaces, RejectsCoordinatesWithOverflowingPowers) {
  TriMesh surface = ball();
  for (Vec3d& x : surface.vertices) x = 1e150 * x;
  EXPECT_THAT(names(diagnose(surface)), ElementsAre("coordinates_too_large"));
}

TEST(DoctorOfSurfaces, CancelsBackToBackPairs) {
  TriMesh surface = ball();  // adds a fin of two triangles on an edge
  const auto [a, b, c] = surface.triangles[5];
  const int indenter = surface.vertex_count();
  surface.vertices.push_back(1.5 * surface.vertices[a]);
  surface.triangles.push_back({a, b, indenter});
  surface.triangles.push_back({b, a, indenter});
  EXPECT_THAT(repair(surface), ElementsAre("removed 2 triangles in back-to-back pairs",
                                           "dropped 1 vertices that only removed triangles used"));
  EXPECT_THAT(diagnose(surface), IsEmpty());
}

TEST(DoctorOfSurfaces, KeepsOneSideOfDoubledSurface) {
  const TriMesh clean = ball();
  TriMesh surface = clean;
  for (const auto& [a, b, c] : clean.triangles) surface.triangles.push_back({a, c, b});
  repair(surface);
  EXPECT_EQ(surface.triangles, clean.triangles);
}

TEST(DoctorOfSurfaces, FindsAndFlipsInwardSurface) {
  TriMesh surface = ball();
  for (Triangle& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_THAT(names(diagnose(surface)), ElementsAre("inward_surface"));
  EXPECT_EQ(repair(surface).size(), 1u);
  EXPECT_THAT(diagnose(surface), IsEmpty());
}

TEST(DoctorOfSurfaces, KeepsOrientationOfCavity) {
  TriMesh cavity = ball();
  for (Triangle& triangle : cavity.triangles) std::swap(triangle[1], triangle[2]);
  TriMesh surface = joined(boundary_surface(make_sphere(3, 1)).surface, cavity, {{0, 0, 0}});
  EXPECT_THAT(names(diagnose(surface)), ElementsAre("several_components"));
  EXPECT_THAT(repair(surface), IsEmpty());
}

TEST(DoctorOfSurfaces, MergesVerticesOfStlFile) {
  const TriMesh clean = ball();
  TriMesh loose;
  for (const Triangle& triangle : clean.triangles) {
    const int first = loose.vertex_count();
    for (int v : triangle) loose.vertices.push_back(clean.vertices[v]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(found(loose, "duplicate_vertices").indices.size(), loose.vertices.size() - clean.vertices.size());
  EXPECT_EQ(repair(loose).size(), 1u);
  EXPECT_THAT(diagnose(loose), IsEmpty());
}

TEST(DoctorOfSurfaces, NotesAndDropsUnreferencedVertices) {
  TriMesh surface = ball();
  surface.vertices.push_back({{0, 0, 0}});
  EXPECT_EQ(found(surface, "unreferenced_vertices").severity, Severity::note);
  EXPECT_THAT(repair(surface), ElementsAre("dropped 1 unreferenced vertices"));
  EXPECT_EQ(surface.vertex_count(), ball().vertex_count());
}

TEST(DoctorOfSurfaces, FindsInnerWalls) {
  TetMesh two = make_box({{0, 0, 0}}, {{2, 1, 1}}, {2, 1, 1});
  TriMesh surface;
  surface.vertices = two.rest;
  for (int half : {0, 6})
    for (const Triangle& triangle : boundary_triangles(two, half, 6)) surface.triangles.push_back(triangle);
  EXPECT_FALSE(found(surface, "non_manifold_edges").indices.empty());
  EXPECT_EQ(found(surface, "repeated_triangles").indices.size(), 2u);
}

TEST(DoctorOfSurfaces, FindsDegenerateTriangle) {
  TriMesh surface;
  surface.vertices = {{{0, 0, 0}}, {{1, 1, 1}}, {{3, 3, 3}}};
  surface.triangles = {{0, 1, 2}};
  EXPECT_THAT(found(surface, "degenerate_triangles").indices, ElementsAre(0));
}

TEST(SelfIntersection, FindsIntersectionOfTwoBalls) {
  const TriMesh apart = joined(ball(), ball(), {{2.01, 0, 0}});
  EXPECT_THAT(self_intersections(apart).pairs, IsEmpty());
  const TriMesh meeting = joined(ball(), ball(), {{1.5, 0, 0}});
  const Finding finding = found(meeting, "self_intersections");
  EXPECT_GT(finding.indices.size(), 20u);
  for (int t : finding.indices)  // the balls intersect on the circle x = 0.75
    for (int v : meeting.triangles[t]) EXPECT_NEAR(meeting.vertices[v][0], 0.75, 0.45);
}

TEST(SelfIntersection, FindsAlignedBoxesDespiteEdgeContacts) {
  const TriMesh cube = boundary_surface(make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1})).surface;
  for (const Vec3d& offset : {Vec3d{{0.5, 0.5, 0.5}}, Vec3d{{0.5, 0, 0}}, Vec3d{{1, 0.5, 0.5}}})
    EXPECT_THAT(self_intersections(joined(cube, cube, offset)).pairs, testing::Not(IsEmpty()));
  EXPECT_THAT(self_intersections(joined(cube, cube, {{1.0000000001, 0, 0}})).pairs, IsEmpty());
}

TEST(SelfIntersection, AgreesWithBruteForceOverRandomSegments) {
  // Reference: two triangles intersect if an edge of one crosses the other, by solving for the crossing.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(0, 1);
  TriMesh soup;
  for (int i = 0; i < 300; ++i) soup.vertices.push_back({{coordinate(random), coordinate(random), coordinate(random)}});
  for (int t = 0; t < 100; ++t) soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  const auto crosses = [&](const Triangle& s, const Triangle& t) {
    const auto& x = soup.vertices;
    for (int e = 0; e < 3; ++e) {
      const Vec3d p = x[s[e]], q = x[s[(e + 1) % 3]];
      const Vec3d w = inverse(from_columns(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]], p - q)) * (p - x[t[0]]);
      if (w[0] >= 0 && w[1] >= 0 && w[0] + w[1] <= 1 && w[2] >= 0 && w[2] <= 1) return true;
    }
    return false;
  };
  std::vector<std::array<int, 2>> expected;
  for (int i = 0; i < 100; ++i)
    for (int j = i + 1; j < 100; ++j)
      if (crosses(soup.triangles[i], soup.triangles[j]) || crosses(soup.triangles[j], soup.triangles[i]))
        expected.push_back({i, j});
  EXPECT_GT(expected.size(), 100u);
  EXPECT_EQ(self_intersections(soup).pairs, expected);
}

TEST(SelfIntersection, FindsIntersectingNeighbors) {
  TriMesh fold;  // the second triangle lies on the first, beyond their common edge or corner
  fold.vertices = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0.2, 0.3, 0}}, {{1, 1, 0}}};
  fold.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(self_intersections(fold).pairs.size(), 1u);
  fold.triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_EQ(self_intersections(fold).pairs.size(), 1u);
  fold.triangles = {{0, 1, 2}, {1, 4, 2}};
  EXPECT_THAT(self_intersections(fold).pairs, IsEmpty());
  fold.vertices[3] = {{0.5, 0.5, -1}};
  fold.vertices[4] = {{0.2, 0.2, 1}};  // pierces the first triangle from its corner 0
  fold.triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_EQ(self_intersections(fold).pairs.size(), 1u);
}

TEST(SelfIntersection, AcceptsManyTrianglesInOnePlace) {
  TriMesh pile;
  for (int i = 0; i < 2000; ++i) {
    const double z = 1e-3 * i;
    pile.vertices.insert(pile.vertices.end(), {{{0, 0, z}}, {{1, 0, -z}}, {{0, 1, 0.5}}});
    pile.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  EXPECT_EQ(self_intersections(pile, 1000).pairs.size(), 1000u);
}

TEST(SelfIntersection, IgnoresMillionCopiesOfOneTriangle) {
  TriMesh pile;
  pile.vertices = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}};
  for (int i = 0; i < 333'333; ++i)
    pile.triangles.insert(pile.triangles.end(), {Triangle{0, 1, 2}, Triangle{1, 2, 0}, Triangle{2, 1, 0}});
  const SelfIntersections found = self_intersections(pile);  // all pairs would take an hour
  EXPECT_THAT(found.pairs, IsEmpty());
  EXPECT_TRUE(found.is_complete);
}

TEST(SelfIntersection, ReportsIncompleteSearch) {
  TriMesh pile;
  for (int i = 0; i < 3000; ++i) {
    const double z = 1e-3 * i;
    pile.vertices.insert(pile.vertices.end(), {{{0, 0, z}}, {{1, 0, -z}}, {{0, 1, 0.5}}});
    pile.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  EXPECT_FALSE(self_intersections(pile, 100).is_complete);
}

}  // namespace
}  // namespace aspic

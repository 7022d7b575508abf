#include "mesh/doctor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/doctor_test.h"
#include "mesh/generators.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TetMesh box() { return make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}); }

TEST(DoctorOfTets, AcceptsGeneratedMeshes) {
  for (const TetMesh& mesh : {box(), make_box({{0, 0, 0}}, {{4, 1, 1}}, {8, 2, 2}, BoxCut::five), make_sphere(1, 0.2),
                              make_cylinder(0.5, 2, 0.2), make_torus(1, 0.3, 0.1)})
    EXPECT_THAT(names(diagnose(mesh)), IsEmpty());
}

TEST(DoctorOfTets, FindsAndFlipsInvertedTet) {
  TetMesh mesh = box();
  std::swap(mesh.tets[7][0], mesh.tets[7][1]);
  EXPECT_THAT(found(mesh, "inverted_tets").indices, ElementsAre(7));
  EXPECT_TRUE(has_errors(diagnose(mesh)));
  EXPECT_THAT(repair(mesh), ElementsAre("flipped 1 inverted tets"));
  EXPECT_THAT(diagnose(mesh), IsEmpty());
}

TEST(DoctorOfTets, FindsAndRemovesZeroVolumeTet) {
  TetMesh mesh = box();
  mesh.region.assign(mesh.tets.size(), 1);
  const int first = mesh.vertex_count();
  for (const Vec3d& x : {Vec3d{{0, 0, 2}}, Vec3d{{0.1, 0.3, 2}}, Vec3d{{1, 1, 2}}, Vec3d{{0.7, 0.1, 2}}})
    mesh.rest.push_back(turned(x));
  mesh.tets.insert(mesh.tets.begin() + 3, Tet{first, first + 1, first + 2, first + 3});
  mesh.region.insert(mesh.region.begin() + 3, 2);
  EXPECT_THAT(found(mesh, "zero_volume_tets").indices, ElementsAre(3));
  EXPECT_THAT(repair(mesh),
              ElementsAre("removed 1 tets of zero volume", "dropped 4 vertices that only removed tets used"));
  EXPECT_THAT(mesh.region, testing::Each(1));
  EXPECT_THAT(diagnose(mesh), IsEmpty());
}

TEST(DoctorOfTets, FindsTetWithRepeatedVertex) {
  TetMesh mesh = box();
  mesh.tets.push_back({0, 1, 1, 2});
  EXPECT_THAT(found(mesh, "repeated_vertex_in_tet").indices, ElementsAre(48));
  repair(mesh);
  EXPECT_THAT(diagnose(mesh), IsEmpty());
}

TEST(DoctorOfTets, FindsSliversWithHistogram) {
  TetMesh mesh;
  mesh.rest = {{{0, 0, 0}}, {{1, 0, 0.02}}, {{1, 1, 0}}, {{0, 1, 0.02}}};
  mesh.tets = {{0, 1, 2, 3}};
  if (volume(mesh, 0) < 0) std::swap(mesh.tets[0][2], mesh.tets[0][3]);
  const Finding finding = found(mesh, "slivers");
  EXPECT_THAT(finding.indices, ElementsAre(0));
  EXPECT_THAT(finding.message, HasSubstr("0 1 0 0 0 0 0 0 0 0"));
  EXPECT_EQ(finding.severity, Severity::warning);
}

TEST(DoctorOfTets, FindsAndMergesDuplicateVertices) {
  TetMesh mesh = box();
  mesh.rest.push_back(mesh.rest[mesh.tets[0][0]]);
  const int duplicate = mesh.vertex_count() - 1;
  mesh.tets[0][0] = duplicate;
  EXPECT_THAT(found(mesh, "duplicate_vertices").indices, ElementsAre(duplicate));
  EXPECT_THAT(repair(mesh), ElementsAre("merged 1 duplicate vertices into those at the same place"));
  EXPECT_THAT(diagnose(mesh), IsEmpty());
}

TEST(DoctorOfTets, FindsAndDropsUnreferencedVertices) {
  TetMesh mesh = box();
  mesh.rest.insert(mesh.rest.begin(), Vec3d{{5, 5, 5}});
  for (Tet& tet : mesh.tets)
    for (int& v : tet) ++v;
  EXPECT_THAT(found(mesh, "unreferenced_vertices").indices, ElementsAre(0));
  EXPECT_THAT(repair(mesh), ElementsAre("dropped 1 unreferenced vertices"));
  EXPECT_EQ(mesh.tets, box().tets);
}

TEST(DoctorOfTets, FindsRepeatedTets) {
  TetMesh mesh = box();
  mesh.tets.push_back({mesh.tets[2][1], mesh.tets[2][2], mesh.tets[2][0], mesh.tets[2][3]});
  EXPECT_THAT(found(mesh, "repeated_tets").indices, ElementsAre(48));
  EXPECT_THAT(found(mesh, "non_manifold_faces").indices, testing::Contains(48));
  EXPECT_THAT(found(mesh, "overlapping_tets").indices, ElementsAre(2, 48));
  EXPECT_THAT(repair(mesh), ElementsAre("removed 1 repeated tets"));
  EXPECT_EQ(mesh.tets, box().tets);
}

TEST(DoctorOfTets, FindsDoubledTetBesideManyOthers) {
  TetMesh mesh;
  for (const double x : {0.0, 100.0})
    for (const Vec3d& X : {Vec3d{{0, 0, 0}}, Vec3d{{1, 0, 0}}, Vec3d{{0, 1, 0}}, Vec3d{{0, 0, 1}}})
      mesh.rest.push_back(X + Vec3d{{x, x, x}});
  mesh.tets.assign(4104, {0, 1, 2, 3});
  mesh.tets.insert(mesh.tets.end(), 2, {4, 5, 6, 7});
  EXPECT_THAT(found(mesh, "overlapping_tets").indices, testing::IsSupersetOf({4104, 4105}));
}

TEST(DoctorOfTets, FindsTetsFoldedOntoNeighbor) {
  TetMesh mesh;
  mesh.rest = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{0.1, 0.1, 0.7}}};
  mesh.tets = {{0, 1, 2, 3}, {0, 1, 2, 4}};
  EXPECT_THAT(found(mesh, "folded_tets").indices, ElementsAre(0, 1));
  mesh.rest[4] = {{0.1, 0.1, -0.7}};
  std::swap(mesh.tets[1][1], mesh.tets[1][2]);
  EXPECT_THAT(names(diagnose(mesh)), IsEmpty());
}

TEST(DoctorOfTets, FindsBentBarThatOverlapsItself) {
  for (const double turn : {5.5, 7.0}) {  // [rad]; a full one is 6.28
    TetMesh bar = make_box({0, 0, 0}, {1, 1, 1}, {40, 3, 3});
    for (Vec3d& X : bar.rest) {
      const double angle = turn * X[0], radius = 3 - X[1];
      X = {{radius * std::sin(angle), -radius * std::cos(angle), X[2]}};
    }
    const std::vector<std::string> expected(turn > 6 ? 1 : 0, "overlapping_tets");
    EXPECT_EQ(names(diagnose(bar)), expected) << turn;
  }
}

TEST(DoctorOfTets, FindsPartsConnectedByEdgeOrCorner) {
  TetMesh hinge;
  hinge.rest = {{{0, 0, 0}}, {{0, 0, 1}}, {{1, 0, 0}}, {{1, 1, 0}}, {{-1, 0, 0}}, {{-1, -1, 0}}};
  hinge.tets = {{0, 2, 3, 1}, {0, 4, 5, 1}};
  EXPECT_THAT(found(hinge, "non_manifold_edges").indices, testing::IsSupersetOf({0, 1}));
  TetMesh ball_joint;
  ball_joint.rest = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{-1, 0, 0}}, {{0, -1, 0}}, {{0, 0, -1}}};
  ball_joint.tets = {{0, 1, 2, 3}, {0, 5, 4, 6}};
  EXPECT_THAT(found(ball_joint, "non_manifold_vertices").indices, ElementsAre(0));
}

TEST(DoctorOfTets, FindsSeveralComponents) {
  TetMesh mesh = box();
  const TetMesh other = make_box({{3, 0, 0}}, {{4, 1, 1}}, {1, 1, 1});
  const int first = mesh.vertex_count();
  mesh.rest.insert(mesh.rest.end(), other.rest.begin(), other.rest.end());
  for (const auto& [a, b, c, d] : other.tets) mesh.tets.push_back({first + a, first + b, first + c, first + d});
  EXPECT_THAT(found(mesh, "several_components").indices, ElementsAre(0, 48));
  EXPECT_EQ(quality(mesh).components, 2);
  EXPECT_FALSE(has_errors(diagnose(mesh)));
}

TEST(DoctorOfTets, AdvisesMergingOnlyWhereItJoinsParts) {
  TetMesh touching = box();
  const TetMesh other = make_box({{1, 0, 0}}, {{2, 1, 1}}, {1, 1, 1});
  const int first = touching.vertex_count();
  touching.rest.insert(touching.rest.end(), other.rest.begin(), other.rest.end());
  for (const auto& [a, b, c, d] : other.tets) touching.tets.push_back({first + a, first + b, first + c, first + d});
  TetMesh apart = touching;
  for (size_t v = static_cast<size_t>(first); v < apart.rest.size(); ++v) apart.rest[v][0] += 5;
  EXPECT_THAT(found(apart, "several_components").remedy, testing::Not(testing::HasSubstr("--repair")));
  EXPECT_THAT(found(touching, "several_components").remedy, testing::HasSubstr("--repair"));
  repair(touching);
  EXPECT_THAT(names(diagnose(touching)), testing::Not(testing::Contains("several_components")));
}

TEST(DoctorOfTets, RepairResolvesItsFindings) {
  TetMesh mesh = box();
  const std::vector<Tet> clean = mesh.tets;
  std::swap(mesh.tets[3][0], mesh.tets[3][1]);                                // inverted
  mesh.tets.push_back(clean[0]);                                              // repeated
  mesh.tets.push_back({clean[0][0], clean[0][1], clean[0][2], clean[0][2]});  // lists a vertex twice
  mesh.rest.insert(mesh.rest.end(), {mesh.rest[clean[5][0]], {{9, 9, 9}}});   // a duplicate and an unreferenced vertex
  mesh.tets[5][0] = mesh.vertex_count() - 2;
  std::vector<std::string> promised;
  for (const Finding& finding : diagnose(mesh))
    if (finding.remedy.find("--repair") != std::string::npos) promised.push_back(finding.name);
  EXPECT_GE(promised.size(), 5u);
  repair(mesh);
  for (const std::string& name : names(diagnose(mesh))) EXPECT_THAT(promised, testing::Not(testing::Contains(name)));
}

TEST(DoctorOfTets, RejectsCoordinatesWithOverflowingPowers) {
  for (const double size : {1e31, 1e130, 1e300}) {
    const TetMesh mesh = make_box({{0, 0, 0}}, {{size, size, size}}, {1, 1, 1});
    EXPECT_THAT(names(diagnose(mesh)), ElementsAre("coordinates_too_large"));
    EXPECT_EQ(quality(mesh).components, 1);
  }
  for (const double size : {1e30, 1e-30, 1e-200})
    EXPECT_THAT(names(diagnose(make_box({{0, 0, 0}}, {{size, size, size}}, {1, 1, 1}))),
                testing::Not(testing::Contains("coordinates_too_large")));
}

TEST(DoctorOfTets, NotesSuspiciousUnits) {
  EXPECT_THAT(found(make_sphere(81, 20), "suspicious_units").message,
              "extent 162 m; if the file is in millimeters use scale = 0.001, in centimeters 0.01: 0.162 m or 1.62 m");
  EXPECT_EQ(found(make_sphere(1e-4, 5e-5), "suspicious_units").severity, Severity::note);
}

TEST(DoctorOfTets, StopsAtInvalidIndices) {
  TetMesh mesh = box();
  mesh.rest[5][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(names(diagnose(mesh)), ElementsAre("non_finite_coordinates"));
  EXPECT_THAT(found(mesh, "non_finite_coordinates").indices, ElementsAre(5));
  mesh.tets[3][2] = 999;
  EXPECT_THAT(found(mesh, "invalid_indices").indices, ElementsAre(3));
  EXPECT_THAT(repair(mesh), IsEmpty());
  EXPECT_THAT(names(diagnose(TetMesh{})), ElementsAre("empty_mesh"));
}

TEST(Quality, IsOneForRegularTet) {
  TetMesh mesh;
  mesh.rest = {{{1, 1, 1}}, {{1, -1, -1}}, {{-1, 1, -1}}, {{-1, -1, 1}}};
  mesh.tets = {{0, 1, 2, 3}};
  if (volume(mesh, 0) < 0) std::swap(mesh.tets[0][2], mesh.tets[0][3]);
  const MeshQuality q = quality(mesh);
  EXPECT_NEAR(q.min_mean_ratio, 1, 1e-14);
  EXPECT_NEAR(q.min_dihedral, std::acos(1.0 / 3) * 180 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(q.max_dihedral, q.min_dihedral, 1e-12);
  EXPECT_NEAR(q.total_volume, 8.0 / 3, 1e-14);
  EXPECT_EQ(q.mean_ratio_histogram[9], 1);
}

}  // namespace
}  // namespace aspic

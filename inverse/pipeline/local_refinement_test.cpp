#include "pipeline/local_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "data/surface_projection.h"
#include "mesh/tet_nodes.h"
#include "model/load_case.h"
#include "pipeline/bisection.h"
#include "pipeline/indented_block_test.h"

namespace aspic {
namespace {

double surface_area(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : boundary_triangles(mesh, 0, mesh.tet_count()))
    sum += norm(cross(mesh.rest[b] - mesh.rest[a], mesh.rest[c] - mesh.rest[a])) / 2;
  return sum;
}

std::set<int> vertices_below(const TetMesh& mesh, double height) {
  std::set<int> found;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.rest[v][1] < height) found.insert(v);
  return found;
}

// A cube that a grip on its top pulls by 10 %.
Experiment gripped(bool is_quadratic) {
  Experiment e;
  e.mesh = make_box({{0, 0, 0}}, {{0.1, 0.1, 0.1}}, {3, 3, 3});
  if (is_quadratic) e.mesh = raise_order(std::move(e.mesh));
  e.density.assign(e.mesh.tets.size(), 1000);
  LoadCase load{.name = "pull", .group = "pull"};
  load.grip.emplace();
  load.grip->center = {{0.05, 0.1, 0.05}};
  load.grip->displacement = {{0, 0.01, 0}};
  load.force = Vec3d{};
  load.force_sigma = {{1, 1, 1}};
  for (int v = 0; v < e.mesh.vertex_count(); ++v) {
    if (e.mesh.rest[v][1] < 1e-9) e.fixed.push_back(v);
    if (e.mesh.rest[v][1] > 0.1 - 1e-9) load.grip->vertices.push_back(v);
  }
  e.cases.push_back(load);
  return e;
}

TEST(BisectedMesh, HasMatchingFacesAndKeepsTheBody) {
  const TetMesh box = make_box({{0, 0, 0}}, {{0.1, 0.1, 0.1}}, {3, 3, 3});
  BisectedMesh mesh(box.rest, box.tets);
  for (int round = 0; round < 6; ++round)
    mesh.bisect([&](const BisectedMesh::Part& part) { return norm(mesh.rest()[part.tet[0]]) < 0.03; });
  TetMesh fine{.rest = mesh.rest(), .tets = {}, .region = {}};
  std::map<std::set<int>, int> faces;
  std::vector<double> volumes(box.tets.size());
  for (const BisectedMesh::Part& part : mesh.parts()) {
    fine.tets.push_back(part.tet);
    volumes[part.parent] += volume(fine, fine.tet_count() - 1);
    EXPECT_GT(volume(fine, fine.tet_count() - 1), 0);
    for (int k = 0; k < 4; ++k) {
      std::set<int> face(part.tet.begin(), part.tet.end());
      face.erase(part.tet[k]);
      ++faces[face];
    }
  }
  EXPECT_GT(fine.tet_count(), box.tet_count() + 50);
  for (int t = 0; t < box.tet_count(); ++t) EXPECT_NEAR(volumes[t], volume(box, t), 1e-15);
  for (const auto& [face, count] : faces) EXPECT_LE(count, 2);
  EXPECT_NEAR(surface_area(fine), 0.06, 1e-12) << "an unmatched face would count as surface";
}

TEST(LocalRefinement, IsFineBelowIndentersOnTheSameBody) {
  for (const bool is_quadratic : {false, true}) {
    Experiment coarse = indented_block(3);
    if (is_quadratic) {
      coarse.mesh = raise_order(std::move(coarse.mesh));
      const std::set<int> held = vertices_below(coarse.mesh, 1e-9);
      coarse.fixed.assign(held.begin(), held.end());
    }
    const Experiment fine = locally_refined(coarse);
    EXPECT_GT(fine.mesh.tet_count(), 1.3 * coarse.mesh.tet_count());
    EXPECT_LT(fine.mesh.tet_count(), 5 * coarse.mesh.tet_count());
    EXPECT_EQ(fine.mesh.mids.empty(), !is_quadratic);
    EXPECT_NEAR(surface_area(fine.mesh), surface_area(coarse.mesh), 1e-12);
    const std::set<int> held = vertices_below(fine.mesh, 1e-9);
    EXPECT_EQ(std::set<int>(fine.fixed.begin(), fine.fixed.end()), held);
    ASSERT_EQ(fine.markers.size(), coarse.markers.size());
    for (size_t m = 0; m < fine.markers.size(); ++m)
      EXPECT_NEAR(norm(position(fine.markers[m], fine.mesh.rest) - position(coarse.markers[m], coarse.mesh.rest)), 0,
                  1e-15);
    double longest = 0;
    std::vector<double> volumes(coarse.mesh.tets.size());
    for (int t = 0; t < fine.mesh.tet_count(); ++t) {
      const Tet& tet = fine.mesh.tets[t];
      EXPECT_EQ(fine.mesh.region[t], coarse.mesh.region[fine.parent[t]]);
      volumes[fine.parent[t]] += volume(fine.mesh, t);
      const auto is_near = [&](int v) { return norm(fine.mesh.rest[v] - Vec3d{{0.03, 0.095, 0.03}}) < 0.015; };
      if (!std::any_of(tet.begin(), tet.end(), is_near)) continue;
      for (const auto& [i, j] : kTetEdges)
        longest = std::max(longest, norm(fine.mesh.rest[tet[i]] - fine.mesh.rest[tet[j]]));
    }
    EXPECT_LT(longest, 0.03) << "it was 0.058";
    for (int t = 0; t < coarse.mesh.tet_count(); ++t) EXPECT_NEAR(volumes[t], volume(coarse.mesh, t), 1e-15);
  }
}

// Clamped ends concentrate stress at their rims, so a coarse mesh needs too much force.
TEST(LocalRefinement, RimsOfGripsAreFineAndTheForceIsMoreAccurate) {
  const auto force_on = [](const Experiment& e) {
    const std::vector<MaterialParameters> one(e.mesh.tets.size(), {lame_from_young_poisson(1e4, 0.45), {}});
    LoadedBody body(e, e.cases[0], "neo_hookean", one, {});
    EXPECT_TRUE(body.solve(one, {}));
    return body.prediction().wrench.force[1];
  };
  for (const bool is_quadratic : {false, true}) {
    const Experiment coarse = gripped(is_quadratic), fine = locally_refined(coarse);
    std::set<int> top;
    for (int v = 0; v < fine.mesh.vertex_count(); ++v)
      if (fine.mesh.rest[v][1] > 0.1 - 1e-9) top.insert(v);
    const std::vector<int>& held = fine.cases[0].grip->vertices;
    EXPECT_EQ(std::set<int>(held.begin(), held.end()), top);
    EXPECT_TRUE(std::is_sorted(held.begin(), held.end()));
    const double before = force_on(coarse), after = force_on(fine), all = force_on(locally_refined(fine));
    EXPECT_LT(after, before);
    EXPECT_LT(after - all, 0.7 * (before - after));
  }
}

TEST(LocalRefinement, BodiesUnderPressureStayAsTheyAre) {
  Experiment e = gripped(false);
  e.cases[0].pressure = 100;
  e.cases[0].pressed = {boundary_triangles(e.mesh, 0, 1).front()};
  EXPECT_EQ(locally_refined(e).mesh.tet_count(), e.mesh.tet_count());
  e.cases.clear();
  EXPECT_EQ(locally_refined(e).mesh.tet_count(), e.mesh.tet_count()) << "neither grips nor indenters";
}

}  // namespace
}  // namespace aspic

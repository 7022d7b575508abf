#include "mesh/numbering.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/generators.h"

namespace aspic {
namespace {

// Returns the mean index difference of two vertices of a tet.
double mean_reach(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& tet : mesh.tets)
    sum += *std::max_element(tet.begin(), tet.end()) - *std::min_element(tet.begin(), tet.end());
  return sum / mesh.tet_count();
}

TEST(Renumbering, IsIdentityByDefault) {
  const Renumbering none;
  EXPECT_EQ(none.to_user(3), 3);
  EXPECT_EQ(none.from_user(3), 3);
  EXPECT_EQ(none.to_user(std::vector<double>{4, 5, 6}), (std::vector<double>{4, 5, 6}));
}

TEST(Renumbering, MapsBothWays) {
  const Renumbering r({2, 0, 1});  // the first stored element has the user's index 2
  EXPECT_EQ(r.to_user(0), 2);
  EXPECT_EQ(r.from_user(2), 0);
  EXPECT_EQ(r.to_user(std::vector<int>{0, 1}), (std::vector<int>{0, 2}));
  const std::vector<double> user = {0, 0.5, 1, 1.5, 2, 2.5};
  EXPECT_EQ(r.from_user(user, 2), (std::vector<double>{2, 2.5, 0, 0.5, 1, 1.5}));
  EXPECT_EQ(r.to_user(r.from_user(user, 2), 2), user);
}

TEST(Renumbering, AppendsParts) {
  Renumbering all;
  all.append(0, Renumbering(), 2);
  all.append(2, Renumbering({1, 0}), 2);
  all.append(4, Renumbering(), 1);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(all.to_user(i), (std::vector<int>{0, 1, 3, 2, 4})[i]);
    EXPECT_EQ(all.from_user(all.to_user(i)), i);
  }
}

TEST(Numbering, ImprovesLocalityAndIsInvertible) {
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {6, 6, 6});
  for (int t = 0; t < mesh.tet_count(); ++t) mesh.region.push_back(t);
  std::vector<int> shuffled(mesh.rest.size());
  for (size_t i = 0; i < shuffled.size(); ++i) shuffled[i] = static_cast<int>(i * 101 % shuffled.size());
  mesh = from_user({Renumbering(shuffled), {}}, mesh);
  const Numbering numbering = locality_numbering(mesh);
  const TetMesh stored = from_user(numbering, mesh), back = to_user(numbering, stored);
  EXPECT_LT(mean_reach(stored), 0.4 * mean_reach(mesh));
  EXPECT_EQ(back.tets, mesh.tets);
  EXPECT_EQ(back.region, mesh.region);
  for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_EQ(norm(back.rest[v] - mesh.rest[v]), 0);
  for (int t = 0; t < mesh.tet_count(); ++t) EXPECT_EQ(volume(stored, numbering.tet.from_user(t)), volume(mesh, t));
}

TEST(Numbering, IsIndependentOfFileOrder) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1.1, 1.2}}, {3, 3, 3});
  std::vector<int> vertices(mesh.rest.size()), tets(mesh.tets.size());
  for (size_t i = 0; i < vertices.size(); ++i) vertices[i] = static_cast<int>(i * 5 % vertices.size());
  for (size_t i = 0; i < tets.size(); ++i) tets[i] = static_cast<int>(i * 7 % tets.size());
  const TetMesh other = from_user({Renumbering(vertices), Renumbering(tets)}, mesh);
  EXPECT_EQ(from_user(locality_numbering(mesh), mesh).tets, from_user(locality_numbering(other), other).tets);
}

}  // namespace
}  // namespace aspic

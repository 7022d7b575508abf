#include "model/handle_gaps.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "mesh/generators.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

TetMesh split_cube() { return make_box({{0, 0, 0}}, {{1, 1, 1}}, {8, 8, 8}, BoxCut::five); }

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(HandleGaps, ShrinkWithMoreHandles) {
  const TetMesh mesh = split_cube();
  const auto mean_gap = [&](int handles) { return mean(handle_gaps(mesh, FieldBasis::radial(mesh, handles))); };
  EXPECT_LT(mean_gap(64), 0.8 * mean_gap(8));
  EXPECT_LT(mean_gap(512), 0.8 * mean_gap(64));
}

TEST(HandleGaps, AreThoseOfHandlesOnly) {
  const TetMesh mesh = split_cube();
  EXPECT_TRUE(handle_gaps(mesh, FieldBasis::tets(mesh.tet_count())).empty());
  EXPECT_TRUE(handle_gaps(mesh, FieldBasis::uniform(mesh.tet_count())).empty());
}

// Cubes divided by random planes (a Poisson process: the number that separates two points is Poisson distributed); each
// part has its own normal value. The values of the handles are those of the field at their centers.
TEST(HandleGaps, AreTheErrorsForPartsBetweenRandomPlanes) {
  constexpr int kBodies = 300;
  constexpr double kLength = 0.5, kReach = 2;  // correlation length, radius of a sphere that contains the body
  const TetMesh mesh = split_cube();
  const FieldBasis basis = FieldBasis::radial(mesh, 8);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  // Planes of this density separate points at the distance d with the mean number d / l.
  std::poisson_distribution<int> count(4 * kReach / kLength);
  std::uniform_real_distribution<double> offset(-kReach, kReach);
  std::vector<double> squares(mesh.tets.size(), 0.0);
  for (int body = 0; body < kBodies; ++body) {
    struct Plane {
      Vec3d normal;
      double offset;
    };
    std::vector<Plane> planes;
    for (int k = count(random); k > 0; --k) {
      Vec3d n{{normal(random), normal(random), normal(random)}};
      planes.push_back({(1 / norm(n)) * n, offset(random)});
    }
    std::map<std::vector<bool>, double> parts;
    const auto value = [&](const Vec3d& x) {
      std::vector<bool> side;
      for (const Plane& plane : planes) side.push_back(dot(plane.normal, x - Vec3d{{0.5, 0.5, 0.5}}) > plane.offset);
      const auto [part, is_new] = parts.try_emplace(side, 0);
      if (is_new) part->second = normal(random);
      return part->second;
    };
    std::vector<double> p;
    for (const Vec3d& c : basis.centers()) p.push_back(value(c));
    std::vector<double> z(mesh.tets.size());
    basis.multiply(p, z);
    for (int t = 0; t < mesh.tet_count(); ++t) squares[t] += std::pow(z[t] - value(centroid(mesh, t)), 2) / kBodies;
  }
  EXPECT_NEAR(mean(squares) / mean(handle_gaps(mesh, basis)), 1, 0.15);
}

}  // namespace
}  // namespace aspic

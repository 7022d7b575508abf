#include "contact/contact_candidates.h"

#include <gtest/gtest.h>

#include <random>

#include "mesh/distance.h"
#include "mesh/generators.h"
#include "mesh/surface.h"

namespace aspic {
namespace {

constexpr double kReach = 0.01;

// Two boxes with a gap of twice the reach, as one part.
ContactMesh one_part() {
  const TetMesh box = make_box({}, {{0.1, 0.1, 0.1}}, {3, 3, 3});
  std::vector<Vec3d> X;
  std::vector<Triangle> surface;
  for (const double z : {0.0, 0.1 + 2 * kReach}) {
    const int first = static_cast<int>(X.size());
    for (const Vec3d& x : box.rest) X.push_back(x + Vec3d{{0, 0.01, z}});
    for (const auto& [a, b, c] : boundary_triangles(box, 0, box.tet_count()))
      surface.push_back({a + first, b + first, c + first});
  }
  std::vector<int> rows(X.size());
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
  ContactMesh mesh;
  mesh.add({.name = "body", .young = 1e5}, X, surface, rows);
  return mesh;
}

Vec3d turned(const Vec3d& x, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{x[0], c * x[1] - s * x[2], s * x[1] + c * x[2]}};
}

// Turns, bends and shakes the part.
std::vector<Vec3d> pose(const ContactMesh& mesh, double angle, double bend, std::mt19937& random) {
  std::normal_distribution<double> shake(0, 2e-3);
  std::vector<Vec3d> x;
  for (const Vec3d& X : mesh.rest) {
    const Vec3d bent = turned(X, X[2] > 0.105 ? bend : 0);
    x.push_back(turned(bent, angle) + Vec3d{{0.3 * angle + shake(random), shake(random), shake(random)}});
  }
  return x;
}

// Counts the pairs of a point and a triangle that come close on the way from x to x + d. Requires that all are found,
// with bounds of their gaps.
int expect_complete(const PathCandidates& found, const ContactMesh& mesh, std::span<const Vec3d> x,
                    std::span<const Vec3d> d) {
  int close = 0;
  for (const double t : {0.0, 0.2, 0.5, 0.7, 1.0})
    for (int p = 0; p < mesh.point_count(); ++p)
      for (int k = 0; k < mesh.triangle_count(); ++k) {
        const auto& [a, b, c] = mesh.triangles[k];
        if (p == a || p == b || p == c) continue;
        const auto at = [&](int i) { return x[i] + t * d[i]; };
        const double gap = point_triangle_distance({at(p), at(a), at(b), at(c)}).d;
        if (gap >= kReach) continue;
        ++close;
        const auto near = found.pairs->near(p);
        const auto place = std::find_if(near.begin(), near.end(), [&](const auto& n) { return n.triangle == k; });
        if (place == near.end()) {
          ADD_FAILURE() << "t " << t << " point " << p << " triangle " << k;
          return close;
        }
        EXPECT_LE(found.least_gap(*place, mesh.triangles[k]), gap);
      }
  return close;
}

// Candidates of a path, or of an earlier one that covers it, contain all pairs that come close on it, and bound their
// gaps, although their frame turns.
TEST(CandidateSearch, FindsAllPairsOfABodyThatTurns) {
  const ContactMesh mesh = one_part();
  const ContactLaws laws(mesh, {.reach = kReach});
  CandidateSearch search(PairScope::within_parts, mesh, laws);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-0.25, 0.25);
  int close = 0;
  for (int path = 0; path < 40; ++path) {
    const double angle = 4 * uniform(random);
    std::vector<Vec3d> x = pose(mesh, angle, uniform(random), random);
    std::vector<Vec3d> d = pose(mesh, angle + uniform(random), uniform(random), random);
    for (size_t i = 0; i < x.size(); ++i) d[i] = d[i] - x[i];
    for (const double scale : {1.0, 0.5}) {  // the second path is covered
      for (Vec3d& di : d) di = scale * di;
      const auto found = search.along(x, d);
      ASSERT_TRUE(found);
      close += expect_complete(*found, mesh, x, d);
    }
  }
  EXPECT_GT(close, 1000);
}

// Points of one corner move back and forth. Pairs of the others stay, and those that the corner leaves are dropped.
TEST(CandidateSearch, FindsPairsOfACornerThatMoves) {
  const ContactMesh mesh = one_part();
  const ContactLaws laws(mesh, {.reach = kReach});
  CandidateSearch search(PairScope::within_parts, mesh, laws);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-0.05, 0.05);
  int close = 0;
  for (int path = 0; path < 40; ++path) {
    std::vector<Vec3d> x = mesh.rest, d(x.size());
    for (size_t i = 0; i < x.size(); ++i)
      if (x[i][0] + x[i][1] < 0.05)
        for (int axis = 0; axis < 3; ++axis) x[i][axis] += uniform(random), d[i][axis] = 0.1 * uniform(random);
    const auto found = search.along(x, d);
    ASSERT_TRUE(found);
    close += expect_complete(*found, mesh, x, d);
    const auto fresh = CandidateSearch(PairScope::within_parts, mesh, laws).along(x, d);
    EXPECT_LT(found->pairs->edge_pairs.size(), 2 * fresh->pairs->edge_pairs.size()) << path;
  }
  EXPECT_GT(close, 1000);
}

}  // namespace
}  // namespace aspic

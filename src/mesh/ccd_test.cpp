#include "mesh/ccd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace aspic {
namespace {

using Points = std::array<Vec3d, 4>;
using Real = long double;
using Vec3r = Vec3<Real>;
using Polynomial = std::array<Real, 4>;  // coefficients of 1, t, t^2, t^3

Points at(const MovingPair& pair, double alpha) {
  Points x;
  for (int i = 0; i < 4; ++i) x[i] = pair.x[i] + alpha * pair.dx[i];
  return x;
}

Real value(const Polynomial& p, Real t) { return p[0] + t * (p[1] + t * (p[2] + t * p[3])); }

// Returns a root in [low, high]; p has different signs at both ends.
Real bisect(const Polynomial& p, Real low, Real high) {
  const bool rises = value(p, low) < 0;
  for (int i = 0; i < 80; ++i) {
    const Real middle = (low + high) / 2;
    ((value(p, middle) < 0) == rises ? low : high) = middle;
  }
  return (low + high) / 2;
}

// Returns all roots in [0, 1] and the extrema, which may be double roots.
std::vector<Real> candidate_roots(const Polynomial& p) {
  std::vector<Real> ends = {0, 1};
  const Real a = 3 * p[3], b = 2 * p[2], c = p[1], square = b * b - 4 * a * c;
  if (square >= 0) {
    const Real q = -(b + std::copysign(std::sqrt(square), b)) / 2;
    for (const Real root : {q / a, c / q})
      if (root > 0 && root < 1) ends.push_back(root);
  }
  std::sort(ends.begin(), ends.end());
  std::vector<Real> roots = ends;
  for (size_t i = 1; i < ends.size(); ++i)
    if (value(p, ends[i - 1]) * value(p, ends[i]) < 0) roots.push_back(bisect(p, ends[i - 1], ends[i]));
  return roots;
}

struct LinearVector {
  Vec3r start, rate;
};

LinearVector between(const MovingPair& pair, int i, int j) {
  LinearVector v;
  for (int k = 0; k < 3; ++k) {
    v.start[k] = Real(pair.x[j][k]) - Real(pair.x[i][k]);
    v.rate[k] = Real(pair.dx[j][k]) - Real(pair.dx[i][k]);
  }
  return v;
}

Polynomial triple_product(const LinearVector& a, const LinearVector& b, const LinearVector& c) {
  const Vec3r n0 = cross(a.start, b.start), n2 = cross(a.rate, b.rate);
  const Vec3r n1 = cross(a.start, b.rate) + cross(a.rate, b.start);
  return {dot(n0, c.start), dot(n1, c.start) + dot(n0, c.rate), dot(n2, c.start) + dot(n1, c.rate), dot(n2, c.rate)};
}

Vec3r at(const LinearVector& v, Real t) { return v.start + t * v.rate; }

// Returns whether the interiors of both primitives touch at time t, up to `tolerance` relative to their size.
bool touches(const MovingPair& pair, Real t, Real tolerance) {
  const bool are_edges = pair.kind == PairKind::edge_edge;
  const Vec3r s = at(are_edges ? between(pair, 0, 1) : between(pair, 1, 2), t);
  const Vec3r e = at(are_edges ? between(pair, 3, 2) : between(pair, 1, 3), t);
  const Vec3r r = at(are_edges ? between(pair, 0, 2) : between(pair, 1, 0), t);
  const Vec3r n = cross(s, e);
  const Real nn = dot(n, n);
  if (!(nn > 0)) return false;
  const Real u = dot(cross(r, e), n) / nn, v = dot(cross(s, r), n) / nn;
  const bool is_inside = u >= 0 && v >= 0 && (are_edges ? u <= 1 && v <= 1 : u + v <= 1);
  const Vec3r left = r - u * s - v * e;
  return is_inside && std::sqrt(dot(left, left)) <= tolerance * std::sqrt(dot(s, s) + dot(e, e));
}

// Returns the first contact in [0, 1] from the roots of the volume of the four points, a cubic; infinity if none.
// Independent of the code under test. Cannot detect contact during motion in one plane.
double first_contact(const MovingPair& pair) {
  const Polynomial volume = triple_product(between(pair, 0, 1), between(pair, 0, 2), between(pair, 0, 3));
  Real first = std::numeric_limits<Real>::infinity();
  for (const Real t : candidate_roots(volume))
    if (touches(pair, t, 1e-12L)) first = std::min(first, t);
  return static_cast<double>(first);
}

double gap_on_path(const MovingPair& pair, double alpha, int samples) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= samples; ++i) least = std::min(least, pair_distance(pair.kind, at(pair, alpha * i / samples)).d);
  return least;
}

double landing_gap(const MovingPair& pair, const StepRule& rule) {
  const double start = pair_distance(pair.kind, pair.x).d - rule.offset;
  return start > 2 * rule.landing ? rule.landing : start / 5;
}

class RandomPairs {
 public:
  explicit RandomPairs(unsigned seed) : random_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec3d vector(double scale) {
    return {{scale * normal_(random_), scale * normal_(random_), scale * normal_(random_)}};
  }

  MovingPair pair(PairKind kind, double size, double speed) {
    MovingPair pair = {kind, {}, {}};
    for (int i = 0; i < 4; ++i) {
      pair.x[i] = vector(size);
      pair.dx[i] = vector(speed);
    }
    return pair;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

// Checks that the path has no contact, keeps half the landing gap, and ends for a valid reason.
void expect_safe(const MovingPair& pair, const StepRule& rule, const SafeStep& step) {
  const double landing = landing_gap(pair, rule);
  ASSERT_GE(step.alpha, 0);
  ASSERT_LE(step.alpha, rule.horizon);
  ASSERT_LT(step.alpha, first_contact(pair));
  ASSERT_GT(gap_on_path(pair, step.alpha, 20) - rule.offset, 0.499 * landing);
  if (step.limit == StepLimit::gap)
    ASSERT_LT(pair_distance(pair.kind, at(pair, step.alpha)).d - rule.offset, 1.02 * landing);
  else
    ASSERT_EQ(step.limit, StepLimit::none);
}

constexpr PairKind kKinds[] = {PairKind::point_triangle, PairKind::edge_edge};

TEST(LargestStep, EndsBeforeRootsOfCubicForRandomPairs) {
  RandomPairs random(1);
  int hits = 0, evaluations = 0;
  for (int trial = 0; trial < 100000; ++trial) {
    const MovingPair pair = random.pair(kKinds[trial % 2], 1, std::pow(10, random.uniform(-2, 2)));
    const StepRule rule = {std::pow(10, random.uniform(-5, -1))};
    const SafeStep step = largest_step(pair, rule);
    ASSERT_NO_FATAL_FAILURE(expect_safe(pair, rule, step)) << trial;
    hits += first_contact(pair) <= 1;
    evaluations += step.evaluations;
  }
  EXPECT_GT(hits, 3000);
  EXPECT_LT(evaluations, 5 * 100000);
}

// A triangle or an edge of size 1 at z = 0, and a sliding partner at height `gap`.
MovingPair resting_pair(RandomPairs& random, PairKind kind, double gap) {
  MovingPair pair = {kind, {}, {}};
  const auto near = [&](double x, double y, double z) {
    return Vec3d{{x + random.uniform(-0.2, 0.2), y + random.uniform(-0.2, 0.2), z}};
  };
  if (kind == PairKind::edge_edge)
    pair.x = {near(-0.5, 0, gap), near(0.5, 0, gap), near(0, -0.5, 0), near(0, 0.5, 0)};
  else
    pair.x = {near(0.3, 0.3, gap), near(0, 0, 0), near(1, 0, 0), near(0, 1, 0)};
  const int moving = kind == PairKind::edge_edge ? 2 : 1;
  const Vec3d slide = {{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-1, 0) * gap}};
  for (int i = 0; i < 4; ++i) pair.dx[i] = random.vector(0.05 * gap) + (i < moving ? 1.0 : 0.0) * slide;
  return pair;
}

TEST(LargestStep, SlidesInFewEvaluations) {
  RandomPairs random(2);
  for (const PairKind kind : kKinds) {
    int evaluations = 0;
    for (int trial = 0; trial < 5000; ++trial) {
      const MovingPair pair = resting_pair(random, kind, 3e-3);
      const StepRule rule = {5e-3};
      const SafeStep step = largest_step(pair, rule);
      ASSERT_NO_FATAL_FAILURE(expect_safe(pair, rule, step)) << trial;
      evaluations += step.evaluations;
    }
    EXPECT_LT(evaluations, 8 * 5000);
  }
}

TEST(LargestStep, SeparatingPairsNeedOneEvaluation) {
  RandomPairs random(3);
  for (const PairKind kind : kKinds)
    for (int trial = 0; trial < 100; ++trial) {
      MovingPair pair = resting_pair(random, kind, 1e-3);
      const int moving = kind == PairKind::edge_edge ? 2 : 1;
      for (int i = 0; i < moving; ++i) pair.dx[i] = random.vector(1e-6) + Vec3d{{0, 0, 0.1}};
      const SafeStep step = largest_step(pair, {5e-3});
      ASSERT_EQ(step.alpha, 1);
      ASSERT_EQ(step.evaluations, 1);
    }
}

TEST(LargestStep, LandsAtGivenGapInHeadOnMotion) {
  const MovingPair falling = {PairKind::point_triangle,
                              {{{{0.2, 0.2, 1}}, {{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}}},
                              {{{{0, 0, -10}}, {}, {}, {}}}};
  EXPECT_NEAR(largest_step(falling, {0.01}).alpha, 0.099, 1e-12);
  EXPECT_NEAR(largest_step(falling, {0.7}).alpha, 0.08, 1e-12);  // a fifth of the gap
  EXPECT_NEAR(largest_step(falling, {0.01, 0.5}).alpha, 0.049, 1e-12);
  EXPECT_EQ(largest_step(falling, {0.01, 0, 0.05}).alpha, 0.05);
  EXPECT_EQ(largest_step(falling, {0.01, 0, 0.05}).limit, StepLimit::none);
  EXPECT_EQ(largest_step(falling, {0.01}).limit, StepLimit::gap);
  EXPECT_EQ(largest_step(falling, {0.01}).evaluations, 2);
}

TEST(LargestStep, AcceptsPointsAndPointEdgePairs) {
  const MovingPair points = {PairKind::point_point, {{{{0, 0, 0}}, {{1, 0, 0}}}}, {{{{2, 0, 0}}}}};
  EXPECT_NEAR(largest_step(points, {0.1}).alpha, 0.45, 1e-12);
  const MovingPair edge = {PairKind::point_edge, {{{{0, 0, 0}}, {{1, -1, 0}}, {{1, 1, 0}}}}, {{{{2, 0, 0}}}}};
  EXPECT_NEAR(largest_step(edge, {0.1}).alpha, 0.45, 1e-12);
}

// Motion in the plane of the triangle, where the cubic vanishes.
TEST(LargestStep, KeepsGapInCoplanarMotion) {
  RandomPairs random(4);
  for (int trial = 0; trial < 5000; ++trial) {
    MovingPair pair = random.pair(kKinds[trial % 2], 1, 2);
    for (int i = 0; i < 4; ++i) pair.x[i][2] = pair.dx[i][2] = 0;
    const double start = pair_distance(pair.kind, pair.x).d;
    const SafeStep step = largest_step(pair, {1e-3});
    if (start == 0) {
      ASSERT_EQ(step.limit, StepLimit::resolution);
      ASSERT_EQ(step.alpha, 0);
      continue;
    }
    ASSERT_GT(gap_on_path(pair, step.alpha, 100), 0.499 * landing_gap(pair, {1e-3}));
  }
}

TEST(LargestStep, SlidesAlongParallelEdges) {
  RandomPairs random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3d a = random.vector(1), along = random.vector(1), apart = random.vector(1e-3);
    const double angle = trial % 2 == 0 ? 0 : std::pow(10, random.uniform(-16, -3));
    const MovingPair pair = {PairKind::edge_edge,
                             {{a, a + along, a + apart, a + along + apart + random.vector(angle)}},
                             {{{}, {}, along, along}}};
    const StepRule rule = {1e-3};
    const SafeStep step = largest_step(pair, rule);
    ASSERT_NO_FATAL_FAILURE(expect_safe(pair, rule, step)) << trial;
    ASSERT_LT(step.evaluations, 100);
  }
}

TEST(LargestStep, IsSafeForTinyTrianglesAndHighSpeeds) {
  RandomPairs random(6);
  for (int trial = 0; trial < 20000; ++trial) {
    MovingPair pair = random.pair(kKinds[trial % 2], 1, 1);
    const double flat = std::pow(10, random.uniform(-8, 0)), speed = std::pow(10, random.uniform(0, 3));
    for (int i = 0; i < 4; ++i) {
      pair.x[i][trial % 3] *= flat;
      pair.dx[i] = speed * pair.dx[i];
    }
    const StepRule rule = {1e-3};
    const SafeStep step = largest_step(pair, rule);
    ASSERT_LT(step.alpha, first_contact(pair));
    ASSERT_GT(gap_on_path(pair, step.alpha, 20), 0.499 * landing_gap(pair, rule));
  }
}

TEST(LargestStep, IsSafeFarFromOrigin) {
  RandomPairs random(7);
  for (const double far : {1e3, 1e6, 1e9})
    for (int trial = 0; trial < 5000; ++trial) {
      MovingPair pair = random.pair(kKinds[trial % 2], 1, 1);
      const Vec3d shift = random.vector(far);
      for (Vec3d& x : pair.x) x = x + shift;
      const SafeStep step = largest_step(pair, {1e-3});
      ASSERT_LT(step.alpha, first_contact(pair));
      for (const double part : {0.5, 0.9, 1.0})  // the rounded positions are apart
        ASSERT_GT(pair_distance(pair.kind, at(pair, part * step.alpha)).d, 0);
    }
}

TEST(LargestStep, RejectsTinyGapsAndNonFiniteInput) {
  MovingPair pair = {PairKind::point_triangle,
                     {{{{0.2, 0.2, 1e-14}}, {{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}}},
                     {{{{0, 0, 1}}, {}, {}, {}}}};
  EXPECT_EQ(largest_step(pair, {1e-3}).limit, StepLimit::resolution);
  EXPECT_EQ(largest_step(pair, {1e-3}).alpha, 0);
  pair.x[0][2] = 1e-12;
  EXPECT_EQ(largest_step(pair, {1e-3}).alpha, 1);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    pair.dx[2][1] = bad;
    EXPECT_EQ(largest_step(pair, {1e-3}).limit, StepLimit::resolution);
  }
}

TEST(LargestStep, IsInvariantUnderScaling) {
  RandomPairs random(8);
  for (int trial = 0; trial < 2000; ++trial) {
    const MovingPair pair = random.pair(kKinds[trial % 2], 1, 1);
    MovingPair scaled = pair;
    for (Vec3d& x : scaled.x) x = 0x1p10 * x;
    for (Vec3d& dx : scaled.dx) dx = 0x1p10 * dx;
    ASSERT_EQ(largest_step(pair, {1e-3}).alpha, largest_step(scaled, {0x1p10 * 1e-3}).alpha);
  }
}

TEST(LargestStep, DoesNotDependOnHorizonBeyondIt) {
  RandomPairs random(9);
  for (int trial = 0; trial < 2000; ++trial) {
    const MovingPair pair = random.pair(kKinds[trial % 2], 1, 1);
    const double alpha = largest_step(pair, {1e-3}).alpha, horizon = random.uniform(0, 1);
    ASSERT_EQ(largest_step(pair, {1e-3, 0, horizon}).alpha, std::min(alpha, horizon));
  }
}

}  // namespace
}  // namespace aspic

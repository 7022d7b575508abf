#include "energy/rod.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "energy/internal_variables.h"
#include "energy/sheet_grid_test.h"
#include "mesh/elements.h"

namespace aspic {
namespace {

constexpr double kPi = std::numbers::pi;

// A chain of points, closed if the last segment leads back to the first.
struct Chain {
  TetMesh mesh;
  std::vector<RodSegment> segments;
  std::unique_ptr<Energy> V;

  Chain(std::vector<Vec3d> rest, bool is_closed, const RodSegment& of_all = {{}, 2, 1.4}) {
    mesh.rest = std::move(rest);
    const int n = mesh.vertex_count();
    for (int s = 0; s < (is_closed ? n : n - 1); ++s) {
      mesh.rods.push_back({s, (s + 1) % n});
      mesh.radius.push_back(0.01);
      RodSegment segment = of_all;
      segment.ends = mesh.rods.back();
      segment.row = n + s / 3;
      segment.entry = s % 3;
      segment.length = 0.3;
      segments.push_back(segment);
    }
    V = make_rod_bending(mesh, segments);
  }

  InternalVariables& internal() const { return dynamic_cast<InternalVariables&>(*V); }
  size_t rows() const { return mesh.rest.size() + (mesh.rods.size() + 2) / 3; }
  std::vector<double> at_rest() const {
    std::vector<double> x = flattened(mesh.rest);
    x.resize(3 * rows(), 0.0);
    return x;
  }
  std::vector<double> shaken(double amount, unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-amount, amount);
    std::vector<double> x = at_rest();
    for (double& xi : x) xi += uniform(random);
    return x;
  }
  std::vector<double> rotated(std::vector<double> x) const {
    const std::vector<double> moved = moved_rigidly({x.begin(), x.begin() + 3 * mesh.vertex_count()});
    std::copy(moved.begin(), moved.end(), x.begin());
    return x;
  }
};

std::vector<Vec3d> curve(int n) {
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) points.push_back({{0.8 * i, 0.3 * std::sin(1.3 * i), 0.2 * std::cos(0.7 * i)}});
  return points;
}
std::vector<Vec3d> circle(int n) {
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) points.push_back({{std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), 0}});
  return points;
}

TEST(RodBending, DerivativesMatchDifferences) {
  for (const bool is_closed : {false, true}) {
    const Chain chain(is_closed ? circle(6) : curve(6), is_closed, {{}, 2, 1.4, 0.4});
    const std::vector<double> start = chain.shaken(0.1, 1), x = chain.shaken(0.25, 2);
    expect_sheet_derivatives(*chain.V, x, 0.1, {.start = start});
    expect_sheet_derivatives(*chain.V, x, 0.1);
  }
}

TEST(RodBending, HeldAndStraightSegmentsHaveCorrectDerivatives) {
  Chain chain(curve(5), false, {{}, 2, 1.4, 0, true});
  chain.segments[0].is_held = true;
  chain.V = make_rod_bending(chain.mesh, chain.segments);
  expect_sheet_derivatives(*chain.V, chain.shaken(0.25, 2), 0.1, {.start = chain.shaken(0.1, 1)});
}

// Runs a step from `start` to `end`, and returns the internal variables at the end.
std::vector<double> stepped(const Chain& chain, const std::vector<double>& start, const std::vector<double>& end,
                            const std::vector<double>& z) {
  const ActiveTerm term(*chain.V, {.start = start});
  chain.internal().begin_internal(z, 0, term.context());
  std::vector<double> after(z.size());
  chain.internal().end_internal(end, term.context(), after);
  return after;
}

std::vector<double> initial(const Chain& chain, const std::vector<double>& x) {
  std::vector<double> z(chain.internal().internal_range().size());
  chain.internal().write_initial(x, z);
  return z;
}

TEST(RodBending, StoresTheChangeOfTheEnergy) {
  const Chain chain(curve(6), false);
  std::vector<double> start = chain.shaken(0.1, 1), end = chain.shaken(0.2, 2);
  start.back() = end.back() = 0;  // unused
  const std::vector<double> z = initial(chain, start);
  const ActiveTerm term(*chain.V, {.start = start});
  chain.internal().begin_internal(z, 0, term.context());
  const double before = chain.internal().stored_energy(z);
  EXPECT_NEAR(term.value(start), 0, 1e-13 * before);
  EXPECT_NEAR(term.value(end), chain.internal().stored_energy(stepped(chain, start, end, z)) - before, 1e-12 * before);
}

TEST(RodBending, IsFreeOfForcesAtRest) {
  const Chain chain(curve(6), false);
  const std::vector<double> x = chain.at_rest();
  for (const double g : gradient_of(*chain.V, x, {.start = x})) EXPECT_NEAR(g, 0, 1e-14);
}

// A rotation turns each director by the component of its axis along the tangent.
TEST(RodBending, HasNoTorqueAgainstRotations) {
  const Chain chain(curve(6), false);
  std::vector<double> start = chain.shaken(0.1, 1), x = chain.shaken(0.2, 2);
  start.back() = x.back() = 0;  // unused
  const std::vector<double> g = gradient_of(*chain.V, x, {.start = start});
  const Vec3d axis = {{0.3, -0.5, 0.8}};
  double work = 0, size = 0;
  const auto add = [&](double force, double motion) { work += force * motion, size += std::abs(force * motion); };
  for (int v = 0; v < chain.mesh.vertex_count(); ++v) {
    const Vec3d dx = cross(axis, point(x, v));
    for (int r = 0; r < 3; ++r) add(g[3 * v + r], dx[r]);
  }
  for (const RodSegment& segment : chain.segments) {
    const auto tangent = [&](const std::vector<double>& q) {
      const Vec3d e = point(q, segment.ends[1]) - point(q, segment.ends[0]);
      return (1 / norm(e)) * e;
    };
    const Vec3d s = tangent(start), t = tangent(x);
    const double spin = dot(axis, t) + dot(cross(s, t), cross(axis, t)) / (1 + dot(s, t));
    add(g[3 * static_cast<size_t>(segment.row) + segment.entry], segment.length * spin);
  }
  EXPECT_NEAR(work, 0, 1e-13 * size);
}

TEST(RodBending, IsTheSameAfterARotationOfStartAndEnd) {
  const Chain chain(curve(6), false);
  const std::vector<double> start = chain.shaken(0.1, 1), end = chain.shaken(0.2, 2), z = initial(chain, start);
  std::vector<double> turned_z = z;
  for (size_t s = 0; s < chain.segments.size(); ++s) {
    const std::vector<double> moved = moved_rigidly({z[8 * s], z[8 * s + 1], z[8 * s + 2], 0, 0, 0});
    for (int r = 0; r < 3; ++r) turned_z[8 * s + r] = moved[r] - moved[3 + r];
  }
  const std::vector<double> after = stepped(chain, start, end, z),
                            turned_after = stepped(chain, chain.rotated(start), chain.rotated(end), turned_z);
  for (size_t i = 0; i < z.size(); ++i) {
    if (i % 8 >= 3) {
      EXPECT_NEAR(after[i], turned_after[i], 1e-12);
    }
  }
}

TEST(RodBending, ClosedCurveIsFreeOfForcesAtRest) {
  std::vector<Vec3d> points = circle(9);
  for (int i = 0; i < 9; ++i) points[i][2] = 0.3 * std::sin(1.7 * i);
  for (const bool is_straight : {false, true}) {
    const Chain chain(points, true, {{}, 2, 1.4, 0, is_straight});
    const std::vector<double> x = chain.at_rest(), z = initial(chain, x);
    const ActiveTerm term(*chain.V, {.start = x});
    chain.internal().begin_internal(z, 0, term.context());
    std::vector<double> g(x.size());
    term.add_gradient(x, 1, g);
    for (size_t i = is_straight ? 27 : 0; i < x.size(); ++i) EXPECT_NEAR(g[i], 0, 1e-13);
  }
}

// A straight rod whose last segment is turned in steps: the twist may exceed a turn.
TEST(RodBending, AccumulatesTurns) {
  std::vector<Vec3d> line;
  for (int i = 0; i < 5; ++i) line.push_back({{0, 0, 0.5 * i}});
  const Chain chain(line, false);
  std::vector<double> x = chain.at_rest(), z = initial(chain, x);
  const size_t last = 3 * static_cast<size_t>(chain.segments[3].row) + chain.segments[3].entry;
  for (int k = 1; k <= 10; ++k) {
    std::vector<double> y = x;
    y[last] = k * chain.segments[3].length;
    z = stepped(chain, x, y, z);
    x = y;
  }
  EXPECT_NEAR(z[8 * 2 + 7], 10, 1e-12);
  EXPECT_NEAR(chain.internal().stored_energy(z), 0.5 * 1.4 / 0.5 * 100, 1e-10);
}

TEST(RodBending, BendingOfAnArcIsThatOfItsCurvature) {
  constexpr int n = 200;
  std::vector<Vec3d> line;
  for (int i = 0; i <= n; ++i) line.push_back({{kPi / n * i, 0, 0}});
  const Chain chain(line, false);
  std::vector<double> x = chain.at_rest();
  for (int i = 0; i <= n; ++i) x[3 * i] = std::sin(kPi * i / n), x[3 * i + 1] = std::cos(kPi * i / n);
  EXPECT_NEAR(chain.internal().stored_energy(initial(chain, x)), 0.5 * 2 * kPi, 0.05);
}

TEST(RodBending, SegmentWithoutJointsHasASpring) {
  const Chain chain(curve(2), false);
  expect_sheet_derivatives(*chain.V, chain.shaken(0.2, 1), 0.1);
  EXPECT_GT(dense_hessian(*chain.V, chain.at_rest(), Definiteness::exact).H(6, 6), 0);
}

TEST(RodBending, IsUndefinedForTurnedTangents) {
  const Chain chain(curve(4), false);
  std::vector<double> x = chain.at_rest();
  for (size_t i = 0; i < 12; ++i) x[i] = -x[i];
  EXPECT_TRUE(std::isinf(ActiveTerm(*chain.V).value(x)));
}

TEST(RodBending, ModifiedHessiansAreDefinite) {
  const Chain chain(curve(6), false);
  const std::vector<double> x = chain.shaken(0.25, 2);
  for (const Definiteness kind : {Definiteness::clamped, Definiteness::absolute}) {
    const DenseHessian dense = dense_hessian(*chain.V, x, kind);
    EXPECT_GT(dense.modified, 0);
    EXPECT_GT(dense.eigenvalues().minCoeff(), -1e-9 * dense.eigenvalues().maxCoeff());
  }
}

TEST(RodBending, HasEqualBitsForAnyNumberOfThreads) {
  const Chain chain(curve(600), false);
  expect_equal_bits_for_threads(*chain.V, chain.shaken(0.1, 1));
}

TEST(RodStretch, DerivativesMatchDifferencesAndFieldsAreThoseOfTheStretch) {
  const Chain chain(curve(4), false);
  const std::vector<double> young(3, 1e6);
  const auto V = make_rod_stretch(chain.mesh, 0, young);
  std::vector<double> x = flattened(chain.mesh.rest);
  for (double& xi : x) xi *= 1.1;
  expect_sheet_derivatives(*V, x, 0.1);
  EXPECT_NEAR(V->min_det_F(x), 1.1, 1e-12);
  TetFields fields{std::vector<double>(3), std::vector<double>(3), std::vector<double>(18), std::vector<double>(3)};
  V->evaluate(x, fields);
  EXPECT_NEAR(fields.von_mises[0], 1e5, 1e-6);
  EXPECT_NEAR(fields.energy_density[0], 5e3, 1e-6);
  const Mat3d F = deformation_gradient(chain.mesh, 1, x);
  EXPECT_NEAR(determinant(F), 1.1, 1e-12);
}

TEST(RodRows, HaveThePolarInertia) {
  const Chain chain(curve(5), false);
  const std::vector<double> density(4, 1000);
  const std::vector<AngleRow> rows = make_rod_rows(chain.mesh, 0, density, 0.01);
  ASSERT_EQ(rows.size(), 2);
  const double length = norm(chain.mesh.rest[4] - chain.mesh.rest[3]);
  EXPECT_NEAR(rows[1].mass, 0.5 * 1000 * kPi * 1e-4 * length, 1e-12);
  EXPECT_EQ(rows[1].vertex, 3);
}

}  // namespace
}  // namespace aspic

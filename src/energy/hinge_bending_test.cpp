#include "energy/hinge_bending.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "energy/hinge_angle.h"
#include "energy/internal_variables.h"
#include "energy/sheet_grid_test.h"

namespace aspic {
namespace {

std::unique_ptr<HingeBending> bending_of(const SheetGrid& grid, RestAngles rest_angles = RestAngles::flat) {
  std::vector<double> moment;
  for (size_t t = 0; t < grid.triangles.size(); ++t) moment.push_back(0.1 + 0.01 * static_cast<double>(t));
  return make_hinge_bending(grid.rest, grid.triangles, moment, rest_angles);
}

// Two triangles at the edge (0, 1), with an angle of 1.19 rad in the shape and 0.03 rad at rest.
SheetGrid skew_pair() {
  return {{{{0, 0, 0}}, {{1, 0.1, 0.2}}, {{0.3, 0.8, -0.1}}, {{0.6, -0.7, 0.3}}}, {{0, 1, 2}, {0, 1, 3}}};
}
const std::vector<double> kSkewPairShape = {0.1, 0.2, 0.3, 1.2, 0.4, 0.1, 0.2, 0.9, 0.5, 0.7, -0.3, 0.9};

SheetGrid curved_grid(int nx, int ny) {
  SheetGrid grid = sheet_grid(nx, ny, 0.5, 0.2);
  for (Vec3d& X : grid.rest) X[2] = 0.3 * std::sin(2 * X[0]) + 0.4 * X[0] * X[1];
  return grid;
}

// Derivatives by differences with 50 digits of an energy whose angle is pi minus the arc cosine of the directions from
// the edge to c and d.
TEST(HingeBending, MatchesIndependentDerivatives) {
  const SheetGrid pair = skew_pair();
  const auto V = make_hinge_bending(pair.rest, pair.triangles, std::vector<double>{2, 5}, RestAngles::of_rest);
  const std::vector<double>& x = kSkewPairShape;
  EXPECT_NEAR(hinge_angle({point(x, 0), point(x, 1), point(x, 2), point(x, 3)}), 1.1861815039248673, 1e-15);
  EXPECT_NEAR(V->value(x), 3.0739324503897883, 1e-14);
  const std::vector<double> g = gradient_of(*V, x);
  EXPECT_NEAR(g[0], -1.3162621831394242, 1e-13);
  EXPECT_NEAR(g[4], -1.154578726883002, 1e-13);
  EXPECT_NEAR(g[8], 6.9243951297806759, 1e-13);
  EXPECT_NEAR(g[10], 4.4425588872734865, 1e-13);
  const Eigen::MatrixXd H = dense_hessian(*V, x, Definiteness::exact).H;
  EXPECT_NEAR(H(0, 0), -1.449966201117634, 1e-13);
  EXPECT_NEAR(H(1, 5), 2.4671928067692112, 1e-13);
  EXPECT_NEAR(H(6, 2), 3.3912392375040291, 1e-13);
  EXPECT_NEAR(H(7, 8), -10.613938938271909, 1e-12);
  EXPECT_NEAR(H(9, 7), 0.041055948641775015, 1e-13);
  EXPECT_NEAR(H(11, 3), 0.1637392305936437, 1e-13);
  EXPECT_NEAR(H(4, 4), 4.5494700591842076, 1e-13);
}

TEST(HingeBending, DerivativesMatchDifferences) {
  for (const RestAngles rest_angles : {RestAngles::flat, RestAngles::of_rest})
    for (const double amount : {0.02, 0.15}) {
      const SheetGrid grid = curved_grid(4, 3);
      expect_sheet_derivatives(*bending_of(grid, rest_angles), shaken_sheet(grid, amount), 0.02);
    }
}

TEST(HingeBending, SharpFoldsHaveCorrectDerivatives) {
  const SheetGrid grid = sheet_grid(1, 1, 1);
  const auto V = bending_of(grid);
  for (const double angle : {-3.1, -2.0, 2.0, 3.1}) {  // turns vertex 1 about the diagonal
    std::vector<double> x = flattened(grid.rest);
    const double h = std::sqrt(0.5);
    x[3] = 0.5 + h * h * std::cos(angle);
    x[4] = 0.5 - h * h * std::cos(angle);
    x[5] = h * std::sin(angle);
    EXPECT_NEAR(V->value(x), 0.5 * (0.105 * 2) * angle * angle, 1e-13);  // k = D l^2 / (A1 + A2)
    expect_sheet_derivatives(*V, x, 0.02);
    EXPECT_GT(dense_hessian(*V, x, Definiteness::clamped).eigenvalues().minCoeff(), -1e-13);
  }
}

TEST(HingeBending, IgnoresRigidMotions) {
  const SheetGrid grid = curved_grid(4, 3);
  const std::vector<double> x = shaken_sheet(grid, 0.1);
  const auto V = bending_of(grid);
  EXPECT_NEAR(V->value(moved_rigidly(x)), V->value(x), 1e-12 * V->value(x));
  EXPECT_LT(bending_of(grid, RestAngles::of_rest)->value(moved_rigidly(flattened(grid.rest))), 1e-25);
  const std::vector<double> g = gradient_of(*V, x);
  Vec3d force{}, torque{};
  for (int v = 0; v < grid.vertex_count(); ++v) {
    const Vec3d f = {{g[3 * v], g[3 * v + 1], g[3 * v + 2]}};
    force = force + f;
    torque = torque + cross(point(x, v), f);
  }
  EXPECT_LT(norm(force), 1e-12);
  EXPECT_LT(norm(torque), 1e-12);
}

TEST(HingeBending, CylinderHasContinuumEnergy) {
  const int nx = 12, ny = 5;
  const double edge = 0.1, turn = 0.2, D = 3, radius = edge / turn;
  const SheetGrid grid = sheet_grid(nx, ny, edge);
  const auto V =
      make_hinge_bending(grid.rest, grid.triangles, std::vector<double>(grid.triangles.size(), D), RestAngles::flat);
  std::vector<double> x = flattened(grid.rest);
  double along = 0, up = 0;
  for (int i = 0; i <= nx; ++i) {  // a chain of edges that keeps their length
    for (int j = 0; j <= ny; ++j) {
      x[3 * (i + j * (nx + 1))] = along;
      x[3 * (i + j * (nx + 1)) + 2] = up;
    }
    along += edge * std::cos(i * turn);
    up += edge * std::sin(i * turn);
  }
  const double area = (nx - 1) * edge * ny * edge;  // without half an edge at both ends
  EXPECT_NEAR(V->value(x), 0.5 * D / (radius * radius) * area, 1e-12);
  std::vector<double> density;
  V->evaluate(x, density);
  EXPECT_NEAR(density[density.size() / 2], 0.5 * D / (radius * radius), 1e-12);
  double sum = 0;
  for (const double d : density) sum += d * edge * edge / 2;
  EXPECT_NEAR(sum, V->value(x), 1e-12);
}

TEST(HingeBending, IgnoresOrientationOfTriangles) {
  SheetGrid grid = curved_grid(4, 3);
  const std::vector<double> x = shaken_sheet(grid, 0.1);
  for (const RestAngles rest_angles : {RestAngles::flat, RestAngles::of_rest}) {
    const double V = bending_of(grid, rest_angles)->value(x);
    SheetGrid turned = grid;
    for (size_t t = 0; t < turned.triangles.size(); t += 3) std::swap(turned.triangles[t][0], turned.triangles[t][1]);
    EXPECT_NEAR(bending_of(turned, rest_angles)->value(x), V, 1e-13 * V);
  }
}

TEST(HingeBending, ModifiedHessiansArePositiveSemidefinite) {
  const SheetGrid grid = curved_grid(4, 3);
  const std::vector<double> x = shaken_sheet(grid, 0.15);
  const auto V = bending_of(grid);
  const DenseHessian exact = dense_hessian(*V, x, Definiteness::exact);
  const double largest = exact.eigenvalues().maxCoeff();
  EXPECT_EQ(exact.modified, 0);
  ASSERT_LT(exact.eigenvalues().minCoeff(), -1e-2 * largest);
  const DenseHessian clamped = dense_hessian(*V, x, Definiteness::clamped);
  const DenseHessian absolute = dense_hessian(*V, x, Definiteness::absolute);
  for (const DenseHessian* H : {&clamped, &absolute}) {
    EXPECT_GT(H->eigenvalues().minCoeff(), -1e-12 * largest);
    EXPECT_GT(H->modified, 0);
  }
  // Each modification adds stiffness.
  EXPECT_GT((DenseHessian{clamped.H - exact.H, 0}.eigenvalues().minCoeff()), -1e-12 * largest);
  EXPECT_GT((DenseHessian{absolute.H - clamped.H, 0}.eigenvalues().minCoeff()), -1e-12 * largest);
}

TEST(HingeBending, HessianAtRestAnglesIsUnmodified) {
  const SheetGrid grid = curved_grid(4, 3);
  const auto V = bending_of(grid, RestAngles::of_rest);
  const std::vector<double> x = flattened(grid.rest);
  const DenseHessian clamped = dense_hessian(*V, x, Definiteness::clamped);
  EXPECT_EQ(clamped.modified, 0);
  EXPECT_EQ(clamped.H, dense_hessian(*V, x, Definiteness::exact).H);
}

TEST(HingeBending, JunctionHasHingesBetweenNeighbors) {
  SheetGrid junction = {{{{0, 0, 0}}, {{0, 1, 0}}}, {}};  // 4 wings at right angles and one on top of the first
  for (const int quarter : {0, 2, 1, 3, 0}) {
    const double angle = 0.5 * std::numbers::pi * quarter;
    junction.triangles.push_back({0, 1, junction.vertex_count()});
    junction.rest.push_back({{std::cos(angle), 0.5, std::sin(angle)}});
  }
  const auto V = make_hinge_bending(junction.rest, junction.triangles, std::vector<double>(5, 1), RestAngles::flat);
  std::vector<double> x = flattened(junction.rest);
  EXPECT_LT(V->value(x), 1e-25);
  Couplings couplings;
  V->add_couplings(couplings);
  EXPECT_EQ(couplings.size(), 4U * 6U);
  x[3 * 3 + 2] += std::tan(0.2);  // turns the wing opposite to the first, which has two neighbors
  EXPECT_NEAR(V->value(x), 2 * 0.5 * 0.2 * 0.2, 1e-13);
  expect_sheet_derivatives(*V, shaken_sheet(junction, 0.1), 0.02);
}

TEST(HingeBending, CollapsedTriangleIsInfinite) {
  const SheetGrid pair = skew_pair();
  const auto V = bending_of(pair);
  std::vector<double> x = kSkewPairShape;
  for (size_t r = 0; r < 3; ++r) x[6 + r] = x[r];
  EXPECT_EQ(V->value(x), INFINITY);
  x[6] = NAN;
  EXPECT_EQ(V->value(x), INFINITY);
}

TEST(HingeBending, EqualBitsForAnyThreadCount) {
  const SheetGrid grid = sheet_grid(40, 30, 0.1, 0.2);
  expect_equal_bits_for_threads(*bending_of(grid), shaken_sheet(grid, 0.03));
}

std::unique_ptr<Energy> creases_of(const SheetGrid& grid, double yield) {
  TetMesh mesh{.rest = grid.rest, .tets = {}, .region = {}, .sheet = grid.triangles};
  mesh.thickness.assign(grid.triangles.size(), 1e-3);
  return make_creases("creases", {mesh, 0, std::vector<double>(grid.triangles.size(), 0.1), RestAngles::flat, yield});
}

TEST(Creases, DerivativesMatchDifferences) {
  const SheetGrid grid = curved_grid(4, 3);
  const std::vector<double> start = shaken_sheet(grid, 0.02), x = shaken_sheet(grid, 0.15, 4);
  for (const double yield : {0.02, 0.1, 10.0})  // all, some and none yield
    expect_sheet_derivatives(*creases_of(grid, yield), x, 0.01, {.start = start});
  expect_equal_bits_for_threads(*creases_of(grid, 0.1), x, {.start = start});
  for (const Definiteness kind : {Definiteness::clamped, Definiteness::absolute})
    EXPECT_GT(dense_hessian(*creases_of(grid, 0.1), x, kind, {.start = start}).eigenvalues().minCoeff(), -1e-11);
}

TEST(Creases, BelowTheLimitIsHingeBending) {
  const SheetGrid grid = curved_grid(4, 3);
  const std::vector<double> flat(grid.triangles.size(), 0.1), x = shaken_sheet(grid, 0.1);
  const auto V = make_hinge_bending(grid.rest, grid.triangles, flat, RestAngles::flat);
  const auto D = creases_of(grid, 100);
  const auto& variables = dynamic_cast<const InternalVariables&>(*D);
  const std::vector<double> start = flattened(grid.rest);
  std::vector<double> z(variables.internal_range().size());
  variables.write_initial(start, z);
  EXPECT_NEAR(variables.stored_energy(z), V->value(start), 1e-14);
  ActiveTerm term(*D, {.start = start});
  variables.begin_internal(z, 0, term.context());
  EXPECT_NEAR(term.value(x), V->value(x) - V->value(start), 1e-13);
  std::vector<double> end(z.size());
  variables.end_internal(x, term.context(), end);
  EXPECT_NEAR(variables.stored_energy(end), V->value(x), 1e-13);
}

// Two right-angled triangles are folded along their diagonal beyond the limit, and back.
TEST(Creases, LossIsLimitTimesChangeOfRestAngle) {
  const SheetGrid grid = sheet_grid(1, 1, 1);
  const double yield = 0.05, moment = yield * std::sqrt(2.0), stiffness = 0.1 * 2, elastic = moment / stiffness;
  const auto folded = [&](double angle) {
    std::vector<double> x = flattened(grid.rest);
    x[3] = 0.5 + 0.5 * std::cos(angle), x[4] = 0.5 - 0.5 * std::cos(angle), x[5] = std::sqrt(0.5) * std::sin(angle);
    return x;
  };
  const auto D = creases_of(grid, yield);
  const auto& variables = dynamic_cast<const InternalVariables&>(*D);
  std::vector<double> z(variables.internal_range().size()), start = folded(0);
  variables.write_initial(start, z);
  double expected_rest = 0;
  for (const double angle : {-0.2, -1.5, -1.3, 0.4, 3.0}) {
    ActiveTerm term(*D, {.start = start});
    const std::vector<double> before = z;
    variables.begin_internal(before, 0, term.context());
    const std::vector<double> end = folded(angle);
    variables.end_internal(end, term.context(), z);
    const InternalEnergies energies = variables.internal_energies({start, end, z}, term.context());
    const double rest = std::clamp(expected_rest, angle - elastic, angle + elastic);
    EXPECT_NEAR(energies.loss, moment * std::abs(rest - expected_rest), 1e-13) << angle;
    EXPECT_NEAR(energies.gain + energies.loss, term.value(end), 1e-13);
    expected_rest = rest;
    start = end;
  }
}

}  // namespace
}  // namespace aspic

#include "energy/mid_edge_bending.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "energy/sheet_grid_test.h"
#include "mesh/topology.h"

namespace aspic {
namespace {

constexpr double kPoisson = 0.3;

PlateStiffness plate(double D) { return {D, D, kPoisson * D, 0.5 * (1 - kPoisson) * D}; }

// A sheet with its bending and positions of its vertices and angles.
struct BentSheet {
  SheetGrid grid;
  std::vector<EdgeUse> uses;
  std::unique_ptr<MidEdgeBending> V;
  int rows = 0;  // of the angles
  double length = 0;

  explicit BentSheet(SheetGrid sheet, RestAngles rest_angles = RestAngles::of_rest, const std::vector<char>& held = {})
      : grid(std::move(sheet)), uses(edge_uses(grid.triangles)) {
    std::vector<PlateStiffness> stiffness;
    for (size_t t = 0; t < grid.triangles.size(); ++t) stiffness.push_back(plate(0.1 + 0.01 * static_cast<double>(t)));
    V = make_mid_edge_bending({grid.rest, grid.triangles, stiffness, rest_angles, grid.vertex_count(), held});
    const std::vector<double> mass(grid.triangles.size(), 1.0);
    rows = static_cast<int>(make_angle_rows(grid.rest, grid.triangles, mass).size());
    int count = 0;
    for_each_edge(uses, [&](const EdgeUse* use, const EdgeUse*) {
      length += norm(grid.rest[use->edge[1]] - grid.rest[use->edge[0]]);
      ++count;
    });
    length /= count;
  }

  std::vector<double> with_angles(std::vector<double> x) const {
    x.resize(3 * static_cast<size_t>(grid.vertex_count() + rows), 0.0);
    return x;
  }
  // Random displacements and angles.
  std::vector<double> shaken(double amount, double angle) const {
    std::vector<double> x = with_angles(shaken_sheet(grid, amount));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-angle * length, angle * length);
    for (size_t i = 3 * static_cast<size_t>(grid.vertex_count()); i < x.size(); ++i) x[i] = uniform(random);
    return x;
  }
};

SheetGrid curved_sheet(int nx, int ny) {
  SheetGrid grid = sheet_grid(nx, ny, 0.5, 0.2);
  for (Vec3d& X : grid.rest) X[2] = 0.3 * std::sin(2 * X[0]) + 0.4 * X[0] * X[1];
  return grid;
}

// The vertices of the first two columns.
std::vector<char> first_columns(const SheetGrid& grid, int nx) {
  std::vector<char> held(grid.rest.size(), 0);
  for (int v = 0; v < grid.vertex_count(); ++v) held[v] = v % (nx + 1) < 2;
  return held;
}

TEST(MidEdgeBending, DerivativesMatchDifferences) {
  for (const RestAngles rest_angles : {RestAngles::flat, RestAngles::of_rest}) {
    const BentSheet sheet(curved_sheet(4, 3), rest_angles);
    expect_sheet_derivatives(*sheet.V, sheet.shaken(0.05, 0.3), 0.02);
    const BentSheet clamped(curved_sheet(4, 3), rest_angles, first_columns(curved_sheet(4, 3), 4));
    expect_sheet_derivatives(*clamped.V, clamped.shaken(0.05, 0.3), 0.02);
  }
}

// A closed surface: the three neighbors of a triangle share a vertex.
TEST(MidEdgeBending, TetrahedronHasCorrectDerivatives) {
  const BentSheet sheet({{{{0, 0, 0}}, {{1, 0.1, 0.2}}, {{0.3, 0.8, -0.1}}, {{0.4, 0.3, 0.9}}},
                         {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}});
  expect_sheet_derivatives(*sheet.V, sheet.shaken(0.1, 0.3), 0.01);
}

// z = X'C X / 2 with a small C.
struct QuadraticSurface {
  double C11 = 2e-7, C22 = -1e-7, C12 = 1.5e-7;

  Vec3d slope(const Vec3d& X) const { return {{C11 * X[0] + C12 * X[1], C12 * X[0] + C22 * X[1], 0}}; }
  double density(const PlateStiffness& D) const {
    return 0.5 * (D.D11 * C11 * C11 + 2 * D.D12 * C11 * C22 + D.D22 * C22 * C22 + D.D33 * 4 * C12 * C12);
  }

  // Returns the half angle of a triangle at one of its edges if the normal at the middle of the edge is that of the
  // surface.
  double half_angle(const SheetGrid& grid, const EdgeUse& use) const {
    const Triangle& t = grid.triangles[use.triangle];
    const Vec3d &A = grid.rest[use.edge[0]], &B = grid.rest[use.edge[1]];
    const Vec3d edge = B - A, n = (1 / norm(edge)) * Vec3d{{edge[1], -edge[0], 0}};  // outward if use.forward
    // Gradient of the linear interpolant, from its values at two edges.
    const Vec3d p = grid.rest[t[1]] - grid.rest[t[0]], q = grid.rest[t[2]] - grid.rest[t[0]];
    const auto z = [&](int v) { return 0.5 * dot(slope(grid.rest[v]), grid.rest[v]); };
    const double zp = z(t[1]) - z(t[0]), zq = z(t[2]) - z(t[0]), det = p[0] * q[1] - p[1] * q[0];
    const Vec3d gradient = {{(zp * q[1] - zq * p[1]) / det, (zq * p[0] - zp * q[0]) / det, 0}};
    return (use.forward ? 1 : -1) * dot(slope(0.5 * (A + B)) - gradient, n);
  }

  std::vector<double> positions(const BentSheet& sheet) const {
    std::vector<double> x = sheet.with_angles(flattened(sheet.grid.rest));
    for (int v = 0; v < sheet.grid.vertex_count(); ++v)
      x[3 * v + 2] = 0.5 * dot(slope(sheet.grid.rest[v]), sheet.grid.rest[v]);
    size_t entry = 3 * static_cast<size_t>(sheet.grid.vertex_count());
    for_each_edge(sheet.uses, [&](const EdgeUse* first, const EdgeUse* last) {
      const double a = half_angle(sheet.grid, *first);
      const double xi = last - first == 1 ? a : 0.5 * (a - half_angle(sheet.grid, first[1]));
      x[entry++] = sheet.length * (first->forward ? 1 : -1) * xi;
    });
    return x;
  }
};

TEST(MidEdgeBending, ConstantCurvatureHasContinuumEnergy) {
  const BentSheet sheet(sheet_grid(5, 4, 0.3, 0.25));
  const QuadraticSurface surface;
  std::vector<double> density;
  sheet.V->evaluate(surface.positions(sheet), density);
  for (size_t t = 0; t < density.size(); ++t) {
    const double expected = surface.density(plate(0.1 + 0.01 * static_cast<double>(t)));
    EXPECT_NEAR(density[t], expected, 1e-11 * expected) << t;
  }
}

// The patch test: constant moments need no forces inside. xi of the border is relative to its triangles, whose vertices
// carry its moments.
TEST(MidEdgeBending, ConstantCurvatureIsInEquilibrium) {
  const int nx = 6, ny = 5;
  const SheetGrid grid = sheet_grid(nx, ny, 0.3, 0.25);
  const auto is_deep = [](int v) {
    return v % (nx + 1) > 1 && v % (nx + 1) < nx - 1 && v / (nx + 1) > 1 && v / (nx + 1) < ny - 1;
  };
  BentSheet sheet(grid);
  sheet.V =
      make_mid_edge_bending({grid.rest, grid.triangles, std::vector<PlateStiffness>(grid.triangles.size(), plate(2)),
                             RestAngles::of_rest, grid.vertex_count()});
  const std::vector<double> g = gradient_of(*sheet.V, QuadraticSurface().positions(sheet));
  double border = 0;
  for (const double gi : g) border = std::max(border, std::abs(gi));
  for (int v = 0; v < grid.vertex_count(); ++v)  // forces in the plane are of second order
    EXPECT_LT(std::abs(g[3 * v + 2]), is_deep(v) ? 1e-11 * border : INFINITY) << v;
  size_t entry = 3 * static_cast<size_t>(grid.vertex_count());
  for_each_edge(sheet.uses, [&](const EdgeUse* first, const EdgeUse* last) {
    EXPECT_LT(std::abs(g[entry]), last - first == 2 ? 1e-11 * border : INFINITY);
    ++entry;
  });
}

TEST(MidEdgeBending, IgnoresRigidMotions) {
  const BentSheet sheet(curved_sheet(4, 3));
  const std::vector<double> x = sheet.shaken(0.1, 0.3);
  const auto moved = [&](std::vector<double> y) {
    const std::vector<double> all = y;
    y.resize(3 * sheet.grid.rest.size());
    y = moved_rigidly(y);
    y.insert(y.end(), all.begin() + static_cast<std::ptrdiff_t>(y.size()), all.end());
    return y;
  };
  EXPECT_NEAR(sheet.V->value(moved(x)), sheet.V->value(x), 1e-12 * sheet.V->value(x));
  EXPECT_LT(sheet.V->value(moved(sheet.with_angles(flattened(sheet.grid.rest)))), 1e-25);
  const std::vector<double> g = gradient_of(*sheet.V, x);
  Vec3d force{}, torque{};
  for (int v = 0; v < sheet.grid.vertex_count(); ++v) {
    const Vec3d f = point(g, v);
    force = force + f;
    torque = torque + cross(point(x, v), f);
  }
  EXPECT_LT(norm(force), 1e-12);
  EXPECT_LT(norm(torque), 1e-12);
}

TEST(MidEdgeBending, IgnoresOrientationOfTriangles) {
  const SheetGrid grid = curved_sheet(4, 3);
  SheetGrid turned = grid;
  for (size_t t = 0; t < turned.triangles.size(); t += 3) std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  for (const RestAngles rest_angles : {RestAngles::flat, RestAngles::of_rest}) {
    const BentSheet sheet(grid, rest_angles), other(turned, rest_angles);
    const std::vector<double> x = sheet.shaken(0.1, 0.3);
    const double V = sheet.V->value(x);
    EXPECT_NEAR(other.V->value(x), V, 1e-13 * V);
  }
}

// Two triangles with an angle at the edge (0, 1), and unused angles.
TEST(MidEdgeBending, EdgeOfHeldTriangleHasFullAngle) {
  const SheetGrid pair = {{{{0, 0, 0}}, {{1, 0, 0}}, {{0.3, 0.8, 0}}, {{0.6, -0.7, 0}}}, {{0, 1, 2}, {1, 0, 3}}};
  const BentSheet sheet(pair, RestAngles::flat, {1, 1, 1, 0});
  std::vector<double> x = sheet.with_angles(flattened(pair.rest));
  const double angle = 0.4, stiffness = 0.11 / (0.5 * 0.7);  // D l^2 / A
  x[10] = -0.7 * std::cos(angle);
  x[11] = 0.7 * std::sin(angle);
  EXPECT_NEAR(sheet.V->value(x), 0.5 * stiffness * angle * angle, 1e-14);
  EXPECT_EQ(sheet.rows, 2);
  x[12] = 0.1;  // of the edge (0, 1)
  x[17] = 0.1;  // of no edge
  EXPECT_GT(gradient_of(*sheet.V, x)[12], 0);
  EXPECT_GT(gradient_of(*sheet.V, x)[17], 0);
}

TEST(MidEdgeBending, ModifiedHessiansArePositiveSemidefinite) {
  const BentSheet sheet(curved_sheet(4, 3), RestAngles::flat);
  const std::vector<double> x = sheet.shaken(0.15, 0.3);
  const DenseHessian exact = dense_hessian(*sheet.V, x, Definiteness::exact);
  const double largest = exact.eigenvalues().maxCoeff();
  EXPECT_EQ(exact.modified, 0);
  ASSERT_LT(exact.eigenvalues().minCoeff(), -1e-3 * largest);
  const DenseHessian clamped = dense_hessian(*sheet.V, x, Definiteness::clamped);
  const DenseHessian absolute = dense_hessian(*sheet.V, x, Definiteness::absolute);
  for (const DenseHessian* H : {&clamped, &absolute}) {
    EXPECT_GT(H->eigenvalues().minCoeff(), -1e-12 * largest);
    EXPECT_GT(H->modified, 0);
  }
  EXPECT_GT((DenseHessian{clamped.H - exact.H, 0}.eigenvalues().minCoeff()), -1e-12 * largest);
  EXPECT_GT((DenseHessian{absolute.H - clamped.H, 0}.eigenvalues().minCoeff()), -1e-12 * largest);
}

// Rigid motions and their three rotations are the only motions without energy: no angle is undetermined.
TEST(MidEdgeBending, FlatSheetHasOnlyMotionsInItsPlaneAndRigidOnesFree) {
  const BentSheet sheet(sheet_grid(3, 3, 0.3, 0.2));
  const DenseHessian H = dense_hessian(*sheet.V, sheet.with_angles(flattened(sheet.grid.rest)), Definiteness::clamped);
  EXPECT_EQ(H.modified, 0);
  const Eigen::VectorXd eigenvalues = H.eigenvalues();
  const Eigen::Index free = 2 * sheet.grid.vertex_count() + 3;
  EXPECT_LT(eigenvalues[free - 1], 1e-12 * eigenvalues.maxCoeff());
  EXPECT_GT(eigenvalues[free], 1e-6 * eigenvalues.maxCoeff());
}

TEST(MidEdgeBending, CollapsedTriangleIsInfinite) {
  const BentSheet sheet(sheet_grid(2, 2, 1));
  std::vector<double> x = sheet.with_angles(flattened(sheet.grid.rest));
  for (int r = 0; r < 3; ++r) x[r] = x[12 + r];
  EXPECT_EQ(sheet.V->value(x), INFINITY);
}

TEST(MidEdgeBending, EqualBitsForAnyThreadCount) {
  const BentSheet sheet(sheet_grid(40, 30, 0.1, 0.2));
  expect_equal_bits_for_threads(*sheet.V, sheet.shaken(0.03, 0.2));
}

TEST(MidEdgeBending, WovenPlateHasMembraneModuli) {
  const PlateStiffness D = plate_stiffness(OrthotropicSheet{4e6, 1e6, 0.2, 3e5, 0.01, {0.6, 0.8}});
  EXPECT_NEAR(D.D11, 1e-6 / 12 * 4e6 / (1 - 0.2 * 0.05), 1e-12);
  EXPECT_NEAR(D.D22, 0.25 * D.D11, 1e-12);
  EXPECT_NEAR(D.D12, 0.2 * D.D22, 1e-12);
  EXPECT_NEAR(D.D33, 1e-6 / 12 * 3e5, 1e-12);
  EXPECT_EQ(D.axis[1], 0.8);
}

TEST(AngleRow, MassesAddUpToRotaryInertia) {
  const SheetGrid grid = sheet_grid(4, 3, 0.5);
  std::vector<double> mass(grid.triangles.size(), 2.0);
  double sum = 0, length = 0;
  const std::vector<EdgeUse> uses = edge_uses(grid.triangles);
  int count = 0;
  for_each_edge(uses, [&](const EdgeUse* use, const EdgeUse*) {
    length += norm(grid.rest[use->edge[1]] - grid.rest[use->edge[0]]);
    ++count;
  });
  length /= count;
  const std::vector<AngleRow> rows = make_angle_rows(grid.rest, grid.triangles, mass);
  ASSERT_EQ(static_cast<int>(rows.size()), (count + 2) / 3);
  for (size_t k = 0; k < rows.size(); ++k) sum += std::min(3, count - 3 * static_cast<int>(k)) * rows[k].mass;
  EXPECT_NEAR(sum * length * length, 2.0 * 4 * 3 * 0.25, 1e-12);
}

}  // namespace
}  // namespace aspic

#include "energy/wind.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "energy/sheet_grid_test.h"

namespace aspic {
namespace {

const WindLaw kThickAir = {.density = 1.5, .normal_coefficient = 1.1, .tangential_coefficient = 0.3};

WindField uniform_wind(const Vec3d& velocity) {
  return [velocity](const Vec3d&, double) { return velocity; };
}
Vec3d shear_wind(const Vec3d& x, double time) { return {{2 * x[1], 1 - x[0], 3 * std::sin(time) + x[2]}}; }

// Returns the force of the term, the sum of -dD/dx.
Vec3d total_force(const Energy& D, const std::vector<double>& x, const StepContext& step) {
  const std::vector<double> g = gradient_of(D, x, step);
  Vec3d force{};
  for (size_t i = 0; i < g.size(); ++i) force[static_cast<int>(i % 3)] -= g[i];
  return force;
}

std::vector<double> moved_by(std::vector<double> x, const Vec3d& u) {
  for (size_t i = 0; i < x.size(); ++i) x[i] += u[static_cast<int>(i % 3)];
  return x;
}

// Derivatives by differences with 50 digits of the potential of |w . N| and |w x N|.
TEST(Wind, MatchesIndependentDerivatives) {
  const std::vector<double> start = {0, 0, 0, 1, 0.1, 0.2, 0.3, 0.8, -0.1},
                            x = {0.1, 0.2, 0.3, 1.2, 0.4, 0.1, 0.2, 0.9, 0.5};
  const StepContext step{start, 0.25, 1};
  const auto D = make_wind({{0, 1, 2}}, kThickAir, uniform_wind({{3, -1, 2}}));
  EXPECT_NEAR(ActiveTerm(*D, step).value(x), 0.29726794012447121, 1e-15);
  const std::vector<double> g = gradient_of(*D, x, step);
  EXPECT_NEAR(g[0], -0.27977995448357396, 1e-15);
  EXPECT_NEAR(g[4], 0.18399803209002318, 1e-15);
  EXPECT_NEAR(g[8], -0.099796529086508158, 1e-15);
  const Eigen::MatrixXd H = dense_hessian(*D, x, Definiteness::exact, step).H;
  EXPECT_NEAR(H(0, 0), 0.21909793202062981, 1e-15);
  EXPECT_NEAR(H(1, 5), -0.044305428183163804, 1e-15);
  EXPECT_NEAR(H(6, 2), 0.056523959297187694, 1e-15);
}

TEST(Wind, DerivativesMatchDifferences) {
  const SheetGrid grid = sheet_grid(4, 3, 0.5, 0.2);
  const auto D = make_wind(grid.triangles, kThickAir, shear_wind);
  const std::vector<double> start = shaken_sheet(grid, 0.1), x = shaken_sheet(grid, 0.1, 8);
  expect_sheet_derivatives(*D, x, 0.1, {start, 0.02, 1});
}

TEST(Wind, IsConvex) {
  const SheetGrid grid = sheet_grid(4, 3, 0.5, 0.2);
  const auto D = make_wind(grid.triangles, kThickAir, shear_wind);
  const std::vector<double> start = shaken_sheet(grid, 0.1);
  for (unsigned seed = 8; seed < 12; ++seed) {
    const DenseHessian exact = dense_hessian(*D, shaken_sheet(grid, 0.1, seed), Definiteness::exact, {start, 0.02, 1});
    EXPECT_GT(exact.eigenvalues().minCoeff(), -1e-13 * exact.eigenvalues().maxCoeff());
    EXPECT_EQ(exact.modified, 0);
  }
}

TEST(Wind, DragOfPlateIsQuadraticInSpeed) {
  const SheetGrid grid = sheet_grid(4, 5, 0.1, 0.2);
  const std::vector<double> start = flattened(sheet_grid(4, 5, 0.1).rest);
  const double area = 4 * 5 * 0.01, h = 0.01, u = 3;
  const StepContext step{start, h, 1};
  const double across = 0.5 * kThickAir.density * kThickAir.normal_coefficient * area * u * u;
  const double along = 0.5 * kThickAir.density * kThickAir.tangential_coefficient * area * u * u;
  // The same in wind and for a plate in motion.
  for (const bool moves : {false, true}) {
    const auto force = [&](const Vec3d& w) {
      const auto D = make_wind(grid.triangles, kThickAir, uniform_wind(moves ? Vec3d{} : w));
      return total_force(*D, moved_by(start, moves ? -h * w : Vec3d{}), step);
    };
    EXPECT_NEAR(force({{0, 0, u}})[2], across, 1e-12);
    EXPECT_NEAR(force({{0, 0, -u}})[2], -across, 1e-12);
    EXPECT_NEAR(force({{0, u, 0}})[1], along, 1e-12);
    EXPECT_NEAR(force({{-u, 0, 0}})[0], -along, 1e-12);
  }
}

TEST(Wind, DragEqualsWeightAtTerminalSpeed) {
  const SheetGrid grid = sheet_grid(4, 5, 0.1);
  const std::vector<double> start = flattened(grid.rest);
  const double weight = 0.3, h = 0.01;
  const double speed = std::sqrt(2 * weight / (kThickAir.density * kThickAir.normal_coefficient * 0.2));
  const auto D = make_wind(grid.triangles, kThickAir, uniform_wind({}));
  EXPECT_NEAR(total_force(*D, moved_by(start, {{0, 0, -h * speed}}), {start, h, 1})[2], weight, 1e-12);
}

TEST(Wind, IsZeroAtRestInStillAir) {
  const SheetGrid grid = sheet_grid(4, 3, 0.5, 0.2);
  const std::vector<double> start = shaken_sheet(grid, 0.1);
  const auto D = make_wind(grid.triangles, kThickAir, uniform_wind({}));
  const StepContext step{start, 0.02, 1};
  EXPECT_EQ(ActiveTerm(*D, step).value(start), 0);
  for (const double gi : gradient_of(*D, start, step)) EXPECT_EQ(gi, 0);
  EXPECT_TRUE(dense_hessian(*D, start, Definiteness::exact, step).H.isZero(0));
}

TEST(Wind, WorkBalancesLoss) {
  const SheetGrid grid = sheet_grid(4, 3, 0.5, 0.2);
  const auto D = make_wind(grid.triangles, kThickAir, shear_wind);
  const std::vector<double> start = shaken_sheet(grid, 0.1);
  const StepContext step{start, 0.02, 1};
  const ActiveTerm term(*D, step);
  for (unsigned seed = 8; seed < 12; ++seed) {
    const std::vector<double> x = shaken_sheet(grid, 0.1, seed), g = gradient_of(*D, x, step);
    double received = 0;
    for (size_t i = 0; i < x.size(); ++i) received -= g[i] * (x[i] - start[i]);
    const WindWork work = D->work(x, term.context());
    EXPECT_GT(work.loss, 0);
    EXPECT_NEAR(work.wind - work.loss, received, 1e-13 * work.loss);
    EXPECT_NEAR(work.loss, 3 * term.value(x), 1e-13 * work.loss);
  }
}

TEST(Wind, IsConstantForceInStatics) {
  const SheetGrid grid = sheet_grid(4, 3, 0.5, 0.2);
  const auto D = make_wind(grid.triangles, kThickAir, shear_wind);
  const std::vector<double> start = shaken_sheet(grid, 0.1), x = shaken_sheet(grid, 0.1, 8);
  const StepContext still{start, 0, 1};
  EXPECT_EQ(ActiveTerm(*D, still).value(start), 0);
  const std::vector<double> g = gradient_of(*D, x, still), g_start = gradient_of(*D, start, still);
  EXPECT_EQ(g, g_start);
  const std::vector<double> in_step = gradient_of(*D, start, {start, 0.02, 1});  // at rest
  double V = 0;
  for (size_t i = 0; i < g.size(); ++i) {
    EXPECT_NEAR(g[i], in_step[i], 1e-15);
    V += g[i] * (x[i] - start[i]);
  }
  EXPECT_NEAR(ActiveTerm(*D, still).value(x), V, 1e-14);
  EXPECT_TRUE(dense_hessian(*D, x, Definiteness::exact, still).H.isZero(0));
  EXPECT_EQ(D->work(x, ActiveTerm(*D, still).context()).loss, 0);
}

TEST(Wind, IgnoresOrientationOfTriangles) {
  const SheetGrid grid = sheet_grid(4, 3, 0.5, 0.2);
  std::vector<Triangle> turned = grid.triangles;
  for (Triangle& t : turned) std::swap(t[0], t[1]);
  const std::vector<double> start = shaken_sheet(grid, 0.1), x = shaken_sheet(grid, 0.1, 8);
  const StepContext step{start, 0.02, 1};
  const double D = ActiveTerm(*make_wind(grid.triangles, kThickAir, shear_wind), step).value(x);
  EXPECT_NEAR(ActiveTerm(*make_wind(turned, kThickAir, shear_wind), step).value(x), D, 1e-13 * D);
}

TEST(Wind, CollapsedTriangleHasNoForce) {
  const std::vector<double> start(9, 0.5);
  const auto D = make_wind({{0, 1, 2}}, kThickAir, uniform_wind({{1, 2, 3}}));
  for (const double gi : gradient_of(*D, start, {start, 0.02, 1})) EXPECT_EQ(gi, 0);
}

TEST(Wind, EqualBitsForAnyThreadCount) {
  const SheetGrid grid = sheet_grid(40, 30, 0.1, 0.2);
  const std::vector<double> start = shaken_sheet(grid, 0.01);
  expect_equal_bits_for_threads(*make_wind(grid.triangles, kThickAir, shear_wind), shaken_sheet(grid, 0.01, 8),
                                {start, 0.02, 1});
}

}  // namespace
}  // namespace aspic

#include "energy/membrane.h"

#include <gtest/gtest.h>

#include <cmath>

#include "energy/membrane_law.h"
#include "energy/sheet_grid_test.h"

namespace aspic {
namespace {

const IsotropicSheet kRubber = {.young = 2, .poisson = 0.3, .thickness = 0.5};
const OrthotropicSheet kWoven = {
    .warp_young = 3, .weft_young = 1, .poisson = 0.2, .shear = 0.4, .thickness = 0.5, .warp = {0.6, 0.8}};

std::unique_ptr<Membrane> membrane_of(const SheetGrid& grid, const MembraneLaw& law) {
  std::vector<SheetTriangle> triangles;
  for (const Triangle& t : grid.triangles)
    triangles.push_back(make_sheet_triangle(t, {grid.rest[t[0]], grid.rest[t[1]], grid.rest[t[2]]}));
  return make_membrane(triangles, std::vector<MembraneLaw>(triangles.size(), law));
}

std::vector<double> stretched(const SheetGrid& grid, double along_x, double along_y) {
  std::vector<double> x = flattened(grid.rest);
  for (size_t i = 0; i < x.size(); i += 3) {
    x[i] *= along_x;
    x[i + 1] *= along_y;
  }
  return x;
}

// A skew triangle, with the derivatives of its energy by differences with 50 digits of the energy of
// F = [d1 d2 n] [D1 D2 N]^-1 (3x3).
const std::array<Vec3d, 3> kSkewRest = {{{{0, 0, 0}}, {{1, 0.1, 0.2}}, {{0.3, 0.8, -0.1}}}};
const std::vector<double> kSkewShape = {0.1, 0.2, 0.3, 1.2, 0.4, 0.1, 0.2, 0.9, 0.5};
struct Reference {
  MembraneLaw law;
  double V, g0, g4, g8, H00, H15, H62, H78;
};

TEST(Membrane, MatchesIndependentDerivatives) {
  OrthotropicSheet woven = kWoven;
  woven.warp = direction_in_plane(kSkewRest, {{1, 1, 0}});
  const Reference references[] = {
      {kRubber, 0.0084283995344810242, -0.005079595707591963, -0.015639401321571314, -0.0035024500104381672,
       0.38864912207734607, 0.01901318301203433, 0.0063960776714214569, 0.25812704786824803},
      {woven, 0.0068220082875633548, 0.020139708293857648, -0.0227634150983267, 0.0004778339835008105,
       0.37949912412555025, -0.010026693472865225, -0.015332033138676984, 0.099477918748537348}};
  for (const Reference& r : references) {
    const auto V = make_membrane({make_sheet_triangle({0, 1, 2}, kSkewRest)}, {r.law});
    EXPECT_NEAR(V->value(kSkewShape), r.V, 1e-15);
    const std::vector<double> g = gradient_of(*V, kSkewShape);
    const Eigen::MatrixXd H = dense_hessian(*V, kSkewShape, Definiteness::exact).H;
    const double found[] = {g[0], g[4], g[8], H(0, 0), H(1, 5), H(6, 2), H(7, 8)};
    const double expected[] = {r.g0, r.g4, r.g8, r.H00, r.H15, r.H62, r.H78};
    for (int k = 0; k < 7; ++k) EXPECT_NEAR(found[k], expected[k], 1e-14) << k;
  }
}

TEST(Membrane, DerivativesMatchDifferences) {
  const SheetGrid grid = sheet_grid(4, 3, 0.5, 0.2);
  for (const MembraneLaw& law : {MembraneLaw(kRubber), MembraneLaw(kWoven)})
    for (const double amount : {0.02, 0.2})
      expect_sheet_derivatives(*membrane_of(grid, law), shaken_sheet(grid, amount), 0.1);
}

MembraneLaw limited(MembraneLaw law, double from, double to) {
  std::visit([&](auto& sheet) { sheet.limit = {from, to, 3}; }, law);
  return law;
}

TEST(Membrane, LimitOfStretchesHasCorrectDerivatives) {
  const SheetGrid grid = sheet_grid(4, 3, 0.5, 0.2);
  std::vector<double> x = shaken_sheet(grid, 0.05);
  for (double& xi : x) xi *= 1.15;
  for (const MembraneLaw& law : {limited(kRubber, 1.1, 2.5), limited(kWoven, 1.1, 2.5)}) {
    const auto V = membrane_of(grid, law);
    EXPECT_TRUE(std::isfinite(V->value(x)));
    expect_sheet_derivatives(*V, x, 0.1);
    expect_sheet_derivatives(*V, stretched(grid, 1.3, 1.3), 0.1);  // equal stretches
    expect_sheet_derivatives(*V, stretched(grid, 1.3, 1.3 + 1e-6), 0.1);
    for (const Definiteness kind : {Definiteness::clamped, Definiteness::absolute})
      EXPECT_GT(dense_hessian(*V, x, kind).eigenvalues().minCoeff(), -1e-11);
  }
}

TEST(Membrane, LimitOfStretchesIsClosedForm) {
  const SheetGrid grid = sheet_grid(3, 3, 0.3, 0.2);
  const auto V = membrane_of(grid, kRubber), L = membrane_of(grid, limited(kRubber, 1.1, 1.5));
  const auto f = [](double s) { return -3 * (s - 1.1) * (s - 1.1) * std::log((1.5 - s) / 0.4); };
  const std::vector<double> free = stretched(grid, 1.09, 0.8), one = stretched(grid, 1.4, 0.8),
                            both = stretched(grid, 1.4, 1.2);
  EXPECT_EQ(L->value(free), V->value(free));
  double area = 0;
  for (const Triangle& c : grid.triangles)
    area += make_sheet_triangle(c, {grid.rest[c[0]], grid.rest[c[1]], grid.rest[c[2]]}).area;
  EXPECT_NEAR(L->value(one) - V->value(one), area * kRubber.thickness * f(1.4), 1e-13);
  EXPECT_NEAR(L->value(both) - V->value(both), area * kRubber.thickness * (f(1.4) + f(1.2)), 1e-13);
  EXPECT_EQ(L->value(stretched(grid, 1.5 + 1e-9, 1)), INFINITY);
}

TEST(Membrane, IgnoresRigidMotions) {
  const SheetGrid grid = sheet_grid(4, 3, 0.5, 0.2);
  const std::vector<double> x = shaken_sheet(grid, 0.2);
  for (const MembraneLaw& law : {MembraneLaw(kRubber), MembraneLaw(kWoven)}) {
    const auto V = membrane_of(grid, law);
    EXPECT_NEAR(V->value(moved_rigidly(x)), V->value(x), 1e-12 * V->value(x));
    EXPECT_LT(V->value(moved_rigidly(flattened(grid.rest))), 1e-14);
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
}

TEST(Membrane, ModifiedHessiansArePositiveSemidefinite) {
  const SheetGrid grid = sheet_grid(4, 3, 0.5, 0.2);
  std::vector<double> x = shaken_sheet(grid, 0.2);
  for (double& xi : x) xi *= 0.7;
  for (const MembraneLaw& law : {MembraneLaw(kRubber), MembraneLaw(kWoven)}) {
    const auto V = membrane_of(grid, law);
    const DenseHessian exact = dense_hessian(*V, x, Definiteness::exact);
    EXPECT_EQ(exact.modified, 0);
    const double largest = exact.eigenvalues().maxCoeff();
    ASSERT_LT(exact.eigenvalues().minCoeff(), -1e-3 * largest);
    for (const Definiteness kind : {Definiteness::clamped, Definiteness::absolute}) {
      const DenseHessian modified = dense_hessian(*V, x, kind);
      EXPECT_GT(modified.eigenvalues().minCoeff(), -1e-12 * largest);
      EXPECT_GT(modified.modified, 0);
    }
  }
}

TEST(Membrane, ClampedHessianOfTensionIsExact) {
  const SheetGrid grid = sheet_grid(4, 3, 0.5, 0.2);
  const std::vector<double> x = stretched(grid, 1.1, 1.2);
  for (const MembraneLaw& law : {MembraneLaw(kRubber), MembraneLaw(kWoven)}) {
    const auto V = membrane_of(grid, law);
    const DenseHessian clamped = dense_hessian(*V, x, Definiteness::clamped);
    EXPECT_EQ(clamped.modified, 0);
    EXPECT_EQ(clamped.H, dense_hessian(*V, x, Definiteness::exact).H);
  }
}

TEST(Membrane, ClampingFiltersEigenvaluesOfHessian) {
  const Vec3d f1 = {{0.7, 0.2, 0.1}}, f2 = {{-0.1, 0.4, 0.5}};
  for (const MembraneLaw& law : {MembraneLaw(kRubber), MembraneLaw(kWoven)}) {
    const SheetModuli moduli(law);
    const SheetDeformation d(f1, f2);
    const SheetFrame frame(d);
    const SheetHessian exact = moduli.hessian(d, frame);
    for (const Definiteness kind : {Definiteness::clamped, Definiteness::absolute}) {
      SheetHessian H = exact;
      EXPECT_TRUE(moduli.project(d, frame, kind, H));
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(
          Eigen::Map<const Eigen::Matrix4d>(exact.in_plane.data()));
      Eigen::Vector4d values = eigen.eigenvalues();
      for (double& l : values) l = kind == Definiteness::clamped ? std::max(l, 0.0) : std::abs(l);
      const Eigen::Matrix4d expected = eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
      EXPECT_LT((Eigen::Map<const Eigen::Matrix4d>(H.in_plane.data()) - expected).norm(), 1e-8 * expected.norm());
      EXPECT_GE(H.normal.xx, 0);
      EXPECT_GE(H.normal.xx * H.normal.yy, H.normal.xy * H.normal.xy);
    }
  }
}

TEST(Membrane, SmallUniaxialTensionHasYoungsModulus) {
  const SheetGrid grid = sheet_grid(1, 1, 1);
  const double strain = 1e-7;
  MembraneFields fields;
  membrane_of(grid, kRubber)->evaluate(stretched(grid, 1 + strain, 1 - kRubber.poisson * strain), fields);
  for (const auto& [high, low] : fields.stress) {
    EXPECT_NEAR(high / strain, kRubber.young, 1e-6);
    EXPECT_NEAR(low / strain, 0, 1e-6);
  }
  OrthotropicSheet along = kWoven, across = kWoven;
  along.warp = {1, 0};
  across.warp = {0, 1};
  const double weft_poisson = kWoven.poisson * kWoven.weft_young / kWoven.warp_young;
  membrane_of(grid, along)->evaluate(stretched(grid, 1 + strain, 1 - kWoven.poisson * strain), fields);
  EXPECT_NEAR(fields.stress[0][0] / strain, kWoven.warp_young, 1e-6);
  membrane_of(grid, across)->evaluate(stretched(grid, 1 + strain, 1 - weft_poisson * strain), fields);
  // The axes of the second triangle begin at a diagonal, so that its warp has another direction.
  EXPECT_NEAR(fields.stress[0][0] / strain, kWoven.weft_young, 1e-6);
}

TEST(Membrane, UniformStrainHasNoInnerForces) {
  const int nx = 6, ny = 5;
  const SheetGrid grid = sheet_grid(nx, ny, 0.2, 0.25);
  std::vector<double> x = stretched(grid, 1.3, 0.9);
  for (size_t i = 0; i < x.size(); i += 3) x[i] += 0.4 * x[i + 1];
  const std::vector<double> g = gradient_of(*membrane_of(grid, kRubber), moved_rigidly(x));
  double border = 0;
  for (int v = 0; v < grid.vertex_count(); ++v) {
    const double force = norm(Vec3d{{g[3 * v], g[3 * v + 1], g[3 * v + 2]}});
    if (grid.is_inner(v, nx, ny))
      EXPECT_LT(force, 1e-14);
    else
      border = std::max(border, force);
  }
  EXPECT_GT(border, 1e-2);
}

TEST(Membrane, FieldsMatchUniformStretch) {
  const SheetGrid grid = sheet_grid(3, 3, 0.3, 0.2);
  const double s1 = 1.4, s2 = 0.8, mu = kRubber.young / 2.6, la = kRubber.young * 0.3 / 0.91, L = std::log(s1 * s2);
  const std::vector<double> x = stretched(grid, s1, s2);
  const auto V = membrane_of(grid, kRubber);
  MembraneFields fields;
  V->evaluate(moved_rigidly(x), fields);
  double sum = 0;
  for (size_t t = 0; t < grid.triangles.size(); ++t) {
    EXPECT_NEAR(fields.stretch[t][0], s1, 1e-13);
    EXPECT_NEAR(fields.stretch[t][1], s2, 1e-13);
    EXPECT_NEAR(fields.stress[t][0], (mu * (s1 * s1 - 1) + la * L) / (s1 * s2), 1e-13);  // s1 psi_1 / J
    EXPECT_NEAR(fields.stress[t][1], (mu * (s2 * s2 - 1) + la * L) / (s1 * s2), 1e-13);
    const Triangle& c = grid.triangles[t];
    sum += fields.energy_density[t] * make_sheet_triangle(c, {grid.rest[c[0]], grid.rest[c[1]], grid.rest[c[2]]}).area;
  }
  EXPECT_NEAR(sum, V->value(x), 1e-13);
}

TEST(Membrane, PatternEqualsRestShapeInSpace) {
  const SheetTriangle in_space =
      make_sheet_triangle({0, 1, 2}, std::array<Vec3d, 3>{{{{1, 2, 3}}, {{1, 4, 3}}, {{1, 3, 6}}}});
  const SheetTriangle flat = make_sheet_triangle({0, 1, 2}, std::array<PlaneVector, 3>{{{5, 5}, {5, 7}, {8, 6}}});
  EXPECT_NEAR(in_space.area, 3, 1e-15);
  EXPECT_NEAR(flat.area, 3, 1e-15);
  for (const SheetTriangle& t : {in_space, flat})
    EXPECT_NEAR(make_membrane({t}, {kRubber})->value(kSkewShape), make_membrane({flat}, {kRubber})->value(kSkewShape),
                1e-14);
}

TEST(Membrane, CollapsedTriangleIsInfinite) {
  const SheetTriangle triangle = make_sheet_triangle({0, 1, 2}, kSkewRest);
  const std::vector<double> line = {0, 0, 0, 1, 0, 0, 2, 0, 0}, dot(9, 0.5), nan(9, NAN);
  for (const double poisson : {0.0, 0.3}) {
    IsotropicSheet law = kRubber;
    law.poisson = poisson;
    const auto V = make_membrane({triangle}, {law});
    for (const auto& x : {line, dot, nan}) EXPECT_EQ(V->value(x), INFINITY);
  }
  const auto V = make_membrane({triangle}, {kWoven});
  for (const auto& x : {line, dot}) {
    EXPECT_TRUE(std::isfinite(V->value(x)));
    for (const Definiteness kind : {Definiteness::exact, Definiteness::clamped})
      EXPECT_TRUE(dense_hessian(*V, x, kind).H.allFinite());
  }
  EXPECT_EQ(V->value(nan), INFINITY);
}

TEST(Membrane, EqualBitsForAnyThreadCount) {
  const SheetGrid grid = sheet_grid(40, 30, 0.1, 0.2);
  for (const MembraneLaw& law : {MembraneLaw(kRubber), MembraneLaw(kWoven)})
    expect_equal_bits_for_threads(*membrane_of(grid, law), shaken_sheet(grid, 0.03));
}

}  // namespace
}  // namespace aspic

// Terms of V on quadratic tets: derivatives, invariants, exact integrals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "base/parallel.h"
#include "dynamics/step_derivatives.h"
#include "energy/linear_load.h"
#include "energy/mass.h"
#include "energy/pressure.h"
#include "energy/quadratic_boxes_test.h"
#include "energy/stiff_energy.h"
#include "energy/tet_elasticity.h"
#include "material/list.h"
#include "math/vectors.h"
#include "mesh/generators.h"
#include "mesh/numbering.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

void expect_derivatives(Energy& V, const std::vector<double>& x, const std::string& what,
                        const StepContext& step = {}) {
  const BlockPattern pattern = bound_pattern(small(), V);
  const DerivativeReport report = check_derivatives(differentiable(ActiveTerm(V, step), pattern), x, {.length = 0.2});
  for (const DerivativeCheck* check : {&report.gradient, &report.hessian})
    EXPECT_TRUE(check->passed) << what << ": " << check->smallest_error;
}

TEST(QuadraticElasticity, DerivativesMatchDifferencesForEveryMaterial) {
  for (const ParametersOf parameters_of : kBothParameters)
    for (const MaterialInfo& info : materials()) {
      const auto V = make_tet_elasticity(info.name, small(), 0, parameters_of(small(), info));
      expect_derivatives(*V, positions(small(), kAffine, 0.02), info.name);
    }
}

// F = sum x_n grad N_n, from the barycentric coordinates l and their gradients b.
Mat3d plain_gradient(const TetMesh& mesh, int t, const std::vector<double>& x, const std::array<double, 4>& l) {
  const TetNodes nodes = nodes_of(mesh, t);
  const Mat3d B = inverse(edge_matrix(mesh, t));
  Vec3d b[4] = {};
  for (int v = 1; v < 4; ++v) {
    b[v] = {{B(v - 1, 0), B(v - 1, 1), B(v - 1, 2)}};
    b[0] = b[0] - b[v];
  }
  Mat3d F{};
  for (int n = 0; n < 10; ++n) {
    const auto [i, j] = std::pair(n < 4 ? n : kTetEdges[n - 4][0], n < 4 ? n : kTetEdges[n - 4][1]);
    const Vec3d grad = n < 4 ? (4 * l[i] - 1) * b[i] : 4 * l[i] * b[j] + 4 * l[j] * b[i];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) F(r, c) += x[3 * nodes[n] + r] * grad[c];
  }
  return F;
}

TEST(QuadraticElasticity, MatchesPlainSumOverFourPoints) {
  const std::vector<double> x = positions(small(), kAffine, 0.02);
  const double near = (5 + 3 * std::sqrt(5)) / 20, far = (5 - std::sqrt(5)) / 20;
  for_each_material([&]<class M>() {
    const auto parameters = different_parameters(small(), M::info());
    const auto V = make_tet_elasticity(M::info().name, small(), 0, parameters);
    double plain = 0, least = INFINITY;
    for (int t = 0; t < small().tet_count(); ++t)
      for (int q = 0; q < 4; ++q) {
        std::array<double, 4> l = {far, far, far, far}, corner = {0, 0, 0, 0};
        l[q] = near, corner[q] = 1;
        const Mat3d F = plain_gradient(small(), t, x, l);
        plain += volume(small(), t) / 4 * M::psi(F, M::params(parameters[t]));
        least = std::min({least, determinant(F), determinant(plain_gradient(small(), t, x, corner))});
      }
    EXPECT_NEAR(V->value(x), plain, 1e-12 * std::abs(plain)) << M::info().name;
    EXPECT_NEAR(V->min_det_F(x), least, 1e-12) << M::info().name;
  });
}

TEST(QuadraticElasticity, LeastDeterminantIsBelowInvertedInterior) {
  const TetMesh mesh = quadratic_box({1, 1, 1});
  const auto V = make_tet_elasticity("neo_hookean", mesh, 0,
                                     std::vector<MaterialParameters>(6, {lame_from_young_poisson(1, 0.3), {}}));
  int inverted = 0, proven = 0, regular = 0;
  for (int state = 1; state <= 40; ++state) {
    const std::vector<double> x = positions(mesh, kAffine, 0.005 * state);
    double sampled = INFINITY;
    for (int t = 0; t < mesh.tet_count(); ++t)
      for (int i = 0; i <= 6; ++i)
        for (int j = 0; i + j <= 6; ++j)
          for (int k = 0; i + j + k <= 6; ++k)
            sampled = std::min(
                sampled, determinant(plain_gradient(mesh, t, x, {i / 6.0, j / 6.0, k / 6.0, (6 - i - j - k) / 6.0})));
    const double least = V->min_det_F(x);
    if (sampled < 0) {
      EXPECT_LE(least, sampled + 1e-12);
    } else if (least > 0) {
      ++proven;
    }
    inverted += sampled < 0;
    regular += sampled > 0.05;
  }
  EXPECT_GT(inverted, 5);
  EXPECT_GT(proven, 5);
  EXPECT_GE(proven, regular);
}

TEST(QuadraticElasticity, AffineStateHasUniformStressAndNoInnerForces) {
  const TetMesh mesh = quadratic_box({4, 3, 3});
  const std::vector<double> x = positions(mesh, kAffine, 0);
  const std::vector<Triangle> boundary = boundary_triangles(mesh, 0, mesh.tet_count());
  std::vector<char> is_inner(mesh.rest.size(), 1);
  for (const Triangle& t : boundary)
    for (const int v : t) is_inner[v] = 0;
  for_each_material([&]<class M>() {
    MaterialParameters p{lame_from_young_poisson(1, 0.3), {}};
    for (size_t k = 0; k < M::info().extra.size(); ++k) p.extra[k] = M::info().extra[k].fallback;
    const auto V = make_tet_elasticity(M::info().name, mesh, 0, std::vector<MaterialParameters>(mesh.tet_count(), p));
    EXPECT_NEAR(V->value(x), 0.48 * M::psi(kAffine, M::params(p)), 1e-13) << M::info().name;
    std::vector<double> g(x.size(), 0.0);
    V->add_gradient(x, 1, g);
    double inner = 0;
    for (size_t v = 0; v < is_inner.size(); ++v)
      for (int r = 0; r < 3 && is_inner[v]; ++r) inner = std::max(inner, std::abs(g[3 * v + r]));
    EXPECT_LT(inner, 1e-14) << M::info().name;
  });
}

TEST(QuadraticElasticity, RigidMotionChangesNeitherEnergyNorForces) {
  const Mat3d R =
      from_columns<double>({{2. / 3, 2. / 3, 1. / 3}}, {{-2. / 3, 1. / 3, 2. / 3}}, {{1. / 3, -2. / 3, 2. / 3}});
  const auto V = make_tet_elasticity("neo_hookean_log", small(), 0,
                                     different_parameters(small(), material_info("neo_hookean_log")));
  const std::vector<double> x = positions(small(), kAffine, 0.02);
  std::vector<double> moved, g(x.size(), 0.0), g_moved(x.size(), 0.0);
  for (size_t v = 0; v < small().rest.size(); ++v) {
    const Vec3d y = R * point(x, static_cast<int>(v)) + Vec3d{{3, -2, 5}};
    moved.insert(moved.end(), y.a, y.a + 3);
  }
  EXPECT_NEAR(V->value(moved), V->value(x), 1e-13 * V->value(x));
  V->add_gradient(x, 1, g);
  V->add_gradient(moved, 1, g_moved);
  for (int v = 0; v < small().vertex_count(); ++v)
    EXPECT_LT(norm(point(g_moved, v) - R * point(g, v)), 1e-13 * max_abs(g) * 10);
}

TEST(QuadraticElasticity, AbsoluteHessianHasNoNegativeCurvature) {
  const auto V =
      make_tet_elasticity("neo_hookean", small(), 0, different_parameters(small(), material_info("neo_hookean")));
  const BlockPattern pattern = bound_pattern(small(), *V);
  const std::vector<double> x = positions(small(), kAffine, 0.3);
  BlockSparse H(pattern);
  EXPECT_GT(V->add_hessian(x, 1, {Definiteness::absolute}, H), 0);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> d(x.size()), Hd(x.size());
  for (int trial = 0; trial < 20; ++trial) {
    for (double& di : d) di = uniform(random);
    H.multiply(d, Hd);
    EXPECT_GT(dot(d, Hd), 0);
  }
}

TEST(QuadraticElasticity, BitsDoNotDependOnThreadCount) {
  const TetMesh mesh = quadratic_box({9, 7, 5});
  const std::vector<double> x = positions(mesh, kAffine, 0.01);
  std::vector<std::vector<double>> results;
  const int before = thread_count();
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    const auto V =
        make_tet_elasticity("neo_hookean", mesh, 0, different_parameters(mesh, material_info("neo_hookean")));
    const BlockPattern pattern = bound_pattern(mesh, *V);
    BlockSparse H(pattern);
    std::vector<double> sums(x.size(), 0.0);
    V->add_gradient(x, 1, sums);
    V->add_hessian(x, 1, {Definiteness::clamped}, H);
    sums.push_back(V->value(x));
    for (const Mat3d& block : H.block) sums.insert(sums.end(), block.a, block.a + 9);
    results.push_back(sums);
  }
  set_thread_count(before);
  EXPECT_EQ(results[1], results[0]);
  EXPECT_EQ(results[2], results[0]);
}

TEST(NodeBarrier, AddsItsFormulaBelowOneTenth) {
  const std::vector<MaterialParameters> parameters = different_parameters(small(), material_info(kBarrier));
  const auto V = make_tet_elasticity(kBarrier, small(), 0, parameters);
  const double near = (5 + 3 * std::sqrt(5)) / 20, far = (5 - std::sqrt(5)) / 20;
  const std::vector<double> x = positions(small(), kFlat, 0.002);
  double expected = 0, barrier = 0;
  for (int t = 0; t < small().tet_count(); ++t) {
    const double V_t = volume(small(), t);
    for (int q = 0; q < 4; ++q) {
      std::array<double, 4> l = {far, far, far, far};
      l[q] = near;
      expected += V_t / 4 * NeoHookeanLog::psi(plain_gradient(small(), t, x, l), NeoHookeanLog::params(parameters[t]));
    }
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j <= i; ++j) {
        std::array<double, 4> node = {0, 0, 0, 0};
        node[i] += 0.5, node[j] += 0.5;
        const double ratio = 10 * determinant(plain_gradient(small(), t, x, node));
        if (ratio < 1) barrier -= V_t / 10 * parameters[t].lame.mu / 10 * std::pow(ratio - 1, 2) * std::log(ratio);
      }
  }
  EXPECT_GT(barrier, 1e-6 * expected);
  EXPECT_NEAR(V->value(x), expected + barrier, 1e-13 * expected);
}

TEST(NodeBarrier, DerivativesMatchDifferences) {
  const auto V = make_tet_elasticity(kBarrier, small(), 0, different_parameters(small(), material_info(kBarrier)));
  expect_derivatives(*V, positions(small(), kFlat, 0.002), kBarrier);
}

// A node at less than a quarter of its edge inverts a corner, but no quadrature point.
TEST(NodeBarrier, InvertedCornersHaveInfiniteEnergy) {
  const TetMesh& mesh = small();
  std::vector<double> x = positions(mesh, identity3<double>(), 0);
  const Vec3d &a = mesh.rest[mesh.tets[0][0]], &b = mesh.rest[mesh.tets[0][1]];
  for (const double part : {0.27, 0.24}) {
    set_vec(a + part * (b - a), mesh.mids[0][0], x);
    for (const MaterialInfo& info : materials()) {
      if (info.name == "fung" || info.name == "gent") continue;  // limited strains
      const auto V = make_tet_elasticity(info.name, mesh, 0, different_parameters(mesh, info));
      EXPECT_EQ(std::isfinite(V->value(x)), part > 0.25 || !info.barrier) << info.name << " " << part;
    }
  }
}

// A map with J = (1 - 5 X) (0.4 - X): positive at all nodes and quadrature points, negative between them.
TEST(NodeBarrier, InversionBetweenNodesIsFound) {
  const Vec3d corners[] = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
  const TetMesh mesh = raise_order({{std::begin(corners), std::end(corners)}, {{0, 1, 2, 3}}, {}});
  std::vector<double> x(3 * mesh.rest.size());
  for (size_t v = 0; v < mesh.rest.size(); ++v) {
    const Vec3d& X = mesh.rest[v];
    set_vec({{X[0] - 2.5 * X[0] * X[0], X[1] * (0.4 - X[0]), X[2]}}, static_cast<int>(v), x);
  }
  const auto V = make_tet_elasticity(kBarrier, mesh, 0, different_parameters(mesh, material_info(kBarrier)));
  EXPECT_TRUE(std::isfinite(V->value(x)));
  EXPECT_LE(V->min_det_F(x), -0.05);  // at X = 0.3
  EXPECT_TRUE(V->excludes_inversion());
}

double mean_J(const TetMesh& mesh, int t, const std::vector<double>& x) {
  const double near = (5 + 3 * std::sqrt(5)) / 20, far = (5 - std::sqrt(5)) / 20;
  double J = 0;
  for (int q = 0; q < 4; ++q) {
    std::array<double, 4> l = {far, far, far, far};
    l[q] = near;
    J += determinant(plain_gradient(mesh, t, x, l)) / 4;
  }
  return J;
}

TEST(MeanVolume, AddsBulkEnergyOfMeanJ) {
  const MaterialInfo& info = material_info("neo_hookean");
  const std::vector<MaterialParameters> parameters = nearly_incompressible(small(), info);
  std::vector<MaterialParameters> pointwise = parameters;
  for (MaterialParameters& p : pointwise) p.lame.lambda = std::min(p.lame.lambda, 1.5 * p.lame.mu);
  const auto V = make_tet_elasticity(info.name, small(), 0, parameters);
  const std::vector<double> x = positions(small(), kAffine, 0.02);
  double expected = make_tet_elasticity(info.name, small(), 0, pointwise)->value(x);
  for (int t = 0; t < small().tet_count(); ++t) {
    const double bulk = parameters[t].lame.lambda - pointwise[t].lame.lambda, J = mean_J(small(), t, x);
    expected += volume(small(), t) * bulk / 2 * (J - 1) * (J - 1);
  }
  EXPECT_NEAR(V->value(x), expected, 1e-12 * expected);
}

// A fit that crosses the threshold has no jump of forces.
TEST(MeanVolume, IsContinuousInPoissonsRatio) {
  const std::vector<double> x = positions(small(), kAffine, 0.02);
  const auto gradient = [&](double poisson) {
    const std::vector<MaterialParameters> one(small().tets.size(), {lame_from_young_poisson(1e5, poisson), {}});
    const auto V = make_tet_elasticity("neo_hookean", small(), 0, one);
    std::vector<double> g(x.size(), 0.0);
    V->add_gradient(x, 1, g);
    return std::pair(V->value(x), g);
  };
  for (const double poisson : {0.3, 0.45}) {
    const auto [below, below_g] = gradient(poisson - 1e-9);
    const auto [above, above_g] = gradient(poisson + 1e-9);
    EXPECT_NEAR(above / below, 1, 1e-6) << poisson;
    for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(above_g[i], below_g[i], 1e-6 * max_abs(below_g)) << poisson;
  }
}

// A fit with an initial guess below the threshold ends with the energy of its result.
TEST(MeanVolume, DependsOnCurrentPoissonsRatioAlone) {
  const std::vector<double> x = positions(small(), kAffine, 0.02);
  const auto parameters = [](double poisson) {
    return std::vector<MaterialParameters>(small().tets.size(), {lame_from_young_poisson(1e5, poisson), {}});
  };
  for (const double final_poisson : {0.2, 0.45}) {
    const auto expected = make_tet_elasticity("neo_hookean", small(), 0, parameters(final_poisson));
    const auto changed = make_tet_elasticity("neo_hookean", small(), 0, parameters(0.65 - final_poisson));
    changed->set_parameters(parameters(final_poisson));
    EXPECT_DOUBLE_EQ(changed->value(x), expected->value(x)) << final_poisson;
    std::vector<double> g(x.size(), 0.0), expected_g(x.size(), 0.0);
    changed->add_gradient(x, 1, g);
    expected->add_gradient(x, 1, expected_g);
    for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(g[i], expected_g[i], 1e-12 * max_abs(expected_g));
    const BlockPattern pattern = bound_pattern(small(), *changed);
    expected->bind(pattern);
    BlockSparse H(pattern), expected_H(pattern);
    changed->add_hessian(x, 1, {Definiteness::exact}, H);
    expected->add_hessian(x, 1, {Definiteness::exact}, expected_H);
    std::vector<double> Hx(x.size()), expected_Hx(x.size());
    H.multiply(x, Hx), expected_H.multiply(x, expected_Hx);
    for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(Hx[i], expected_Hx[i], 1e-12 * max_abs(expected_Hx));
  }
}

TEST(MeanVolume, StiffRowsArePartOfHessian) {
  const auto V =
      make_tet_elasticity("neo_hookean", small(), 0, nearly_incompressible(small(), material_info("neo_hookean")));
  const auto* stiff = dynamic_cast<const StiffEnergy*>(V.get());
  ASSERT_TRUE(stiff);
  const BlockPattern pattern = bound_pattern(small(), *V);
  const std::vector<double> x = positions(small(), identity3<double>(), 0);  // without pressure
  StiffRows rows;
  stiff->add_stiff_rows(x, 2, rows);
  EXPECT_EQ(rows.size(), 27u) << "a quarter of the 36 tets is compressible";
  BlockSparse H(pattern), shape(pattern);
  std::vector<MaterialParameters> pointwise = V->parameters();
  for (MaterialParameters& p : pointwise) p.lame.lambda = std::min(p.lame.lambda, 1.5 * p.lame.mu);
  const auto V_shape = make_tet_elasticity("neo_hookean", small(), 0, pointwise);
  V_shape->bind(pattern);
  V->add_hessian(x, 2, {Definiteness::exact}, H);
  V_shape->add_hessian(x, 2, {Definiteness::exact}, shape);
  const std::vector<double> d = positions(small(), kAffine, 0.5);
  std::vector<double> Hd(d.size()), shape_d(d.size());
  H.multiply(d, Hd), shape.multiply(d, shape_d);
  double expected = dot(d, shape_d);
  for (const StiffRow& row : rows) {
    double along = 0;
    for (size_t n = 0; n < row.vertex.size(); ++n) along += dot(row.g[n], point(d, row.vertex[n]));
    expected += row.weight * along * along;
  }
  EXPECT_NEAR(dot(d, Hd), expected, 1e-12 * expected);
}

// A Newton step linearizes the pressure; the next Hessian uses it in place of K (mean J - 1).
TEST(MeanVolume, HessianUsesPressureOfNewtonStep) {
  const auto V =
      make_tet_elasticity("neo_hookean", small(), 0, nearly_incompressible(small(), material_info("neo_hookean")));
  const BlockPattern pattern = bound_pattern(small(), *V);
  ActiveTerm term(*V, {});
  const std::vector<double> x = positions(small(), kAffine, 0.02);
  const std::vector<double> still(x.size(), 0.0);
  const auto hessian = [&] {
    BlockSparse H(pattern);
    term.add_hessian(x, 1, {Definiteness::exact}, H);
    std::vector<double> entries;
    for (const Mat3d& block : H.block) entries.insert(entries.end(), block.a, block.a + 9);
    return entries;
  };
  const std::vector<double> exact = hessian();
  const auto expect_exact = [&] {
    const std::vector<double> now = hessian();
    for (size_t i = 0; i < now.size(); ++i) ASSERT_NEAR(now[i], exact[i], 1e-12 * max_abs(exact));
  };
  term.note_newton_step(x, still, 1);
  expect_exact();  // no step: the same pressure
  term.note_newton_step(x, positions(small(), kAffine, 0), 1);
  EXPECT_NE(hessian(), exact);
  term.begin_step({});
  EXPECT_EQ(hessian(), exact);
}

TEST(QuadraticDamping, DerivativesMatchDifferences) {
  const auto D = make_strain_rate_damping(small(), 0, std::vector<double>(small().tet_count(), 0.7));
  const std::vector<double> start = positions(small(), identity3<double>(), 0.01);
  expect_derivatives(*D, positions(small(), kAffine, 0.02), "strain_rate_damping", {.start = start, .h = 0.1});
}

// Values of X^a Y^b Z^c at the nodes, along each axis; its integral over the box.
std::vector<double> monomial(const TetMesh& mesh, const std::array<int, 3>& power) {
  std::vector<double> values;
  for (const Vec3d& X : mesh.rest)
    values.insert(values.end(), 3, std::pow(X[0], power[0]) * std::pow(X[1], power[1]) * std::pow(X[2], power[2]));
  return values;
}
double integral(const std::array<int, 3>& power) {
  double product = 1;
  for (int r = 0; r < 3; ++r) product *= std::pow(kSize[r], power[r] + 1) / (power[r] + 1);
  return product;
}

TEST(QuadraticMass, IntegratesQuadraticFieldsExactly) {
  const std::vector<double> density(small().tet_count(), 3.0);
  const MassMatrix mass(small(), density, MassKind::consistent);
  std::vector<double> product(3 * small().rest.size());
  for (const auto& [a, b] : {std::pair<std::array<int, 3>, std::array<int, 3>>{{2, 0, 0}, {2, 0, 0}},
                             {{1, 1, 0}, {0, 0, 2}},
                             {{0, 0, 0}, {0, 1, 1}}}) {
    mass.multiply(monomial(small(), a), product);
    EXPECT_NEAR(dot(monomial(small(), b), product), 9 * integral({a[0] + b[0], a[1] + b[1], a[2] + b[2]}), 1e-13);
  }
  const std::vector<double> one = monomial(small(), {0, 0, 0});
  mass.multiply(one, product);
  for (int v = 0; v < small().vertex_count(); ++v) EXPECT_NEAR(mass.row_sums()[v], product[3 * v], 1e-15);
}

TEST(QuadraticMass, LumpedMassesArePositiveAndSumToTotal) {
  const std::vector<double> density(small().tet_count(), 3.0);
  for (const MassKind kind : {MassKind::consistent, MassKind::lumped}) {
    const MassMatrix mass(small(), density, kind);
    EXPECT_GT(*std::min_element(mass.vertex_mass().begin(), mass.vertex_mass().end()), 0);
    EXPECT_NEAR(mass.total(), 3 * 0.48, 1e-13);
    EXPECT_NEAR(std::accumulate(mass.row_sums().begin(), mass.row_sums().end(), 0.0), 3 * 0.48, 1e-13);
  }
}

TEST(QuadraticLoads, WorkOnQuadraticDisplacementIsExact) {
  const std::vector<double> u = monomial(small(), {2, 0, 0});
  std::vector<double> force(u.size(), 0.0);
  for (int t = 0; t < small().tet_count(); ++t) add_body_force(small(), t, {{1, 0, 0}}, force);
  EXPECT_NEAR(dot(force, u), integral({2, 0, 0}), 1e-14);
  std::fill(force.begin(), force.end(), 0.0);
  for (const Face& face : boundary_faces(small(), 0, small().tet_count()))
    if (std::all_of(face.corners.begin(), face.corners.end(), [](int v) { return small().rest[v][2] > 0.6 - 1e-9; }))
      add_traction(small().rest, face, {{0, 1, 0}}, force);
  EXPECT_NEAR(dot(force, u), 0.8 / 3, 1e-14);  // int X^2 over the top
}

TEST(QuadraticPressure, DerivativesMatchDifferences) {
  std::vector<Face> top;
  for (const Face& face : boundary_faces(small(), 0, small().tet_count()))
    if (std::all_of(face.corners.begin(), face.corners.end(), [](int v) { return small().rest[v][2] > 0.6 - 1e-9; }))
      top.push_back(face);
  const auto V = make_pressure(small(), top, 3);
  expect_derivatives(*V, positions(small(), kAffine, 0.05), "pressure");
}

TEST(QuadraticPressure, SweepsVolumeChangeOfClosedSurface) {
  const auto V = make_pressure(small(), boundary_faces(small(), 0, small().tet_count()), 3);
  EXPECT_NEAR(V->value(positions(small(), kAffine, 0)), 3 * 0.48 * (determinant(kAffine) - 1), 1e-14);
  const std::vector<double> x = positions(small(), kAffine, 0.05);
  std::vector<double> g(x.size(), 0.0);
  V->add_gradient(x, 1, g);
  Vec3d force{}, torque{};
  for (int v = 0; v < small().vertex_count(); ++v)
    force = force + point(g, v), torque = torque + cross(point(x, v), point(g, v));
  EXPECT_LT(norm(force), 1e-14);
  EXPECT_LT(norm(torque), 1e-14);
  // X -> X + c X^2 along x is a quadratic map with the volume change c X^2 Y Z of the box.
  std::vector<double> bent;
  for (const Vec3d& X : small().rest) bent.insert(bent.end(), {X[0] + 0.2 * X[0] * X[0], X[1], X[2]});
  EXPECT_NEAR(V->value(bent), 3 * 0.2 * 0.48, 1e-14);
}

}  // namespace
}  // namespace aspic

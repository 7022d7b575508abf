// All terms of V: derivatives, invariants, definiteness.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "base/parallel.h"
#include "dynamics/step_derivatives.h"
#include "energy/grab_spring.h"
#include "energy/linear_load.h"
#include "energy/mass.h"
#include "energy/rayleigh_damping.h"
#include "energy/springs.h"
#include "energy/tet_elasticity.h"
#include "mesh/generators.h"
#include "mesh/surface.h"

namespace aspic {
namespace {

const TetMesh& small_mesh() {
  static const TetMesh box = make_box({{0, 0, 0}}, {{1, 0.8, 0.6}}, {3, 2, 2});  // 72 tets: no multiple of 7 lanes
  return box;
}

std::vector<MaterialParameters> heterogeneous_parameters(const MaterialInfo& info) {
  std::vector<MaterialParameters> parameters;
  for (int t = 0; t < small_mesh().tet_count(); ++t) {
    MaterialParameters p{lame_from_young_poisson(1 + 0.1 * t, 0.1 + 0.004 * t), {}};
    for (size_t k = 0; k < info.extra.size(); ++k) p.extra[k] = info.extra[k].fallback;
    parameters.push_back(p);
  }
  return parameters;
}

std::vector<double> deformed(double amount, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  std::vector<double> x;
  for (const Vec3d& X : small_mesh().rest)
    for (int r = 0; r < 3; ++r) x.push_back((1 + 0.1 * r) * X[r] + 0.2 * X[(r + 1) % 3] + uniform(random));
  return x;
}

BlockPattern pattern_of(Energy& V) {
  Couplings couplings;
  V.add_couplings(couplings);
  const BlockPattern pattern = make_pattern(small_mesh().vertex_count(), couplings);
  V.bind(pattern);
  return pattern;
}

// The length scale is that of the tets, about a third of the box.
void expect_consistent(const ActiveTerm& V, const BlockPattern& pattern, const std::vector<double>& x,
                       const std::string& what) {
  std::vector<double> g(x.size());
  V.add_gradient(x, 1, g);
  EXPECT_TRUE(std::any_of(g.begin(), g.end(), [](double gi) { return gi != 0; })) << what << " has a zero gradient";
  const DerivativeReport report = check_derivatives(differentiable(V, pattern), x, {.length = 0.3});
  for (const DerivativeCheck* check : {&report.gradient, &report.hessian}) {
    EXPECT_TRUE(check->passed) << what << ", " << entry_name(check->row) << ": " << check->smallest_error;
    EXPECT_TRUE(std::isnan(check->order) || std::abs(check->order - 2) < 0.2) << what << ": " << check->order;
  }
}

void expect_consistent(Energy& V, const std::vector<double>& x, const std::string& what, const StepContext& step = {}) {
  const BlockPattern pattern = pattern_of(V);
  expect_consistent(ActiveTerm(V, step), pattern, x, what);
}

TEST(TetElasticity, DerivativesMatchDifferencesForEveryMaterial) {
  for (const MaterialInfo& info : materials()) {
    auto V = make_tet_elasticity(info.name, small_mesh(), 0, heterogeneous_parameters(info));
    expect_consistent(*V, deformed(0.03), info.name);
  }
}

TEST(GrabSpring, DerivativesMatchDifferences) {
  GrabSpring V;
  V.set({.vertices = small_mesh().tets[5], .weights = {0.1, -0.2, 0.6, 0.5}, .stiffness = 30, .to = {{1, 2, 3}}});
  const auto tets =
      make_tet_elasticity("neo_hookean", small_mesh(), 0, heterogeneous_parameters(material_info("neo_hookean")));
  Couplings couplings;  // the spring uses the couplings of its tet
  tets->add_couplings(couplings);
  const BlockPattern pattern = make_pattern(small_mesh().vertex_count(), couplings);
  V.bind(pattern);
  const std::vector<double> x = deformed(0.03);
  const DerivativeReport report = check_derivatives(differentiable(ActiveTerm(V), pattern), x, {.length = 0.3});
  EXPECT_TRUE(report.gradient.passed) << report.gradient.smallest_error;
  EXPECT_TRUE(report.hessian.passed) << report.hessian.smallest_error;
}

TEST(GrabSpring, TargetMovesLinearlyWithinTheStep) {
  const Grab grab{.stiffness = 1, .from = {{0, 0, 0}}, .to = {{2, 4, 8}}, .from_time = 1, .to_time = 3};
  EXPECT_EQ(grab.target(0)[1], 0);
  EXPECT_EQ(grab.target(1.5)[1], 1);
  EXPECT_EQ(grab.target(3)[2], 8);
  EXPECT_EQ(grab.target(9)[2], 8);
}

TEST(GrabSpring, IsZeroWithoutStiffness) {
  GrabSpring V;
  const std::vector<double> x = deformed(0.03);
  std::vector<double> g(x.size());
  ActiveTerm(V).add_gradient(x, 1, g);
  EXPECT_EQ(ActiveTerm(V).value(x), 0);
  EXPECT_EQ(std::count(g.begin(), g.end(), 0.0), static_cast<std::ptrdiff_t>(g.size()));
}

TEST(TetElasticity, InternalForcesSumToZeroForEveryMaterial) {
  for (const MaterialInfo& info : materials()) {
    const auto V = make_tet_elasticity(info.name, small_mesh(), 0, heterogeneous_parameters(info));
    std::vector<double> g(3 * small_mesh().rest.size());
    V->add_gradient(deformed(0.03), 1, g);
    double sum[3] = {0, 0, 0}, largest = 0;
    for (size_t i = 0; i < g.size(); ++i) sum[i % 3] += g[i], largest = std::max(largest, std::abs(g[i]));
    for (const double s : sum) EXPECT_LT(std::abs(s), 1e-13 * largest * small_mesh().rest.size()) << info.name;
  }
}

TEST(TetElasticity, EnergyIgnoresRenumberingAndMirroring) {
  const MaterialInfo& info = material_info("neo_hookean_log");
  const auto parameters = heterogeneous_parameters(info);
  const std::vector<double> x = deformed(0.02);
  const double V = make_tet_elasticity(info.name, small_mesh(), 0, parameters)->value(x);

  TetMesh shuffled = small_mesh();
  std::vector<double> moved(x.size());
  const int n = shuffled.vertex_count();
  for (int v = 0; v < n; ++v) {
    shuffled.rest[(7 * v + 3) % n] = small_mesh().rest[v];  // 7 does not divide n = 36
    for (int r = 0; r < 3; ++r) moved[3 * ((7 * v + 3) % n) + r] = x[3 * v + r];
  }
  for (Tet& tet : shuffled.tets)
    for (int& v : tet) v = (7 * v + 3) % n;
  EXPECT_NEAR(make_tet_elasticity(info.name, shuffled, 0, parameters)->value(moved), V, 1e-12 * V);

  TetMesh mirrored = small_mesh();
  std::vector<double> reflected = x;
  for (Vec3d& X : mirrored.rest) X[0] = -X[0];
  for (Tet& tet : mirrored.tets) std::swap(tet[0], tet[1]);
  for (size_t i = 0; i < reflected.size(); i += 3) reflected[i] = -reflected[i];
  EXPECT_NEAR(make_tet_elasticity(info.name, mirrored, 0, parameters)->value(reflected), V, 1e-12 * V);
}

TEST(TetElasticity, BarrierMaterialIsInfiniteForInvertedTets) {
  const MaterialInfo& info = material_info("neo_hookean_log");
  const auto V = make_tet_elasticity(info.name, small_mesh(), 0, heterogeneous_parameters(info));
  std::vector<double> x = deformed(0);
  for (size_t i = 0; i < x.size(); i += 3) x[i] = -x[i];
  EXPECT_EQ(V->value(x), INFINITY);
  EXPECT_LT(V->min_det_F(x), 0);
}

Eigen::VectorXd eigenvalues(TetElasticity& V, const std::vector<double>& x, Definiteness definiteness) {
  Couplings couplings;
  V.add_couplings(couplings);
  const BlockPattern pattern = make_pattern(static_cast<int>(x.size() / 3), couplings);
  V.bind(pattern);
  BlockSparse H(pattern);
  V.add_hessian(x, 1, {definiteness}, H);
  Eigen::MatrixXd dense(x.size(), x.size());
  std::vector<double> e(x.size(), 0.0), column(x.size());
  for (size_t j = 0; j < x.size(); ++j) {
    e[j] = 1;
    H.multiply(e, column);
    e[j] = 0;
    dense.col(j) = Eigen::Map<Eigen::VectorXd>(column.data(), column.size());
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues();
}

TEST(TetElasticity, ModifiedHessiansArePositiveSemidefinite) {
  std::vector<double> x = deformed(0.25);
  for (double& xi : x) xi *= 0.5;  // compressed
  for (const MaterialInfo& info : materials()) {
    if (info.barrier || info.name == "linear") continue;  // a barrier is infinite there; linear is always definite
    const auto V = make_tet_elasticity(info.name, small_mesh(), 0, heterogeneous_parameters(info));
    const Eigen::VectorXd exact = eigenvalues(*V, x, Definiteness::exact);
    ASSERT_LT(exact.minCoeff(), -1e-3 * exact.maxCoeff()) << info.name << ": the state is not indefinite";
    for (const Definiteness definiteness : {Definiteness::clamped, Definiteness::absolute}) {
      const Eigen::VectorXd projected = eigenvalues(*V, x, definiteness);
      EXPECT_GT(projected.minCoeff(), -1e-10 * projected.maxCoeff()) << info.name;
    }
  }
}

TEST(TetElasticity, ClampedHessianOfDefiniteStateIsExact) {
  for (const MaterialInfo& info : materials()) {
    const auto V = make_tet_elasticity(info.name, small_mesh(), 0, heterogeneous_parameters(info));
    std::vector<double> rest;
    for (const Vec3d& X : small_mesh().rest) rest.insert(rest.end(), {X[0], X[1], X[2]});
    EXPECT_LT((eigenvalues(*V, rest, Definiteness::exact) - eigenvalues(*V, rest, Definiteness::clamped)).norm(), 1e-7)
        << info.name;
  }
}

TEST(StrainRateDamping, DerivativesMatchDissipationAndRotationIsFree) {
  auto D = make_strain_rate_damping(small_mesh(), 0, std::vector<double>(small_mesh().tet_count(), 2.0));
  const std::vector<double> start = deformed(0.02);
  const StepContext step{start, 0.1, 0.1};
  expect_consistent(*D, deformed(0.05, 9), "strain rate", step);
  const ActiveTerm term(*D, step);
  std::vector<double> turned = start;
  for (size_t i = 0; i < turned.size(); i += 3) {
    turned[i] = 0.6 * start[i] - 0.8 * start[i + 1] + 2;
    turned[i + 1] = 0.8 * start[i] + 0.6 * start[i + 1];
  }
  EXPECT_LT(term.value(turned), 1e-25);
  EXPECT_GT(term.value(deformed(0.05, 9)), 1e-6);
}

TEST(RayleighDamping, DerivativesMatchDifferences) {
  MassMatrix mass(small_mesh(), std::vector<double>(small_mesh().tet_count(), 3.0), MassKind::consistent);
  const MaterialInfo& info = material_info("neo_hookean");
  const auto V = make_tet_elasticity(info.name, small_mesh(), 0, heterogeneous_parameters(info));
  auto D = make_rayleigh_damping(mass, 0.3, V.get(), 0.2);
  const BlockPattern pattern = pattern_of(*D);
  V->bind(pattern);
  const std::vector<double> start = deformed(0.02);
  expect_consistent({*D, {start, 0.1, 0.1}}, pattern, deformed(0.05, 9), "Rayleigh");
}

TEST(Springs, DerivativesMatchDifferences) {
  auto edges = make_springs("edges", edge_springs(small_mesh(), 0, small_mesh().tet_count(), 4));
  expect_consistent(*edges, deformed(0.05), "edge springs");
  auto points = make_point_springs("points", {{4, 2.5, [](double t) { return Vec3d{{t, 1, 2}}; }}});
  const StepContext step{{}, 0.1, 0.7};
  expect_consistent(*points, deformed(0.05), "point springs", step);
  std::vector<double> x(3 * small_mesh().rest.size(), 0.0);
  EXPECT_NEAR(ActiveTerm(*points, step).value(x), 2.5 / 2 * (0.49 + 1 + 4), 1e-14);
}

TEST(Springs, AreRelaxedAtRestAndOnePerEdge) {
  const std::vector<Spring> springs = edge_springs(small_mesh(), 0, small_mesh().tet_count(), 4);
  std::vector<double> rest;
  for (const Vec3d& X : small_mesh().rest) rest.insert(rest.end(), {X[0], X[1], X[2]});
  EXPECT_NEAR(ActiveTerm(*make_springs("edges", springs)).value(rest), 0, 1e-25);
  // Euler's formula for a ball: V - E + F - T = 1, with 2 F = 4 T + boundary faces.
  const int tets = small_mesh().tet_count();
  const int boundary = static_cast<int>(boundary_triangles(small_mesh(), 0, tets).size());
  EXPECT_EQ(static_cast<int>(springs.size()), small_mesh().vertex_count() + (4 * tets + boundary) / 2 - tets - 1);
}

TEST(LinearLoad, GravityOfBodyIsItsWeight) {
  std::vector<double> force(3 * small_mesh().rest.size(), 0.0);
  for (int t = 0; t < small_mesh().tet_count(); ++t) add_body_force(small_mesh(), t, {{0, -2, 0}}, force);
  double sum = 0;
  for (size_t i = 1; i < force.size(); i += 3) sum += force[i];
  EXPECT_NEAR(sum, -2 * 1 * 0.8 * 0.6, 1e-14);
  auto load = make_linear_load("weight", force);
  expect_consistent(*load, deformed(0.05), "load");
}

TEST(LinearLoad, PressureOnClosedSurfaceHasNoResultant) {
  const auto load = make_dead_pressure(small_mesh(), boundary_faces(small_mesh(), 0, small_mesh().tet_count()), 1);
  std::vector<double> force(3 * small_mesh().rest.size(), 0.0);
  load->add_gradient(force, {}, 1, force);
  double sum[3] = {0, 0, 0};
  for (size_t i = 0; i < force.size(); ++i) sum[i % 3] += force[i];
  for (const double s : sum) EXPECT_NEAR(s, 0, 1e-14);
}

TEST(MassMatrix, ConsistentAndLumpedHaveEqualMassAndMomentum) {
  const std::vector<double> density(small_mesh().tet_count(), 5.0);
  const MassMatrix consistent(small_mesh(), density, MassKind::consistent),
      lumped(small_mesh(), density, MassKind::lumped);
  EXPECT_NEAR(consistent.total(), 5 * 0.48, 1e-13);
  const std::vector<double> ones(3 * small_mesh().rest.size(), 1.0);
  std::vector<double> a(ones.size()), b(ones.size());
  consistent.multiply(ones, a);
  lumped.multiply(ones, b);
  for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-14);
}

TEST(MassMatrix, ConsistentIntegratesSquaresOfLinearFieldsExactly) {
  const MassMatrix mass(small_mesh(), std::vector<double>(small_mesh().tet_count(), 1.0), MassKind::consistent);
  std::vector<double> x(3 * small_mesh().rest.size(), 0.0), Mx(x.size());
  for (int v = 0; v < small_mesh().vertex_count(); ++v) x[3 * v] = small_mesh().rest[v][0];
  mass.multiply(x, Mx);
  double integral = 0;
  for (size_t i = 0; i < x.size(); ++i) integral += x[i] * Mx[i];
  EXPECT_NEAR(integral, 0.8 * 0.6 / 3, 1e-14);  // integral of X^2 over [0, 1] x [0, .8] x [0, .6]
}

TEST(MassMatrix, DistanceMatchesProduct) {
  for (const MassKind kind : {MassKind::consistent, MassKind::lumped}) {
    const MassMatrix mass(small_mesh(), std::vector<double>(small_mesh().tet_count(), 2.0), kind);
    const std::vector<double> x = deformed(0.1), y = deformed(0.1, 5);
    std::vector<double> d(x.size()), Md(x.size());
    for (size_t i = 0; i < x.size(); ++i) d[i] = x[i] - y[i];
    mass.multiply(d, Md);
    const double expected = std::inner_product(d.begin(), d.end(), Md.begin(), 0.0);
    EXPECT_NEAR(mass.squared_distance(x, y), expected, 1e-13 * expected);
    EXPECT_EQ(mass.squared_distance(x, x), 0);
  }
}

TEST(MassMatrix, AddToMatrixIsSameOperator) {
  MassMatrix mass(small_mesh(), std::vector<double>(small_mesh().tet_count(), 1.0), MassKind::consistent);
  Couplings couplings;
  mass.add_couplings(couplings);
  const BlockPattern pattern = make_pattern(small_mesh().vertex_count(), couplings);
  mass.bind(pattern);
  BlockSparse H(pattern);
  mass.add_to(2, H);
  const std::vector<double> x = deformed(0.1);
  std::vector<double> Mx(x.size()), Hx(x.size());
  mass.multiply(x, Mx);
  H.multiply(x, Hx);
  for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(Hx[i], 2 * Mx[i], 1e-15);
  mass.assign_to(3, H);
  H.multiply(x, Hx);
  for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(Hx[i], 3 * Mx[i], 1e-15);
}

}  // namespace
}  // namespace aspic

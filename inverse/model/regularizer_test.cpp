#include "model/regularizer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "base/error.h"
#include "mesh/generators.h"
#include "model/field_roughness.h"
#include "optimize/derivative_check.h"

namespace aspic {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> noise(size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> v(n);
  for (double& x : v) x = uniform(random);
  return v;
}

TetMesh box(int cells, double size = 1) { return make_box({{0, 0, 0}}, {{size, size, size}}, {cells, cells, cells}); }

template <class Function>
std::vector<double> field(const TetMesh& mesh, const Function& f) {
  std::vector<double> z;
  for (const auto& [a, b, c, d] : mesh.tets)
    z.push_back(f(0.25 * (mesh.rest[a] + mesh.rest[b] + mesh.rest[c] + mesh.rest[d])));
  return z;
}

ParameterMap map_of(const TetMesh& mesh, std::vector<FitParameter> parameters) {
  return ParameterMap(mesh, "fung",
                      std::vector<MaterialParameters>(mesh.tets.size(), {lame_from_young_poisson(1e5, 0.3), {1}}),
                      std::move(parameters));
}

// z = g.X has L^2 / (2 V) int |g|^2 = |g|^2 / 2 in the unit cube. Surface faces have no neighbors, so the error is of
// the order of the tet size.
TEST(FieldRoughness, OfALinearFieldTendsToItsIntegral) {
  double before = kInfinity;
  for (int cells : {4, 8, 16}) {
    const TetMesh mesh = box(cells);
    double mean = 0;  // over three directions at right angles
    for (int axis = 0; axis < 3; ++axis)
      mean += FieldRoughness(mesh).value(field(mesh, [&](Vec3d X) { return X[axis]; }));
    const double error = std::abs(mean / 3 - 0.5);
    EXPECT_LT(error, 0.6 * before);
    before = error;
  }
  EXPECT_LT(before, 0.02);
}

TEST(FieldRoughness, DependsLittleOnMeshNotOnSize) {
  const auto wave = [](double size) { return [size](Vec3d X) { return std::sin(3 * X[0] / size) * X[1] / size; }; };
  for (double sharpness : {kInfinity, 10.0}) {
    const TetMesh coarse = box(6), fine = box(12), large = box(6, 1000);
    const double value = FieldRoughness(coarse, sharpness).value(field(coarse, wave(1)));
    EXPECT_NEAR(FieldRoughness(fine, sharpness).value(field(fine, wave(1))), value, 0.12 * value);
    EXPECT_NEAR(FieldRoughness(large, sharpness).value(field(large, wave(1000))), value, 1e-9 * value);
  }
}

// H1 of a jump grows with mesh refinement, total variation does not, so that it preserves edges.
TEST(FieldRoughness, OfJumpIsBoundedOnlyForTotalVariation) {
  const auto jump = [](Vec3d X) { return X[0] < 0.5 ? 0.0 : 2.0; };
  const TetMesh coarse = box(4), fine = box(12);
  EXPECT_GT(FieldRoughness(fine).value(field(fine, jump)), 2.5 * FieldRoughness(coarse).value(field(coarse, jump)));
  const double value = FieldRoughness(coarse, 10).value(field(coarse, jump));
  EXPECT_NEAR(FieldRoughness(fine, 10).value(field(fine, jump)), value, 0.15 * value);
}

struct Regularization {
  std::string name;
  std::vector<FitParameter> parameters;
  RegularizerOptions options;
};

class Regularizers : public testing::TestWithParam<Regularization> {
 protected:
  TetMesh mesh_ = [] {
    TetMesh mesh = box(3);
    for (int t = 0; t < mesh.tet_count(); ++t) mesh.region.push_back(t % 4);
    return mesh;
  }();
  ParameterMap map_ = map_of(mesh_, GetParam().parameters);
  std::unique_ptr<Regularizer> R_ = make_regularizer(mesh_, map_, GetParam().options);

  std::vector<double> somewhere() const {
    std::vector<double> p(map_.guess().begin(), map_.guess().end()), shift = noise(p.size(), 1);
    for (size_t i = 0; i < p.size(); ++i) p[i] += shift[i];
    return p;
  }
  bool is_quadratic() const { return GetParam().options.smoothness != Smoothness::total_variation; }
};

TEST_P(Regularizers, GradientIsThatOfTheValue) {
  const DerivativeReport report = check_derivatives({[&](auto p) { return R_->value(p); },
                                                     [&](auto p, auto g) {
                                                       std::fill(g.begin(), g.end(), 0.0);
                                                       R_->add_gradient(p, 1, g);
                                                     },
                                                     [&](auto p, auto d, auto y) {
                                                       std::fill(y.begin(), y.end(), 0.0);
                                                       R_->add_hessian_product(p, d, 1, y);
                                                     }},
                                                    somewhere());
  EXPECT_TRUE(report.gradient.passed) << report.gradient.smallest_error;
  EXPECT_EQ(report.hessian.passed, is_quadratic()) << "that of total variation is lagged";
}

TEST(RegularizerWall, LimitsFieldsToFactorOfHundred) {
  const TetMesh mesh = box(2);
  const ParameterMap map = map_of(mesh, {{.guess = 1e5}});
  const auto R = make_regularizer(mesh, map, {.smoothness = Smoothness::h1});
  const auto shifted = [&](double by) {
    std::vector<double> p(map.guess().begin(), map.guess().end());
    for (double& x : p) x += by;
    return p;
  };
  EXPECT_NEAR(R->value(shifted(4.5)), 4.5 * 4.5 / 8, 1e-9);
  EXPECT_GT(R->value(shifted(5)), 100);
  std::vector<double> p = shifted(0), v = noise(p.size(), 3), Hv(p.size(), 0.0), back(p.size());
  for (size_t i = 0; i < p.size(); ++i) p[i] += i % 3 == 0 ? 6 : i % 3 == 1 ? -5.5 : 2;
  const DerivativeReport report = check_derivatives({[&](auto x) { return R->value(x); },
                                                     [&](auto x, auto g) {
                                                       std::fill(g.begin(), g.end(), 0.0);
                                                       R->add_gradient(x, 1, g);
                                                     },
                                                     [&](auto x, auto d, auto y) {
                                                       std::fill(y.begin(), y.end(), 0.0);
                                                       R->add_hessian_product(x, d, 1, y);
                                                     }},
                                                    p);
  EXPECT_TRUE(report.gradient.passed) << report.gradient.smallest_error;
  EXPECT_TRUE(report.hessian.passed) << report.hessian.smallest_error;
  R->solve(shifted(0), v, 0, back);  // the matrix of another point is not reused
  R->add_hessian_product(p, v, 1, Hv);
  R->solve(p, Hv, 0, back);
  for (size_t i = 0; i < v.size(); ++i) EXPECT_NEAR(back[i], v[i], 1e-8);
}

// A(z) z is the gradient, so R(q) <= R(p) + g.(q - p) + (q - p)' A(p) (q - p) / 2.
TEST_P(Regularizers, HessianBoundsTheFunctionFromAbove) {
  const std::vector<double> p = somewhere();
  for (double size : {0.01, 0.3, 4.0}) {
    std::vector<double> d = noise(p.size(), 2), q = p, g(p.size(), 0.0), Hd(p.size(), 0.0);
    for (size_t i = 0; i < d.size(); ++i) d[i] *= size, q[i] += d[i];
    R_->add_gradient(p, 1, g);
    R_->add_hessian_product(p, d, 1, Hd);
    double model = R_->value(p);
    for (size_t i = 0; i < d.size(); ++i) model += (g[i] + Hd[i] / 2) * d[i];
    EXPECT_LE(R_->value(q), model * (1 + 1e-12));
  }
}

TEST_P(Regularizers, SolveInvertsTheHessian) {
  std::vector<double> p = somewhere();
  for (double shift : {0.0, 0.1}) {
    const std::vector<double> z = noise(p.size(), 3);
    std::vector<double> v(p.size(), 0.0), back(p.size());
    R_->add_hessian_product(p, z, 1, v);
    for (size_t i = 0; i < v.size(); ++i) v[i] += shift * z[i];
    R_->solve(p, v, shift, back);
    for (size_t i = 0; i < z.size(); ++i) ASSERT_NEAR(back[i], z[i], 1e-9);
    for (double& pi : p) pi *= 1.1;  // total variation needs a new matrix
  }
}

// Var(v'g) = v' R'' v.
TEST_P(Regularizers, NoiseHasTheHessianAsCovariance) {
  const std::vector<double> p = somewhere();
  std::mt19937_64 random(5);
  for (unsigned seed : {10, 11, 12}) {
    const std::vector<double> v = noise(p.size(), seed);
    std::vector<double> Hv(p.size(), 0.0);
    R_->add_hessian_product(p, v, 1, Hv);
    const double variance = std::inner_product(v.begin(), v.end(), Hv.begin(), 0.0);
    constexpr int kSamples = 4000;
    double mean = 0;
    for (int s = 0; s < kSamples; ++s) {
      std::vector<double> g(p.size(), 0.0);
      R_->add_noise(p, random, g);
      mean += std::pow(std::inner_product(v.begin(), v.end(), g.begin(), 0.0), 2) / kSamples;
    }
    EXPECT_NEAR(mean, variance, 4 * variance * std::sqrt(2.0 / kSamples));  // four standard errors
  }
}

TEST_P(Regularizers, IsLeastAtTheGuess) {
  std::vector<double> g(map_.guess().size(), 0.0);
  EXPECT_NEAR(R_->value(map_.guess()), 0, 1e-20);
  R_->add_gradient(map_.guess(), 1, g);
  for (double gi : g) EXPECT_NEAR(gi, 0, 1e-12);
}

const std::vector<FitParameter> kEveryParameterization = {{"young", Parameterization::tets, 0, 1e5},
                                                          {"poisson", Parameterization::regions, 0, 0.4},
                                                          {"b", Parameterization::handles, 6, 2}};
INSTANTIATE_TEST_SUITE_P(
    Of, Regularizers,
    testing::Values(Regularization{"H1", kEveryParameterization, {}},
                    Regularization{"TotalVariation", kEveryParameterization, {Smoothness::total_variation, 3}},
                    Regularization{"PriorAlone", kEveryParameterization, {Smoothness::none, 1}}),
    [](const auto& each) { return each.param.name; });

TEST(Regularizer, MeanOfFieldHasTheStandardDeviation) {
  const TetMesh mesh = box(3);
  const ParameterMap map = map_of(mesh, {{"young", Parameterization::tets, 0, 1e5}});
  const auto R = make_regularizer(mesh, map, {Smoothness::h1, 1.5});
  const std::vector<double> mean(mesh.tets.size(), 1.0 / static_cast<double>(mesh.tets.size()));  // equal volumes
  std::vector<double> z(mean.size());
  R->solve(map.guess(), mean, 0, z);
  EXPECT_NEAR(std::sqrt(std::inner_product(z.begin(), z.end(), mean.begin(), 0.0)), 1.5, 1e-9);
}

TEST(Regularizer, IsInvertedEvenWithoutAPrior) {
  const TetMesh mesh = box(3);
  const ParameterMap map = map_of(mesh, {{"young", Parameterization::tets, 0, 1e5}});
  const auto R = make_regularizer(mesh, map, {Smoothness::h1, kInfinity});
  std::vector<double> moved(map.guess().begin(), map.guess().end()), z(moved.size());
  for (double& p : moved) p += 3;
  EXPECT_NEAR(R->value(moved), 0, 1e-20);
  R->solve(moved, moved, 0, z);
  for (double zi : z) EXPECT_TRUE(std::isfinite(zi));
}

TEST(Regularizer, RefusesBadNumbers) {
  const TetMesh mesh = box(1);
  const ParameterMap map = map_of(mesh, {{"young", Parameterization::tets, 0, 1e5}});
  EXPECT_THROW(make_regularizer(mesh, map, {Smoothness::h1, 0}), InvalidInput);
  EXPECT_THROW(make_regularizer(mesh, map, {Smoothness::h1, std::nan("")}), InvalidInput);
  EXPECT_THROW(make_regularizer(mesh, map, {Smoothness::total_variation, 1, 0}), InvalidInput);
}

}  // namespace
}  // namespace aspic

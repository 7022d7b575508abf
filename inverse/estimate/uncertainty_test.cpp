#include "estimate/uncertainty.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/generators.h"
#include "model/common_errors.h"
#include "model/linear_models_test.h"

namespace aspic {
namespace {

using test::as_vector;
using testing::ElementsAre;
using testing::HasSubstr;

ParameterMap make_map(const TetMesh& mesh, std::vector<FitParameter> parameters) {
  return {mesh, "neo_hookean", std::vector<MaterialParameters>(mesh.tets.size(), {lame_from_young_poisson(1e5, 0.4)}),
          std::move(parameters)};
}

TetMesh bar(int cells) { return make_box({{0, 0, 0}}, {{0.01 * cells, 0.01, 0.01}}, {cells, 1, 1}, BoxCut::five); }

// A field over the tets of a bar, with measured averages of standard deviation 1.
struct Field {
  TetMesh mesh;
  ParameterMap map;
  test::LinearModel data;
  test::QuadraticPrior prior;
  Eigen::VectorXd truth;

  explicit Field(int cells, int residuals, double strength = 5)
      : mesh(bar(cells)),
        map(make_map(mesh, {{.guess = 1}})),  // log E = 0
        data(test::averages(map.size(), residuals, strength, 4)),
        prior(test::chain_prior(map.size(), 2, 1.5)) {}

  void measure(unsigned seed, double noise = 1) {
    std::mt19937_64 random(seed);
    truth = prior.draw(1, random);
    data.b = data.J * truth + noise * test::normal_vector(data.residual_count(), random);
  }
  std::vector<double> fit(double weight = 1) const {
    const Eigen::MatrixXd H = data.J.transpose() * data.J + weight * prior.curvature;
    return test::as_std(H.llt().solve(data.J.transpose() * data.b + weight * prior.curvature * prior.guess));
  }
  Eigen::VectorXd exact_sigma() const {
    return (data.J.transpose() * data.J + prior.curvature).inverse().diagonal().cwiseSqrt();
  }
  Posterior posterior(double weight = 1, const PosteriorOptions& options = {}) {
    return aspic::posterior(data, prior, weight, {map, mesh, fit(weight)}, options);
  }
};

bool has_warning(const Posterior& posterior, const std::string& part) {
  return testing::Matches(testing::Contains(HasSubstr(part)))(posterior.warnings);
}

TEST(Posterior, HasTheSigmaOfTheNormalEquations) {
  Field f(12, 40);
  f.measure(1);
  const Eigen::VectorXd exact = f.exact_sigma(), before = f.prior.curvature.inverse().diagonal().cwiseSqrt();
  for (const int dense : {600, 50, 0}) {  // all pairs, rows, sampled
    const Posterior posterior = f.posterior(1, {.spectrum = {.dense = dense, .negligible = 0}});
    ASSERT_TRUE(posterior.ok);
    EXPECT_EQ(posterior.sigma_error, 0);
    for (int t = 0; t < f.map.size(); ++t) {
      EXPECT_NEAR(posterior.sigma[0][t], exact(t), 2e-4 * exact(t)) << dense;
      EXPECT_NEAR(posterior.reduction[0][t], 1 - std::pow(exact(t) / before(t), 2), 1e-3);
    }
  }
}

TEST(Posterior, IsSampledWithinTheErrorThatItReports) {
  Field f(30, 20);
  f.measure(1);
  const Eigen::VectorXd exact = f.exact_sigma();
  for (const int samples : {50, 800}) {
    const Posterior posterior =
        f.posterior(1, {.spectrum = {.dense = 20}, .marginals = {.exact = 0, .samples = samples}});
    EXPECT_GT(posterior.sigma_error, 0);
    EXPECT_LE(posterior.sigma_error, std::sqrt(0.5 / samples));
    double squares = 0;
    for (int t = 0; t < f.map.size(); ++t) {
      const double error = posterior.sigma[0][t] / exact(t) - 1;
      EXPECT_LT(std::abs(error), 4.5 * posterior.sigma_error);
      squares += error * error / f.map.size();
    }
    EXPECT_GT(std::sqrt(squares), 0.1 * posterior.sigma_error);  // the error estimate is not excessive
  }
}

TEST(Posterior, OfTwoQuantitiesKeepsThemApart) {
  const TetMesh mesh = bar(3);
  const int n = mesh.tet_count();
  const ParameterMap map = make_map(
      mesh, {{.guess = 1}, {.quantity = "poisson", .parameterization = Parameterization::uniform, .guess = 0.3}});
  test::LinearModel data = test::averages(n + 1, 6, 5, 2);
  test::QuadraticPrior prior = test::chain_prior(n + 1, 0.5, 1);
  data.b.setZero();
  const std::vector<double> p(map.guess().begin(), map.guess().end());
  const Posterior posterior = aspic::posterior(data, prior, 1, {map, mesh, p});
  const Eigen::VectorXd exact = (data.J.transpose() * data.J + prior.curvature).inverse().diagonal().cwiseSqrt();
  for (int t = 0; t < n; ++t) {
    EXPECT_NEAR(posterior.sigma[0][t] / posterior.applied_factor, exact(t), 0.3 * exact(t));
    EXPECT_EQ(posterior.sigma[1][t], posterior.sigma[1][0]);
  }
}

// ---------------------------------------------------------------------------------------------------- coverage

TEST(Posterior, IntervalsContainTruthAtStatedRate) {
  constexpr int kSeeds = 600;
  Field f(8, 25);
  int one = 0, all = 0;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    f.measure(seed);
    const std::vector<double> p = f.fit();
    const Posterior posterior = aspic::posterior(f.data, f.prior, 1, {f.map, f.mesh, p});
    for (int t = 0; t < f.map.size(); ++t) {
      const Interval i = interval(posterior, f.map, p, {0, t});
      const double E = std::exp(f.truth(t));
      const bool inside = i.lower < E && E < i.upper;
      all += inside;
      if (t == static_cast<int>(seed) % f.map.size()) one += inside;  // independent of each other
    }
  }
  const double error = std::sqrt(0.95 * 0.05 / kSeeds);
  EXPECT_NEAR(one / double(kSeeds), 0.95, 3.3 * error);  // fails once in 1000 cases
  EXPECT_NEAR(all / double(kSeeds * f.map.size()), 0.95, 3.3 * error);
}

// ---------------------------------------------------------------------------------------------------- scale

// Rows of averages that are invariant under a common shift of log E.
Field ratios_only() {
  Field f(6, 40);
  const Eigen::VectorXd mean = f.data.J.rowwise().mean();
  f.data.J.colwise() -= mean;
  f.measure(3);
  return f;
}

TEST(Posterior, ReportsThatOnlyRatiosOfStiffnessAreDetermined) {
  Field f = ratios_only();
  const Posterior blind = f.posterior();
  EXPECT_TRUE(blind.scale_is_unknown);
  EXPECT_THAT(blind.warnings, testing::Contains(HasSubstr("measure one force")));

  f.data.J.row(0).setConstant(10.0 / f.map.size());  // a force known to 10 %
  f.measure(3);
  const Posterior with_force = f.posterior();
  EXPECT_FALSE(with_force.scale_is_unknown);
  EXPECT_LT(with_force.sigma[0][0], blind.sigma[0][0]);
}

TEST(Posterior, ContactStiffnessIsNoForceInformation) {
  Field f = ratios_only();
  std::mt19937_64 random(1);
  const Eigen::VectorXd leak = 3 * test::normal_vector(f.data.residual_count(), random);
  f.data.J += leak * Eigen::RowVectorXd::Constant(f.map.size(), 1.0 / f.map.size());
  f.measure(3);
  EXPECT_FALSE(f.posterior().scale_is_unknown);
  f.data.nuisances = {-leak};  // scaling contact and body together changes nothing
  WithUncertainLayers data(f.data);
  const Posterior posterior = aspic::posterior(data, f.prior, 1, {f.map, f.mesh, f.fit()});
  EXPECT_TRUE(posterior.scale_is_unknown);
}

// ---------------------------------------------------------------------------------------------------- judgment

TEST(Posterior, IsContentWithTheRightNoiseAndWeight) {
  Field f(8, 300, 1);
  int warned = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    f.measure(seed);
    const Posterior posterior = f.posterior();
    warned += !posterior.warnings.empty();
    EXPECT_NEAR(posterior.noise_factor, 1, 0.2);
    EXPECT_EQ(posterior.applied_factor, 1);
  }
  EXPECT_LE(warned, 3);  // each verdict is wrong by chance about once in 200 cases
}

TEST(Posterior, WidensIfMeasurementsScatterMoreThanStated) {
  Field f(8, 300, 1);
  f.measure(1, 3);
  const Posterior posterior = f.posterior();
  EXPECT_NEAR(posterior.noise_factor, 3, 0.4);
  EXPECT_EQ(posterior.applied_factor, posterior.noise_factor);
  EXPECT_THAT(posterior.warnings, testing::Contains(HasSubstr("per reading, clearly more than 1")));
  const Eigen::VectorXd exact =
      (f.data.J.transpose() * f.data.J / std::pow(posterior.noise_factor, 2) + f.prior.curvature)
          .inverse()
          .diagonal()
          .cwiseSqrt();
  for (int t = 0; t < f.map.size(); ++t) EXPECT_NEAR(posterior.sigma[0][t], exact(t), 1e-3 * exact(t));
}

TEST(Posterior, DoesNotNarrowWhenTheyScatterLess) {
  Field f(8, 300, 1);
  f.measure(1, 0.3);
  const Posterior posterior = f.posterior();
  EXPECT_NEAR(posterior.noise_factor, 0.3, 0.05);
  EXPECT_EQ(posterior.applied_factor, 1);
  EXPECT_THAT(posterior.warnings, testing::Contains(HasSubstr("per reading, clearly less than 1")));
}

TEST(Posterior, SuggestsTheWeightThatDataSupport) {
  Field f(30, 300, 20);
  f.measure(1);
  for (const double weight : {0.01, 1.0, 100.0}) {  // the suggested weight does not depend on it for linear residuals
    const Posterior posterior = f.posterior(weight);
    EXPECT_GT(posterior.suggested_weight, 0.5) << weight;
    EXPECT_LT(posterior.suggested_weight, 2) << weight;
    EXPECT_EQ(has_warning(posterior, "details are lost"), weight == 100);
    EXPECT_EQ(has_warning(posterior, "noise may have been fitted"), weight == 0.01);
  }
}

TEST(Posterior, HasLargestEvidenceNearTrueWeight) {
  Field f(30, 300, 1);
  f.measure(2);
  const double right = f.posterior(1).log_evidence;
  EXPECT_GT(right, f.posterior(0.05).log_evidence);
  EXPECT_GT(right, f.posterior(20).log_evidence);
}

TEST(Posterior, WithoutAnEquilibriumIsNone) {
  class Undefined : public test::LinearModel {
    bool evaluate(std::span<const double>, std::span<double>) override { return false; }
  } data;
  Field f(2, 5);
  data.J = f.data.J;
  const std::vector<double> p(f.map.size());
  const Posterior posterior = aspic::posterior(data, f.prior, 1, {f.map, f.mesh, p});
  EXPECT_FALSE(posterior.ok);
  EXPECT_THAT(posterior.warnings, ElementsAre(HasSubstr("no stable equilibrium")));
}

TEST(Posterior, ReducesTheVarianceWhereDataAre) {
  Field f(20, 25);
  f.data.J.setZero();
  for (int t = 0; t < 25; ++t) f.data.J(t, t) = 50;  // the first quarter of the bar
  f.measure(1);
  const Posterior posterior = f.posterior();
  EXPECT_GT(posterior.reduction[0][3], 0.9);
  EXPECT_LT(posterior.reduction[0][99], 0.01);
}

TEST(Interval, IsInUnitsOfTheQuantity) {
  const TetMesh mesh = bar(1);
  const ParameterMap map = make_map(mesh, {{.parameterization = Parameterization::uniform, .guess = 1e5}});
  Posterior posterior;
  posterior.sigma = {std::vector<double>(mesh.tets.size(), std::log(1.3))};
  const Interval i = interval(posterior, map, map.guess(), {0, 2}, 1);
  EXPECT_NEAR(i.lower, 1e5 / 1.3, 1e-6);
  EXPECT_NEAR(i.upper, 1.3e5, 1e-6);
}

}  // namespace
}  // namespace aspic

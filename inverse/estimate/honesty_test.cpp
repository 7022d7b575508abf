// Uncertainty with real equilibria: coverage, and warnings without measured forces.
#include <gmock/gmock.h>

#include "estimate/fit.h"
#include "estimate/uncertainty.h"
#include "math/vectors.h"
#include "model/common_errors.h"
#include "model/indented_block_test.h"

namespace aspic {
namespace {

using test::IndentedBlock;

std::vector<double> draw(Regularizer& prior, const ParameterMap& map, double weight, std::mt19937_64& random) {
  std::vector<double> x(map.size());
  PriorGaussian(prior, weight, map.guess()).sample(random, x);
  for (size_t i = 0; i < x.size(); ++i) x[i] += map.guess()[i];
  return x;
}

FitReport fitted(LeastSquares& data, Regularizer& prior, const ParameterMap& map, double weight = 1) {
  const FitReport report = fit(data, prior, map.guess(), {.tolerance = 1e-4, .weight = weight});
  EXPECT_TRUE(is_success(report.status)) << report.message;
  return report;
}

struct Coverage {
  int inside = 0, all = 0;
  double part() const { return static_cast<double>(inside) / all; }
};

void add(const Posterior& posterior, const ParameterMap& map, const std::vector<double>& p,
         const std::vector<double>& truth, Coverage& coverage) {
  const std::vector<double> E = map.values(0, truth);
  for (int t = 0; t < static_cast<int>(E.size()); ++t) {
    const Interval i = interval(posterior, map, p, {0, t});
    coverage.inside += i.lower < E[t] && E[t] < i.upper;
    ++coverage.all;
  }
}

// Draws the truth from the prior. log E varies by about 0.6; its posterior standard deviation is half of that.
TEST(Honesty, IntervalsOfAFieldHoldTheTruth) {
  constexpr double kWeight = 4;
  constexpr int kSeeds = 12;
  Coverage coverage;
  double error = 0, expected = 0;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    IndentedBlock block;
    for (const IndentedBlock::Site& site : IndentedBlock::sites()) block.add_indentation(site, 0.006, 0.02);
    const ParameterMap map = block.map();
    const auto prior = make_regularizer(block.experiment.mesh, map, {.prior_sigma = 0.5});
    std::mt19937_64 random(seed);
    const std::vector<double> truth = draw(*prior, map, kWeight, random);
    block.measure(map, truth, random);
    Misfit misfit(block.experiment, map);
    WithUncertainLayers data(misfit);
    const FitReport report = fitted(data, *prior, map, kWeight);
    const Posterior posterior = aspic::posterior(data, *prior, kWeight, {map, block.experiment.mesh, report.p});
    ASSERT_TRUE(posterior.ok);
    EXPECT_FALSE(posterior.scale_is_unknown);
    EXPECT_NEAR(posterior.noise_factor, 1, 0.1);
    EXPECT_EQ(posterior.applied_factor, 1);
    EXPECT_GT(posterior.suggested_weight, kWeight / 3);
    EXPECT_LT(posterior.suggested_weight, kWeight * 3);
    add(posterior, map, report.p, truth, coverage);
    for (int t = 0; t < map.size(); ++t) {
      error += std::pow(report.p[t] - truth[t], 2);
      expected += std::pow(posterior.sigma[0][t], 2);
    }
  }
  RecordProperty("coverage", std::to_string(coverage.part()));
  EXPECT_GT(coverage.part(), 0.90);
  EXPECT_LT(coverage.part(), 0.99);
  EXPECT_NEAR(std::sqrt(error / expected), 1, 0.15);
}

TEST(Honesty, IntervalsOfTwoLayersHoldTheTruth) {
  IndentedBlock block;
  TetMesh& mesh = block.experiment.mesh;
  for (const Tet& tet : mesh.tets) {
    double height = 0;
    for (const int v : tet) height += mesh.rest[v][2] / 4;
    mesh.region.push_back(height < IndentedBlock::kHeight / 2 ? 0 : 1);
  }
  for (const IndentedBlock::Site& site : IndentedBlock::sites()) block.add_indentation(site, 0.006, 0.1);
  const ParameterMap map = block.map({{.parameterization = Parameterization::regions, .guess = 2e4}});
  const auto prior = make_regularizer(mesh, map, {.prior_sigma = 2});
  const std::vector<double> truth = {std::log(5e4), std::log(1e4)};
  Coverage coverage;
  constexpr int kSeeds = 100;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    std::mt19937_64 random(seed);
    block.measure(map, truth, random);
    Misfit misfit(block.experiment, map);
    WithUncertainLayers data(misfit);
    const FitReport report = fitted(data, *prior, map);
    const Posterior posterior = aspic::posterior(data, *prior, 1, {map, mesh, report.p});
    for (int layer = 0; layer < 2; ++layer) {
      const int t = static_cast<int>(std::ranges::find(mesh.region, layer) - mesh.region.begin());
      const Interval i = interval(posterior, map, report.p, {0, t});
      coverage.inside += i.lower < std::exp(truth[layer]) && std::exp(truth[layer]) < i.upper;
      ++coverage.all;
    }
  }
  RecordProperty("coverage", std::to_string(coverage.part()));
  const double error = std::sqrt(0.95 * 0.05 / kSeeds);  // as if both layers were one
  EXPECT_NEAR(coverage.part(), 0.95, 3 * error);
}

// ---------------------------------------------------------------------------------------------------- scale

IndentedBlock indented(bool with_force) {
  IndentedBlock block;
  for (const IndentedBlock::Site& site : IndentedBlock::sites()) block.add_indentation(site, 0.006, 0.01, with_force);
  return block;
}

TEST(Honesty, WithoutForceOnlyStiffnessRatiosAreDetermined) {
  for (const bool with_force : {false, true}) {
    IndentedBlock block = indented(with_force);
    const ParameterMap map = block.map();
    const auto prior = make_regularizer(block.experiment.mesh, map, {.prior_sigma = 2});
    std::mt19937_64 random(4);
    block.measure(map, draw(*prior, map, 4, random), random);
    Misfit misfit(block.experiment, map);
    WithUncertainLayers data(misfit);
    const FitReport report = fitted(data, *prior, map, 4);
    WithUncertainLayers about_fit(misfit);
    const Posterior posterior = aspic::posterior(about_fit, *prior, 4, {map, block.experiment.mesh, report.p});
    EXPECT_EQ(posterior.scale_is_unknown, !with_force);
    const std::vector<double> common(map.size(), 1.0 / map.size());
    std::vector<double> covariance(common.size());
    posterior.gaussian->covariance(common, covariance);
    const double sigma = std::sqrt(dot(common, covariance));
    if (!with_force)
      EXPECT_NEAR(sigma, 1, 0.1) << "the prior alone determines the scale: 2 / sqrt(weight)";
    else
      EXPECT_LT(sigma, 0.5);
    // A known layer stiffness would act like a force measurement.
    EXPECT_FALSE(aspic::posterior(misfit, *prior, 4, {map, block.experiment.mesh, report.p}).scale_is_unknown);
  }
}

TEST(Honesty, NuisanceIsDerivativeByLayerStiffness) {
  IndentedBlock block = indented(true);
  const ParameterMap map = block.map();
  const auto residuals_at = [&](double log_factor) {
    IndentedBlock changed = block;
    for (LoadCase& load : changed.experiment.cases) load.indenter->stiffness *= std::exp(log_factor);
    Misfit misfit(changed.experiment, map, {.tolerance = 1e-13});
    std::vector<double> r(misfit.residual_count());
    EXPECT_TRUE(misfit.evaluate(map.guess(), r));
    return r;
  };
  Misfit misfit(block.experiment, map, {.tolerance = 1e-13});
  std::vector<double> r(misfit.residual_count()), dr(r.size());
  ASSERT_TRUE(misfit.evaluate(map.guess(), r));
  ASSERT_TRUE(misfit.linearize());
  ASSERT_EQ(misfit.nuisance_count(), 1);
  misfit.nuisance(0, dr);
  const std::vector<double> plus = residuals_at(1e-3), minus = residuals_at(-1e-3);
  double size = 0, error = 0;
  for (size_t i = 0; i < r.size(); ++i) {
    size = std::max(size, std::abs(dr[i]));
    error = std::max(error, std::abs((plus[i] - minus[i]) / 2e-3 - dr[i]));
  }
  EXPECT_GT(size, 0.1);
  EXPECT_LT(error, 1e-5 * size);
}

// Eigenpairs by sampling, rows and columns agree at a real fit.
TEST(Honesty, AllEigenpairMethodsAgreeAtFit) {
  IndentedBlock block = indented(true);
  const ParameterMap map = block.map();
  const auto prior = make_regularizer(block.experiment.mesh, map, {.prior_sigma = 1});
  Misfit misfit(block.experiment, map);
  const std::vector<double> p(map.guess().begin(), map.guess().end());
  std::mt19937_64 random(4);
  block.measure(map, p, random);
  const Posterior dense = posterior(misfit, *prior, 1, {map, block.experiment.mesh, p});
  const Posterior sampled = posterior(misfit, *prior, 1, {map, block.experiment.mesh, p}, {.spectrum = {.dense = 10}});
  ASSERT_LT(sampled.gaussian->spectrum().W.count(), map.size());
  for (int t = 0; t < map.size(); ++t) {
    EXPECT_GT(sampled.sigma[0][t], dense.sigma[0][t] * (1 - 1e-6));
    EXPECT_LT(sampled.sigma[0][t], dense.sigma[0][t] * 1.05);
  }
}

}  // namespace
}  // namespace aspic

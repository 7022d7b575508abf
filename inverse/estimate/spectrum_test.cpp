#include "estimate/spectrum.h"

#include <gtest/gtest.h>

#include "model/linear_models_test.h"

namespace aspic {
namespace {

using test::as_vector;

Eigen::MatrixXd matrix(const Columns& A) {
  Eigen::MatrixXd M(A.rows(), A.count());
  for (int j = 0; j < A.count(); ++j) M.col(j) = as_vector(A[j]);
  return M;
}

Eigen::MatrixXd covariance(Gaussian& g) {
  const int n = g.size();
  Eigen::MatrixXd C(n, n);
  for (int j = 0; j < n; ++j) {
    std::vector<double> unit(n, 0.0), column(n);
    unit[j] = 1;
    g.covariance(unit, column);
    C.col(j) = as_vector(column);
  }
  return C;
}

struct SpectrumCase {
  const char* name;
  int parameter_count, residuals;
  SpectrumOptions options;
};
void PrintTo(const SpectrumCase& c, std::ostream* out) { *out << c.name; }

class Spectra : public testing::TestWithParam<SpectrumCase> {
 protected:
  static constexpr double kWeight = 2;
  test::LinearModel data = test::averages(GetParam().parameter_count, GetParam().residuals, 30, 5);
  test::QuadraticPrior prior = test::chain_prior(GetParam().parameter_count, 1, 2);
  std::vector<double> p = std::vector<double>(static_cast<size_t>(GetParam().parameter_count), 0.0);
  PriorGaussian before{prior, kWeight, p};
  const double floor = 1 / (100.0 * 100.0 * GetParam().parameter_count);
  Eigen::MatrixXd precision =
      kWeight * prior.curvature + floor * Eigen::MatrixXd::Identity(prior.G.cols(), prior.G.cols());
  Eigen::MatrixXd hessian = data.J.transpose() * data.J;
};

TEST_P(Spectra, AreEigenpairsInTheNormOfThePrior) {
  const Spectrum s = spectrum(data, before, GetParam().options);
  const Eigen::MatrixXd W = matrix(s.W), dual = matrix(s.dual);
  ASSERT_GT(s.W.count(), 5);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(W.cols(), W.cols());
  EXPECT_LT((W.transpose() * precision * W - I).norm(), 1e-8);
  EXPECT_LT((dual - precision * W).norm(), 1e-8 * dual.norm());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> oracle(hessian, precision);
  const Eigen::VectorXd exact = oracle.eigenvalues().reverse();
  for (int k = 0; k < s.W.count() && exact(k) > 1; ++k) EXPECT_NEAR(s.d[k], exact(k), 0.02 * exact(k)) << k;
  EXPECT_GE(s.W.count(), (exact.array() > 1).count());
}

TEST_P(Spectra, NeverClaimMoreThanTheData) {
  const Spectrum s = spectrum(data, before, GetParam().options);
  const Eigen::MatrixXd dual = matrix(s.dual);
  const Eigen::MatrixXd claimed = dual * as_vector(s.d).asDiagonal() * dual.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> rest(hessian - claimed);
  EXPECT_GT(rest.eigenvalues()(0), -1e-9 * hessian.norm());
}

TEST_P(Spectra, GiveThePosterior) {
  PosteriorGaussian after(before, spectrum(data, before, GetParam().options));
  const Eigen::MatrixXd exact = (hessian + precision).inverse(), C = covariance(after);
  for (int i = 0; i < C.rows(); ++i) {
    EXPECT_GT(C(i, i), exact(i, i) * (1 - 1e-6));
    EXPECT_LT(C(i, i), exact(i, i) * 1.1);
  }
  std::vector<double> v(p.size()), y(p.size()), z(p.size());
  std::mt19937_64 random(3);
  as_vector(v) = test::normal_vector(static_cast<int>(v.size()), random);
  after.precision(v, y);
  after.covariance(y, z);
  EXPECT_LT((as_vector(z) - as_vector(v)).norm(), 1e-8 * as_vector(v).norm());
}

INSTANTIATE_TEST_SUITE_P(Ways, Spectra,
                         testing::Values(SpectrumCase{"dense by tangents", 60, 90, {}},
                                         SpectrumCase{"dense by adjoints", 60, 20, {}},
                                         SpectrumCase{"rows", 120, 40, {.dense = 50}},
                                         SpectrumCase{"sampled", 300, 200, {.dense = 50}},
                                         SpectrumCase{"sampled to the end", 90, 60, {.dense = 10, .negligible = 0}}));

TEST(Spectrum, DenseTakesTheCheaperSideOfTheJacobian) {
  test::LinearModel tall = test::averages(20, 50, 1, 1), wide = test::averages(50, 20, 1, 1);
  test::QuadraticPrior prior20 = test::chain_prior(20, 1, 2), prior50 = test::chain_prior(50, 1, 2);
  const std::vector<double> p20(20), p50(50);
  PriorGaussian before20(prior20, 1, p20), before50(prior50, 1, p50);
  spectrum(tall, before20);
  spectrum(wide, before50);
  EXPECT_EQ(tall.products, 20);
  EXPECT_EQ(tall.transposed_products, 0);
  EXPECT_EQ(wide.products, 0);
  EXPECT_EQ(wide.transposed_products, 20);
}

TEST(Spectrum, ReportsInformationMissedByLowRank) {
  test::LinearModel data = test::averages(300, 200, 30, 5);
  test::QuadraticPrior prior = test::chain_prior(300, 1, 2);
  const std::vector<double> p(300);
  PriorGaussian before(prior, 1, p);
  const Spectrum few = spectrum(data, before, {.dense = 10, .max_rank = 10});
  EXPECT_LE(few.W.count(), 18);
  EXPECT_GT(few.missed, 1);
  const Spectrum many = spectrum(data, before, {.dense = 10, .max_rank = 200});
  EXPECT_LE(many.missed, 0.1);
}

TEST(Spectrum, OfNonFiniteJacobianIsEmpty) {
  for (const int dense : {600, 40, 10}) {
    test::LinearModel data = test::averages(80, 30, 1, 5);
    test::QuadraticPrior prior = test::chain_prior(80, 1, 2);
    data.J(7, 3) = std::nan("");
    const std::vector<double> p(80);
    PriorGaussian before(prior, 1, p);
    const Spectrum s = spectrum(data, before, {.dense = dense});
    EXPECT_FALSE(s.ok);
    EXPECT_EQ(s.W.count(), 0);
  }
}

TEST(Spectrum, OfDataThatSayNothingIsEmpty) {
  test::LinearModel data = test::averages(80, 90, 0, 5);
  test::QuadraticPrior prior = test::chain_prior(80, 1, 2);
  const std::vector<double> p(80);
  PriorGaussian before(prior, 1, p);
  const Spectrum s = spectrum(data, before, {.dense = 10});
  EXPECT_EQ(s.W.count(), 0);
  EXPECT_EQ(s.missed, 0);
}

TEST(PriorGaussian, HoldsWhatTheRegularizerLeavesFree) {
  test::QuadraticPrior prior = test::chain_prior(10, 1, 1e30);  // only differences
  const std::vector<double> p(10);
  PriorGaussian before(prior, 1, p);
  const std::vector<double> ones(10, 0.1);  // the mean
  std::vector<double> z(10);
  before.covariance(ones, z);
  EXPECT_NEAR(as_vector(ones).dot(as_vector(z)), 100 * 100, 1);
}

TEST(PriorGaussian, SamplesHaveItsCovariance) {
  test::QuadraticPrior prior = test::chain_prior(6, 1, 0.7);
  const std::vector<double> p(6);
  PriorGaussian before(prior, 3, p);
  const Eigen::MatrixXd C = covariance(before);
  constexpr int kSamples = 4000;
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(6, 6);
  std::mt19937_64 random(8);
  std::vector<double> x(6);
  for (int s = 0; s < kSamples; ++s) {
    before.sample(random, x);
    mean += as_vector(x) * as_vector(x).transpose() / kSamples;
  }
  for (int i = 0; i < 6; ++i)  // four standard errors
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR(mean(i, j), C(i, j), 4 * std::sqrt((C(i, i) * C(j, j) + C(i, j) * C(i, j)) / kSamples));
}

}  // namespace
}  // namespace aspic

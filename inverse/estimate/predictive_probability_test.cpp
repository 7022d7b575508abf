#include "estimate/predictive_probability.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "model/history_misfit.h"

namespace aspic {
namespace {

// r = A p - y
class LinearData : public LeastSquares {
 public:
  LinearData(Eigen::MatrixXd A, Eigen::VectorXd y) : A_(std::move(A)), y_(std::move(y)) {}
  int parameter_count() const override { return static_cast<int>(A_.cols()); }
  int residual_count() const override { return static_cast<int>(A_.rows()); }
  bool evaluate(std::span<const double> p, std::span<double> r) override {
    const Eigen::VectorXd value = A_ * Eigen::Map<const Eigen::VectorXd>(p.data(), A_.cols()) - y_;
    std::copy(value.begin(), value.end(), r.begin());
    return true;
  }
  bool linearize() override { return true; }
  void multiply(std::span<const double> dp, std::span<double> dr) override {
    const Eigen::VectorXd value = A_ * Eigen::Map<const Eigen::VectorXd>(dp.data(), A_.cols());
    std::copy(value.begin(), value.end(), dr.begin());
  }
  void multiply_transposed(std::span<const double>, std::span<double>) override {}

 private:
  Eigen::MatrixXd A_;
  Eigen::VectorXd y_;
};

// The density of the held-out readings is that of a normal distribution with the dense covariance.
TEST(PredictiveProbability, MatchesDenseNormalDistribution) {
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(6, 2), B = Eigen::MatrixXd::Random(4, 2);
  const Eigen::VectorXd y = Eigen::VectorXd::Random(6), z = 3 * Eigen::VectorXd::Random(4);
  LinearData fitted(A, y), held_out(B, z);
  IndependentPriors prior({0, 0}, {2, 0.5});
  const std::vector<double> p = {0.3, -0.2};
  const PredictiveResiduals residuals = predictive_residuals(fitted, held_out, prior, p);
  for (const double factor : {1.0, 1.7}) {
    const double v = factor * factor;
    Eigen::MatrixXd precision = A.transpose() * A / v;
    precision(0, 0) += 1 / 4.0;
    precision(1, 1) += 4;
    const Eigen::MatrixXd C = v * Eigen::MatrixXd::Identity(4, 4) + B * precision.inverse() * B.transpose();
    const Eigen::VectorXd r = B * Eigen::Map<const Eigen::VectorXd>(p.data(), 2) - z;
    const double expected = -0.5 * r.dot(C.inverse() * r) - 0.5 * std::log(C.determinant()) + 2 * std::log(v);
    EXPECT_NEAR(residuals.log_probability(factor), expected, 1e-10);
  }
}

}  // namespace
}  // namespace aspic

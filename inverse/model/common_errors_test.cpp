#include "model/common_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "math/vectors.h"
#include "model/indented_block_test.h"

namespace aspic {
namespace {

using test::IndentedBlock;

TEST(CommonErrors, MakeTheCovarianceThatOfIndependentErrors) {
  const Eigen::VectorXd n = Eigen::VectorXd::LinSpaced(6, 1, -3), m = Eigen::VectorXd::LinSpaced(6, 40, 50);
  CommonErrors errors;
  errors.add(0, {n.begin(), n.end()});
  errors.add(0, {m.begin(), m.end()});
  Eigen::MatrixXd L = Eigen::MatrixXd::Identity(6, 6), Lt = L;
  for (int j = 0; j < 6; ++j) {
    errors.apply({L.col(j).data(), 6});
    errors.apply_transposed({Lt.col(j).data(), 6});
  }
  EXPECT_LT((L.transpose() - Lt).norm(), 1e-13);
  const Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(6, 6) + n * n.transpose() + m * m.transpose();
  EXPECT_LT((L * covariance * L.transpose() - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-10);
}

TEST(CommonErrors, AlongAnUnboundedOneNothingIsLeft) {
  const Eigen::VectorXd n = Eigen::VectorXd::LinSpaced(3, 1, -3), m = Eigen::VectorXd::LinSpaced(6, 40, 50);
  CommonErrors errors;
  errors.add(3, {n.begin(), n.end()});
  errors.add_unbounded({m.begin(), m.end()});
  errors.add_unbounded({m.begin(), m.end()});  // no further information
  Eigen::MatrixXd L = Eigen::MatrixXd::Identity(6, 6);
  for (int j = 0; j < 6; ++j) errors.apply({L.col(j).data(), 6});
  EXPECT_LT((L * m).norm(), 1e-12 * m.norm());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(6, 6);
  covariance.bottomRightCorner(3, 3) += n * n.transpose();
  const Eigen::MatrixXd whitened = L * covariance * L.transpose();  // a projection onto 5 dimensions
  EXPECT_LT((whitened * whitened - whitened).norm(), 1e-12);
  EXPECT_NEAR(whitened.trace(), 5, 1e-12);
}

// |dr|^2 for a uniformly stiffer body.
double information_of_scale(bool with_force, bool with_layers) {
  IndentedBlock block;
  for (const auto& site : IndentedBlock::sites()) block.add_indentation(site, 0.006, 1e-4, with_force);
  const ParameterMap map = block.map({{.parameterization = Parameterization::uniform, .guess = IndentedBlock::kYoung}});
  Misfit misfit(block.experiment, map);
  WithUncertainLayers layers(misfit);
  LeastSquares& data = with_layers ? static_cast<LeastSquares&>(layers) : misfit;
  std::vector<double> r(static_cast<size_t>(data.residual_count())), dr = r;
  EXPECT_TRUE(data.evaluate(map.guess(), r) && data.linearize()) << misfit.failure();
  data.multiply(std::vector<double>{1.0}, dr);
  return dot(dr, dr);
}

TEST(CommonErrors, PositionsAloneDoNotDetermineScale) {
  EXPECT_GT(information_of_scale(false, false), 100) << "what leaks through the layer, at a noise of 1e-4";
  EXPECT_LT(information_of_scale(false, true), 1e-8);
}

TEST(CommonErrors, ForcesStillTellTheScale) {
  EXPECT_GT(information_of_scale(true, true), 0.1 * information_of_scale(true, false));
}

}  // namespace
}  // namespace aspic

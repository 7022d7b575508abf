#include "model/robust_loss.h"

#include <gtest/gtest.h>

namespace aspic {
namespace {

TEST(RobustLoss, WeightIsItsDerivative) {
  for (const double s : {0.1, 2.9, 3.1, 10.0, 1e4}) {
    const double h = 1e-4 * s;
    EXPECT_NEAR((robust_loss(s + h) - robust_loss(s - h)) / (2 * h), robust_weight(s), 1e-7);
  }
  EXPECT_DOUBLE_EQ(robust_loss(3), 3);
  EXPECT_DOUBLE_EQ(robust_weight(3), 1);
}

// rho(s) <= rho(t) + rho'(t) (s - t): each weighted least-squares step decreases the loss.
TEST(RobustLoss, IsMajorizedByWeightedSquares) {
  for (const double t : {0.5, 3.0, 8.0, 200.0})
    for (const double s : {0.0, 1.0, 3.5, 30.0, 1e3})
      EXPECT_LE(robust_loss(s), robust_loss(t) + robust_weight(t) * (s - t) + 1e-12);
}

TEST(RobustLoss, WeightsOfWeightedReadingsAreThoseOfTheirErrors) {
  Experiment experiment;
  LoadCase& load = experiment.cases.emplace_back();
  load.positions = {{0, {}, {{1, 1, 1}}}, {1, {}, {{1, 1, 1}}}};
  load.force = Vec3d{}, load.force_sigma = {{1, 1, 1}};
  const std::vector<double> r = {1, 0, 0, 12, 0, 5, 0, 3, 0};
  const std::vector<CaseWeights> first = robust_weights({experiment}, r, {});
  const Experiment lighter = weighted({experiment}, first);
  EXPECT_FALSE(lighter.cases[0].positions[0].is_outlier);
  EXPECT_TRUE(lighter.cases[0].positions[1].is_outlier);
  std::vector<double> now = r;
  for (size_t i = 3; i < 6; ++i) now[i] /= lighter.cases[0].positions[1].sigma[0];
  for (size_t i = 6; i < 9; ++i) now[i] /= lighter.cases[0].force_sigma[0];
  const std::vector<CaseWeights> second = robust_weights({lighter}, now, first);
  EXPECT_DOUBLE_EQ(first[0].positions[0], 1);
  EXPECT_NEAR(second[0].positions[1], robust_weight(169), 1e-12);
  EXPECT_NEAR(second[0].force, robust_weight(9), 1e-12);
}

}  // namespace
}  // namespace aspic

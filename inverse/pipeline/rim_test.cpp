// Layers under sliding discs, whose rims change the force.
#include <gtest/gtest.h>

#include "data/stated_errors.h"
#include "indenter/indenter_depth.h"
#include "pipeline/quick_plan_test.h"

namespace aspic {
namespace {

constexpr double kRadius = 0.025;

// Measured with rims of a fifth of the radius. The fit assumes the given rim and standard deviation of its logarithm.
DataSet layers_under_discs(double assumed, double sigma) {
  DataSet data{.name = "layers", .experiment = {indented_block(4)}};
  Experiment& e = data.experiment;
  for (LoadCase& load : e.cases) {
    load.indenter = Indenter{.shape = IndenterShape::disc,
                             .contact = IndenterContact::sliding,
                             .radius = kRadius,
                             .stiffness = 200 * kSoftLayer / kRadius,
                             .rim = 0.2 * kRadius};
    load.layer_sigma = 0;
    load.tip = "disc";
    const double depth = load.touch.center[1] - load.pose.center[1];
    load.touch.center[1] = 0.1, load.pose.center[1] = 0.1 - depth;
    load.force_sigma = {{0.01, 0.01, 0.01}};
  }
  measure(e);
  for (LoadCase& load : e.cases) load.indenter->rim = assumed, load.rim_sigma = sigma;
  e.errors = systematic_errors(e.cases, {});
  return data;
}

FitOutcome fitted(const DataSet& data) {
  FitPlan plan = quick_plan();
  plan.uncertainty = true;
  plan.mesh_errors = plan.law_errors = false;
  return fit_material(data, plan, {}, {});
}

int contained(const FitOutcome& outcome) {
  int count = 0;
  for (int k = 0; k < 2; ++k) {
    const std::optional<Interval>& interval = outcome.quantities.at(0).rows.at(static_cast<size_t>(k)).interval;
    const double truth = k == 0 ? kSoftLayer : kStiffLayer;
    count += interval && interval->lower < truth && truth < interval->upper;
  }
  return count;
}

TEST(Rims, StatedRimsFindTheLayers) {
  const FitOutcome outcome = fitted(layers_under_discs(0.2 * kRadius, 0));
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  EXPECT_NEAR(outcome.quantities[0].rows[0].value, kSoftLayer, 0.005 * kSoftLayer);
  EXPECT_NEAR(outcome.quantities[0].rows[1].value, kStiffLayer, 0.005 * kStiffLayer);
}

TEST(Rims, IntervalsContainTheEffectOfUnstatedRims) {
  const FitOutcome outcome = fitted(layers_under_discs(kUsualRim * kRadius, kRimSigma));
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  EXPECT_EQ(contained(outcome), 2);
  ASSERT_EQ(outcome.errors.size(), 1u);
  EXPECT_EQ(outcome.errors[0].name, "rim of 'disc'");
  EXPECT_EQ(outcome.errors[0].unit, "m");
  // A wrong rim that counts as exact is found out by the layers.
  EXPECT_LT(contained(fitted(layers_under_discs(kUsualRim * kRadius, 0))), 2);
}

}  // namespace
}  // namespace aspic

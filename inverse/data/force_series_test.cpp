#include "data/force_series.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "base/error.h"

namespace aspic {
namespace {

using testing::HasSubstr;

// 10 s at 100 Hz: 0 N until 2 s, a ramp to 5 N at 4 s, a hold until 7 s, a ramp to 0 N at 9 s; with alternating noise.
ForceSeries hold(double noise) {
  ForceSeries series{.file = "load.csv", .is_axial = true};
  for (int i = 0; i <= 1000; ++i) {
    const double t = 0.01 * i;
    const double force = t < 2 ? 0 : t < 4 ? 2.5 * (t - 2) : t < 7 ? 5 : std::max(0.0, 5 - 2.5 * (t - 7));
    series.times.push_back(t);
    series.values.push_back({{force + noise * std::sin(37.0 * i), 0, 0}});
  }
  return series;
}

TEST(SteadyForces, FindsPlateau) {
  const ForceSeries series = hold(0.02);
  const SteadyForce force = steady_force(series, 5, default_duration(series));
  EXPECT_TRUE(force.is_steady) << force.reason;
  EXPECT_NEAR(force.mean[0], 5, 0.01);
  EXPECT_NEAR(force.sigma[0], 0.02 / std::sqrt(2.0), 0.01);
  EXPECT_THAT(force.reason, HasSubstr("steady within 0."));
}

TEST(SteadyForces, RefusesRampAndNamesPlateau) {
  const ForceSeries series = hold(0.02);
  const SteadyForce force = steady_force(series, 3.2, default_duration(series));
  EXPECT_FALSE(force.is_steady);
  EXPECT_THAT(force.reason, HasSubstr("not steady: the force stays within"));
  EXPECT_THAT(force.reason, HasSubstr("the nearest steady state is at"));
}

TEST(SteadyForces, RefusesDriftBelowNoise) {
  ForceSeries series{.file = "load.csv", .is_axial = true};
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.2);
  for (int i = 0; i <= 1000; ++i) {
    series.times.push_back(0.01 * i);
    series.values.push_back({{0.001 * i + noise(random), 0, 0}});
  }
  const SteadyForce force = steady_force(series, 5, default_duration(series));
  EXPECT_FALSE(force.is_steady);
  EXPECT_THAT(force.reason, HasSubstr("drifts by"));
}

// The drift leaves the band of the steady force only after the default duration.
TEST(SteadyForces, RefusesDriftWithinTheBand) {
  ForceSeries series = hold(0.002);
  for (size_t i = 0; i < series.times.size(); ++i) series.values[i][0] += 0.1 * series.times[i];
  const SteadyForce force = steady_force(series, 5.5, default_duration(series));
  EXPECT_FALSE(force.is_steady) << force.reason;
  EXPECT_THAT(force.reason, HasSubstr("drifts by"));
  EXPECT_THAT(force.reason, HasSubstr("subtract its drift"));
}

TEST(SteadyForces, NeedsTheGivenDuration) {
  EXPECT_TRUE(steady_force(hold(0), 5, 2.9).is_steady);
  EXPECT_FALSE(steady_force(hold(0), 5, 3.2).is_steady);
}

TEST(SteadyForces, RefusesTimeOutsideSeries) {
  EXPECT_THROW(steady_force(hold(0), 11, 0.5), InvalidInput);
  EXPECT_THROW(resampled(hold(0), -1), InvalidInput);
}

TEST(ForceResampling, InterpolatesBetweenSamples) {
  const ForceSeries series{.file = "load.csv", .times = {0, 1}, .values = {{{0, 0, 0}}, {{2, 4, 6}}}};
  EXPECT_DOUBLE_EQ(resampled(series, 0.25)[1], 1);
  EXPECT_DOUBLE_EQ(resampled(series, 1)[2], 6);
}

}  // namespace
}  // namespace aspic

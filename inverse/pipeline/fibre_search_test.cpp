// Directions of fibres: the tangent frame, the search over starts, cones of confidence.
#include "pipeline/fibre_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/folder_test.h"
#include "model/quantity.h"
#include "model/tangent_frame.h"
#include "pipeline/quick_plan_test.h"

namespace aspic {
namespace {

using ::testing::HasSubstr;

TEST(TangentFrame, DirectionsAreUnitVectorsWithExactSlopes) {
  for (const Vec3d& center : {Vec3d{{0, 0, 2}}, Vec3d{{1, -1, 1}}, Vec3d{{-0.3, 0.01, 0}}}) {
    const TangentFrame frame(center);
    EXPECT_NEAR(norm(frame.direction(0, 0) - (1 / norm(center)) * center), 0, 1e-15);
    EXPECT_NEAR(angle_between(frame.direction(1, 0), frame.direction(0, 0)), std::numbers::pi / 4, 1e-14);
    constexpr double kStep = 1e-5, u = 0.7, v = -1.2;
    EXPECT_NEAR(norm(frame.direction(u, v)), 1, 1e-15);
    const Vec3d du = (0.5 / kStep) * (frame.direction(u + kStep, v) - frame.direction(u - kStep, v));
    const Vec3d dv = (0.5 / kStep) * (frame.direction(u, v + kStep) - frame.direction(u, v - kStep));
    EXPECT_NEAR(norm(du - frame.slope(0, u, v)), 0, 1e-9);
    EXPECT_NEAR(norm(dv - frame.slope(1, u, v)), 0, 1e-9);
  }
}

TEST(FibreCone, CoversTheWorseTiltOrEverything) {
  const TangentFrame frame(Vec3d{{1, 2, 3}});
  const Vec3d du = frame.slope(0, 0, 0), dv = frame.slope(1, 0, 0);
  EXPECT_NEAR(cone_of({1e-4, 0, 4e-4}, du, dv), 2.4477 * 0.02, 1e-5);
  EXPECT_NEAR(cone_of({2.5e-4, 1.5e-4, 2.5e-4}, du, dv), 2.4477 * 0.02, 1e-5);  // rotated by 45 degrees
  EXPECT_EQ(cone_of({1e-4, 0, 9}, du, dv), std::numbers::pi / 2);
}

FitPlan fibrous_plan(const std::vector<std::string>& parameters) {
  FitPlan plan = quick_plan(parameters);
  plan.model = "neo_hookean_fibres";
  return completed(plan, block().experiment);
}

// Minima at every start; the objective falls toward the truth of each region.
FitFibres toward(const std::vector<Vec3d>& truth, int& fits) {
  return [&truth, &fits](FitPlan& plan, const std::string&, const std::string&) {
    ++fits;
    FibreTrial trial;
    trial.report.status = Status::converged;
    for (size_t r = 0; r < truth.size(); ++r)
      trial.report.misfit += 100 * angle_between(truth[r], plan.fibre_directions[r]);
    return trial;
  };
}

TEST(FibreSearch, FindsTheBestStartOfEachRegion) {
  const std::vector<Vec3d> truth = {{{0.1, 0.2, -1}}, {{1, 0.2, 0.5}}};
  int fits = 0;
  FitPlan plan = fibrous_plan({"young=uniform", "fibre_direction=regions"});
  const FibreSearch found = search_fibres(plan, 2, toward(truth, fits));
  EXPECT_EQ(found.failure, "");
  ASSERT_EQ(plan.fibre_directions.size(), 2u);
  for (size_t r = 0; r < 2; ++r)
    EXPECT_LT(angle_between(plan.fibre_directions[r], truth[r]), 37.4 * std::numbers::pi / 180);
  EXPECT_EQ(fits, 6 + 2 * 5);
  for (size_t k = 1; k < found.minima.size(); ++k) EXPECT_LE(found.minima[k - 1].objective, found.minima[k].objective);
}

TEST(FibreSearch, ReportsTheFirstFailureOfAll) {
  FitPlan plan = fibrous_plan({"young=uniform"});
  const FibreSearch found = search_fibres(plan, 1, [](FitPlan&, const std::string& name, const std::string&) {
    return FibreTrial{{}, name + " failed"};
  });
  EXPECT_EQ(found.failure, "fibres_0 failed");
}

TEST(FitPlan, CompletesDirectionsOfFibres) {
  const FitPlan plan = fibrous_plan({"young=uniform", "fibre_direction=regions"});
  int tilts = 0;
  for (const FitParameter& u : plan.parameters) {
    EXPECT_FALSE(u.quantity.starts_with("fibre_x") || u.quantity == kFibreDirection);
    if (!is_tilt(u.quantity)) continue;
    ++tilts;
    EXPECT_EQ(u.parameterization, Parameterization::regions);
  }
  EXPECT_EQ(tilts, 2);
  EXPECT_TRUE(fits_fibres(completed(plan, block().experiment)));
  const auto refused = [](const std::string& model, const std::string& direction) {
    FitPlan bad = quick_plan({direction});
    bad.model = model;
    return message_of([&] { completed(bad, block().experiment); });
  };
  EXPECT_THAT(refused("neo_hookean", "fibre_direction=regions"), HasSubstr("neo_hookean is isotropic"));
  EXPECT_THAT(refused("neo_hookean_fibres", "fibre_direction=tets"), HasSubstr("uniform or per region"));
  EXPECT_THAT(refused("neo_hookean_fibres", "fibre_x=uniform"), HasSubstr("use fibre_direction"));
  FitPlan given = quick_plan({"young=uniform"});
  given.model = "neo_hookean_fibres";
  given.known.emplace_back("fibre_z", 1.0);
  given = completed(given, block().experiment);
  EXPECT_FALSE(fits_fibres(given));
  EXPECT_EQ(known_parameters(given, block().experiment)[5].extra[4], 1);
  EXPECT_EQ(known_parameters(given, block().experiment)[5].extra[2], 0);
}

}  // namespace
}  // namespace aspic

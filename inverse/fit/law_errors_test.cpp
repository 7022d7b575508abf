#include "fit/law_errors.h"

#include <gtest/gtest.h>

#include "mesh/generators.h"

namespace aspic {
namespace {

// A bar of nu = 0.4 that a grip stretches; a marker in the middle of a side.
Experiment stretched(double strain) {
  Experiment e;
  e.mesh = make_box({{0, 0, 0}}, {{0.02, 0.02, 0.08}}, {2, 2, 8});
  e.density.assign(e.mesh.tets.size(), 1000);
  LoadCase load{.name = "pull", .group = "pull"};
  load.grip.emplace();
  load.grip->displacement = {{0, 0, 0.08 * strain}};
  for (int v = 0; v < e.mesh.vertex_count(); ++v) {
    const Vec3d& X = e.mesh.rest[v];
    if (X[2] < 1e-9) e.fixed.push_back(v);
    if (X[2] > 0.08 - 1e-9) load.grip->vertices.push_back(v);
    if (norm(X - Vec3d{{0.02, 0.01, 0.04}}) < 1e-9) e.markers.push_back({{v, v, v}, {1, 0, 0}});
  }
  load.positions.push_back({0, {}, {{1e-5, 1e-5, 1e-5}}});
  load.force = Vec3d{};
  load.force_sigma = {{0.01, 0.01, 0.01}};
  e.cases.push_back(load);
  return e;
}

CommonError error_at(double strain) {
  const Experiment e = stretched(strain);
  const std::vector<MaterialParameters> one(e.mesh.tets.size(), {lame_from_young_poisson(6e4, 0.4), {}});
  const LawErrors errors = law_errors(e, "neo_hookean", one);
  EXPECT_EQ(errors.failure, "");
  return errors.cases.at(0);
}

// Uniaxial stretch of both laws, solved for the free width with scipy.optimize: the forces differ by 1.09 % at a strain
// of 6 % and by 0.37 % at 2 % (tests/oracle uses the same isochoric form). Clamped ends change this a little.
TEST(LawErrors, AreDifferencesOfTwoLawsThatGrowWithTheSquareOfTheLoad) {
  const CommonError small = error_at(0.02), large = error_at(0.06);
  const double force = 6e4 * 4e-4;  // at a strain of 1
  EXPECT_NEAR(small.wrench.force[2], -0.0037 * 0.98 * 0.02 * force, 0.3 * 0.0037 * 0.02 * force);
  EXPECT_NEAR(large.wrench.force[2], -0.0108 * 0.95 * 0.06 * force, 0.3 * 0.0108 * 0.06 * force);
  EXPECT_NEAR(large.markers.at(0)[0] / small.markers.at(0)[0], 9, 1.5);
}

TEST(LawErrors, LawsWithShapeParametersHaveNoRival) {
  EXPECT_EQ(rival_of("yeoh"), "");
  const Experiment e = stretched(0.02);
  const std::vector<MaterialParameters> one(e.mesh.tets.size(), {lame_from_young_poisson(6e4, 0.4), {0, 0}});
  const LawErrors errors = law_errors(e, "yeoh", one);
  EXPECT_TRUE(errors.cases.empty());
  EXPECT_EQ(errors.failure, "");
}

}  // namespace
}  // namespace aspic

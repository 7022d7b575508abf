#include "estimate/law_errors.h"

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

std::vector<CommonError> errors_at(double strain) {
  const Experiment e = stretched(strain);
  const std::vector<MaterialParameters> one(e.mesh.tets.size(), {lame_from_young_poisson(6e4, 0.4), {}});
  const LawErrors errors = law_errors(e, "neo_hookean", one);
  EXPECT_EQ(errors.failure, "");
  return errors.cases.at(0);
}

// Uniaxial stretch, solved for the free width with scipy.optimize: the forces of both laws differ by 1.09 % at a strain
// of 6 %. Clamped ends change this a little.
TEST(LawErrors, AreDifferencesOfLawsThatGrowWithTheLoad) {
  const std::vector<CommonError> small = errors_at(0.02), large = errors_at(0.06);
  ASSERT_EQ(large.size(), 2u);
  const double force = 0.06 * 0.95 * 6e4 * 4e-4;
  EXPECT_NEAR(large[0].wrench.force[2], -0.0109 * force, 0.3 * 0.0109 * force);
  EXPECT_NEAR(large[0].markers.at(0)[0] / small[0].markers.at(0)[0], 9, 1.5) << "of second order in the strain";
  // mu/2 b x^2 with x about 3 e^2 (1 - 2 / 3 e) adds 18 mu b e^3 = 6.4 E b e^3 to the stress.
  EXPECT_NEAR(large[1].wrench.force[2], 6.4 * 6e4 * 4e-4 * kStiffening * 0.06 * 0.06 * 0.06, 0.3 * 0.0083);
  EXPECT_NEAR(large[1].wrench.force[2] / small[1].wrench.force[2], 27, 4) << "of third order";
}

TEST(LawErrors, LawsWithShapeParametersHaveNone) {
  const Experiment e = stretched(0.02);
  const std::vector<MaterialParameters> one(e.mesh.tets.size(), {lame_from_young_poisson(6e4, 0.4), {0, 0}});
  const LawErrors errors = law_errors(e, "yeoh", one);
  EXPECT_TRUE(errors.cases.empty());
  EXPECT_EQ(errors.failure, "");
}

}  // namespace
}  // namespace aspic

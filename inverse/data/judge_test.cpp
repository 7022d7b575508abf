#include "data/judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/generators.h"

namespace aspic {
namespace {

// Unit cube whose upper half is `contrast` times as stiff as the lower half.
FittedMaterial layers(int cells, double contrast, double level = 1e4) {
  FittedMaterial material{.mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {cells, cells, cells}), .model = "neo_hookean"};
  std::vector<double> young;
  for (const Tet& tet : material.mesh.tets) {
    double height = 0;
    for (const int v : tet) height += material.mesh.rest[v][2] / 4;
    young.push_back(height > 0.5 ? contrast * level : level);
  }
  material.values = {{"young", young}, {"poisson", std::vector<double>(young.size(), 0.4)}};
  return material;
}

TEST(Judge, TheTruthHasNoErrorOnAnotherMesh) {
  const std::vector<Judgment> found = judge(layers(4, 5), layers(6, 5));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].quantity, "young");
  EXPECT_NEAR(found[0].error, 0, 1e-12);
  EXPECT_NEAR(found[0].relative_error, 0, 1e-12);
  EXPECT_NEAR(found[0].contrast(), 5, 1e-9);
  EXPECT_NEAR(found[0].true_contrast(), 5, 1e-9);
  EXPECT_DOUBLE_EQ(found[0].overlap, 1);
  ASSERT_EQ(found[0].phases.size(), 2u);
  EXPECT_NEAR(found[0].phases[1].share, 0.5, 1e-12);
  EXPECT_EQ(found[1].relative_error, -1) << "Poisson's ratio is the same everywhere";
  EXPECT_LT(found[0].coverage, 0) << "no intervals";
}

TEST(Judge, OneValueMissesLayersByHalfLogContrast) {
  FittedMaterial one = layers(4, 1, 2e4);
  const Judgment found = judge(one, layers(4, 4))[0];
  EXPECT_NEAR(found.error, std::log(2.0), 1e-12);
  EXPECT_NEAR(found.relative_error, 1, 1e-12);
  EXPECT_NEAR(found.level, 0, 1e-12);
  EXPECT_NEAR(found.largest, std::log(2.0), 1e-12);
  EXPECT_NEAR(found.contrast(), 1, 1e-12);
  EXPECT_LT(found.overlap, 0.51) << "nothing is separated from the rest";
}

TEST(Judge, AWrongContrastIsOnlyThat) {
  const Judgment found = judge(layers(4, 3), layers(4, 4))[0];
  EXPECT_NEAR(found.contrast(), 3, 1e-9);
  EXPECT_NEAR(found.phases[1].fitted, 3e4, 1e-6);
  EXPECT_DOUBLE_EQ(found.overlap, 1);
  EXPECT_NEAR(found.error, std::log(4.0 / 3.0) / std::sqrt(2.0), 1e-12);
}

TEST(Judge, CountsTetsWhoseIntervalHoldsTheTruth) {
  FittedMaterial fitted = layers(4, 3);
  std::vector<double> sigma(fitted.mesh.tets.size(), 0.01);
  fitted.further = {{"young_deviation", sigma}};
  EXPECT_DOUBLE_EQ(judge(fitted, layers(4, 4))[0].coverage, 0.5);
  std::fill(sigma.begin(), sigma.end(), 0.15);  // log(4/3) = 0.288 < 1.96 * 0.15
  fitted.further = {{"young_deviation", sigma}};
  EXPECT_DOUBLE_EQ(judge(fitted, layers(4, 4))[0].coverage, 1);
}

TEST(Judge, SharedTetHasMeanLogarithmOfPhases) {
  const Judgment found = judge(layers(3, 1, 2e4), layers(8, 4))[0];  // both phases share the middle layer of cells
  EXPECT_NEAR(found.level, 0, 0.02);
  EXPECT_NEAR(found.error, std::log(2.0) * std::sqrt(2.0 / 3 + 1.0 / 3 * 0.4), 0.1);
  EXPECT_NEAR(found.phases[0].fitted, 2e4, 1e-6);
}

TEST(Judge, AFieldHasNoPhases) {
  FittedMaterial truth = layers(4, 1);
  for (size_t t = 0; t < truth.mesh.tets.size(); ++t) truth.values[0].second[t] *= 1 + 0.01 * static_cast<double>(t);
  const Judgment found = judge(truth, truth)[0];
  EXPECT_TRUE(found.phases.empty());
  EXPECT_EQ(found.contrast(), 1);
  EXPECT_LT(found.overlap, 0);
  EXPECT_NEAR(found.error, 0, 1e-12);
}

}  // namespace
}  // namespace aspic

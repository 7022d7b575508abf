#include "estimate/cross_validation.h"

#include <gmock/gmock.h>

#include "math/vectors.h"
#include "model/common_errors.h"
#include "model/indented_block_test.h"

namespace aspic {
namespace {

using test::IndentedBlock;
using testing::ElementsAre;
using testing::HasSubstr;

struct HeldOutStudy {
  IndentedBlock block;
  explicit HeldOutStudy(double noise = 0.01) {
    for (const IndentedBlock::Site& site : IndentedBlock::sites())
      for (const double depth : {0.003, 0.006}) block.add_indentation(site, depth, noise);
  }
  CrossValidation validate(const ParameterMap& map, double weight = 1) const {
    const auto prior = make_regularizer(block.experiment.mesh, map, {});
    Misfit misfit(block.experiment, map);
    const FitReport fitted = fit(misfit, *prior, map.guess(), {.weight = weight});
    EXPECT_TRUE(is_success(fitted.status)) << fitted.message;
    return cross_validate({block.experiment}, map, *prior, fitted);
  }
  void measure(const std::vector<double>& log_young) {
    std::mt19937_64 random(1);
    block.measure(block.map(), log_young, random);
  }
  // Stiff on one side.
  std::vector<double> halves(double contrast) const {
    std::vector<double> z;
    for (const Tet& tet : block.experiment.mesh.tets) {
      double x = 0;
      for (const int v : tet) x += block.experiment.mesh.rest[v][0] / 4;
      z.push_back(std::log(IndentedBlock::kYoung * (x > IndentedBlock::kSide / 2 ? contrast : 1)));
    }
    return z;
  }
};

TEST(CrossValidation, OfTheRightModelLeavesTheNoise) {
  HeldOutStudy study;
  study.measure(study.halves(1));
  const CrossValidation result =
      study.validate(study.block.map({{.parameterization = Parameterization::uniform, .guess = 1e4}}));
  ASSERT_EQ(result.groups.size(), 4u);
  EXPECT_TRUE(result.warnings.empty());
  for (const HeldOut& h : result.groups) {
    ASSERT_TRUE(h.ok) << h.failure;
    EXPECT_EQ(h.forces.count, 2);
    EXPECT_EQ(h.positions.count, 2 * static_cast<int>(study.block.experiment.markers.size()));
    EXPECT_NEAR(h.positions.error, h.positions.noise, 0.1 * h.positions.noise);
    EXPECT_LT(h.forces.error, 2.5 * h.forces.noise);
    EXPECT_LT(h.positions.relative(), 0.02);
    EXPECT_GE(h.largest_error, h.positions.error);
    EXPECT_NE(h.p, result.groups[0].p == h.p ? result.groups[1].p : result.groups[0].p);
  }
  EXPECT_LT(result.position_error, 0.02);
  EXPECT_LT(result.force_error, 0.05);
}

TEST(CrossValidation, DetectsTooSimpleModels) {
  HeldOutStudy study(0.005);
  study.measure(study.halves(4));
  const CrossValidation uniform =
      study.validate(study.block.map({{.parameterization = Parameterization::uniform, .guess = 1e4}}));
  const CrossValidation handles = study.validate(
      study.block.map({{.parameterization = Parameterization::handles, .handles = 8, .guess = 1e4}}), 0.01);
  EXPECT_GT(uniform.position_error, 1.5 * handles.position_error);
  EXPECT_GT(uniform.force_error, 3 * handles.force_error);
}

TEST(CrossValidation, ReportsAGroupThatCannotBePredicted) {
  HeldOutStudy study;
  study.measure(study.halves(1));
  for (LoadCase& load : study.block.experiment.cases)  // through the table
    if (load.group == "left") load.pose.center[2] = -5;
  const ParameterMap map = study.block.map({{.parameterization = Parameterization::uniform, .guess = 2e4}});
  const auto prior = make_regularizer(study.block.experiment.mesh, map, {});
  bool is_done = false;
  const auto observe = [&](int group, int groups, const std::string& name) {
    EXPECT_EQ(groups, 4);
    EXPECT_EQ(name == "left", group == 0);
    is_done = group == 1;
  };
  const CrossValidation result = cross_validate(
      {study.block.experiment}, map, *prior, {.p = {map.guess().begin(), map.guess().end()}, .weight = 1},
      {{.stop = StopToken([&] { return is_done; })}, {.max_iterations = 20}, observe});
  ASSERT_EQ(result.groups.size(), 1u);
  EXPECT_FALSE(result.groups[0].ok);
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("left could not be predicted")));
  EXPECT_LT(result.position_error, 0);
}

// Held-out errors and noise of forces contain no component that was not measured.
TEST(CrossValidation, ComparesForcesAlongTheGauge) {
  HeldOutStudy study(0.001);
  study.measure(study.halves(1));
  const std::string wrong = study.block.experiment.cases.front().group;
  for (LoadCase& load : study.block.experiment.cases) {
    load.gauge = load.pose.axis;
    load.force = (load.group == wrong ? 1.4 : 1) * dot(*load.gauge, *load.force) * *load.gauge;
  }
  const CrossValidation result =
      study.validate(study.block.map({{.parameterization = Parameterization::uniform, .guess = 1e4}}));
  for (const HeldOut& h : result.groups) {
    if (h.group == wrong) {
      EXPECT_GT(h.forces.error, 20 * h.forces.noise);
    }
    EXPECT_LT(h.forces.noise, 0.01 * h.forces.peak);
  }
}

// All fits without a group start so.
TEST(CrossValidation, StatesOfAllCasesStartTheOthers) {
  HeldOutStudy study;
  study.measure(study.halves(1));
  const Experiment& all = study.block.experiment;
  const ParameterMap map = study.block.map({{.parameterization = Parameterization::uniform, .guess = 1e4}});
  const auto is_seen = [](const LoadCase& c) { return c.group != "right"; };
  const Experiment seen = subset(all, is_seen);
  Misfit whole(all, map), cold(seen, map), warm(seen, map);
  std::vector<double> r(static_cast<size_t>(whole.residual_count()));
  ASSERT_TRUE(whole.evaluate(map.guess(), r));
  warm.set_state(subset(all, whole.state(), is_seen));
  r.resize(static_cast<size_t>(warm.residual_count()));
  ASSERT_TRUE(cold.evaluate(map.guess(), r) && warm.evaluate(map.guess(), r));
  EXPECT_GT(cold.counts().newton_iterations, 3 * std::ssize(seen.cases));
  EXPECT_LE(warm.counts().newton_iterations, std::ssize(seen.cases));
}

// J of the fit to all cases serves the others, whose minima are near.
TEST(CrossValidation, FitsOtherGroupsLikeSeparateFits) {
  HeldOutStudy study;
  study.measure(study.halves(1));
  const Experiment& all = study.block.experiment;
  const ParameterMap map = study.block.map({{.parameterization = Parameterization::uniform, .guess = 1e4}});
  const auto prior = make_regularizer(all.mesh, map, {});
  for (const HeldOut& h : study.validate(map).groups) {
    const Experiment seen = subset(all, [&](const LoadCase& c) { return c.group != h.group; });
    Misfit misfit(seen, map);
    WithUncertainLayers data(misfit);
    const FitReport separate = fit(data, *prior, h.p, {.weight = 1});  // common errors there
    std::vector<double> unit(1, 1.0), column(static_cast<size_t>(data.residual_count()));
    ASSERT_TRUE(h.ok && data.linearize()) << h.failure;
    data.multiply(unit, column);
    const double sigma = 1 / norm(column);
    EXPECT_NEAR(h.p[0], separate.p[0], 0.03 * sigma) << h.group;
  }
}

TEST(CrossValidation, NeedsTwoGroups) {
  IndentedBlock block;
  block.add_indentation(IndentedBlock::sites()[0], 0.003, 0.01);
  block.add_indentation(IndentedBlock::sites()[0], 0.006, 0.01);
  const ParameterMap map = block.map({{.parameterization = Parameterization::uniform, .guess = 1e4}});
  const auto prior = make_regularizer(block.experiment.mesh, map, {});
  const CrossValidation result = cross_validate({block.experiment}, map, *prior, {});
  EXPECT_TRUE(result.groups.empty());
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("one group")));
}

}  // namespace
}  // namespace aspic

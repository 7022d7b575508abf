#include "pipeline/fit_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/folder_test.h"
#include "pipeline/fit_options.h"
#include "pipeline/quick_plan_test.h"
#include "scene/toml_reader.h"

namespace aspic {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(FitPlan, ParametersAreRead) {
  EXPECT_EQ(text_of(parse_parameter("young=tets")), "young=tets");
  EXPECT_EQ(text_of(parse_parameter("b=handles:40")), "b=handles:40");
  EXPECT_EQ(parse_known("poisson=0.45").second, 0.45);
  const auto refused = [](const std::string& text) { return message_of([&] { parse_parameter(text); }); };
  EXPECT_THAT(refused("young"), HasSubstr("give QUANTITY=VALUE"));
  EXPECT_THAT(refused("young=tet"), HasSubstr("did you mean 'tets'?"));
  EXPECT_THAT(refused("young=handles:0"), HasSubstr("whole number above 0"));
  EXPECT_THAT(message_of([] { parse_known("poisson=much"); }), HasSubstr("'much' is not a finite number"));
}

TEST(FitPlan, CorrectedFieldsAreWeighedByTheirEvidence) {
  FitPlan plan = quick_plan({"young=tets"});
  EXPECT_EQ(completed(plan, block().experiment).fit.weight_rule, "auto");
  plan.mesh_errors = true;
  EXPECT_EQ(completed(plan, block().experiment).fit.weight_rule, "evidence");
  plan.fit.weight_rule = "discrepancy";
  EXPECT_EQ(completed(plan, block().experiment).fit.weight_rule, "discrepancy");
  EXPECT_EQ(completed(quick_plan({"young=regions"}), block().experiment).fit.weight_rule, "auto");
}

TEST(FitPlan, WeightExcludesItsRule) {
  const auto read = [](const std::string& text) {
    FitPlan plan;
    read_fit_options(read_toml(text, "aspic.fit.toml"), "aspic.fit.toml", plan);
    return plan;
  };
  EXPECT_THAT(message_of([&] { read("weight = 3\nrule = \"evidence\"\n"); }),
              HasSubstr("rule = \"evidence\" chooses the weight, but weight is a number; remove one of the two"));
  EXPECT_EQ(read("weight = 3\nrule = \"auto\"\n").fit.weight, 3);
  EXPECT_EQ(read("weight = \"auto\"\nrule = \"evidence\"\n").fit.weight_rule, "evidence");
}

TEST(FitPlan, WhatDoesNotFitTogetherIsRefused) {
  const auto refused = [](const FitPlan& plan) { return message_of([&] { completed(plan, block().experiment); }); };
  EXPECT_THAT(refused(quick_plan({"yuong=tets"})), HasSubstr("did you mean 'young'?"));
  EXPECT_THAT(refused(quick_plan({"b=uniform"})), HasSubstr("'b' is not a quantity of the model neo_hookean"));
  EXPECT_THAT(refused(quick_plan({"poisson=uniform"})), HasSubstr("in both --known and --unknown"));
  EXPECT_THAT(refused(quick_plan({"young=tets", "young=uniform"})), HasSubstr("fitted twice"));
  FitPlan plan = quick_plan();
  plan.known = {{"poisson", 0.5}};
  EXPECT_THAT(refused(plan), HasSubstr("poisson = 0.5; must be"));
  plan = quick_plan();
  plan.left_out = {"poke 9"};
  EXPECT_THAT(refused(plan), HasSubstr("the data have no such group"));
  plan.left_out = {"poke 1", "poke 2", "poke 3"};
  EXPECT_THAT(refused(plan), HasSubstr("leaves no case"));
  plan = quick_plan();
  plan.model = "neo_hokean";
  EXPECT_THAT(refused(plan), HasSubstr("did you mean 'neo_hookean'?"));
  Measured bare = block().experiment;
  bare.mesh.region.clear();
  EXPECT_THAT(message_of([&] { completed(quick_plan(), bare); }), HasSubstr("no region labels"));
  EXPECT_THAT(groups_of(block().experiment), ElementsAre("poke 1", "poke 2", "poke 3"));
}

}  // namespace
}  // namespace aspic

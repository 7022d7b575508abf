#include "pipeline/law_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace aspic {
namespace {

using ::testing::HasSubstr;

LawTrial trial(std::string law, int parameters, double squares, std::vector<double> held_out) {
  LawTrial t{.law = std::move(law), .failure = {}, .values = {}, .parameters = parameters, .residuals = 300};
  t.squares = squares;
  t.information.assign(static_cast<size_t>(parameters), 1e3);
  for (const double squares_of_group : held_out) {
    PredictiveResiduals group{.squares = squares_of_group, .Jr = {0}, .JJ = {0}, .fitted = {1}, .prior = {1}};
    group.is_valid = std::isfinite(squares_of_group);
    t.held_out.push_back(std::move(group));
  }
  return t;
}

const LawTrial& chosen(const LawChoice& choice) { return choice.trials.at(static_cast<size_t>(choice.chosen)); }

TEST(LawChoice, PrefersTheSimplestOfEqualLaws) {
  LawChoice choice{.trials = {trial("yeoh", 4, 298, {101, 99, 100}), trial("neo_hookean", 2, 300, {100, 100, 101})}};
  choice.strain = 0.06;
  judge_laws(choice);
  EXPECT_EQ(chosen(choice).law, "neo_hookean");
  // Two more well-determined values cost log(1 + d) of evidence, more than the misfit gains.
  EXPECT_FALSE(choice.trials[0].is_as_good);
  EXPECT_THAT(choice.trials[0].verdict, HasSubstr("less probable"));
}

TEST(LawChoice, UndeterminedValuesAreNotDistinguished) {
  LawChoice choice{.trials = {trial("neo_hookean", 2, 300, {100, 100, 101}), trial("yeoh", 4, 299, {101, 99, 100})}};
  choice.trials[1].information = {1e3, 1e3, 0.2, 0.1};
  choice.strain = 0.06;
  judge_laws(choice);
  EXPECT_EQ(chosen(choice).law, "neo_hookean");
  EXPECT_TRUE(choice.trials[1].is_as_good);
  EXPECT_THAT(choice.text, HasSubstr("do not distinguish neo_hookean from yeoh (strains reach 6 %)"));
}

TEST(LawChoice, LargeDifferencesDecide) {
  LawChoice choice{.trials = {trial("neo_hookean", 2, 3000, {900, 1200, 1000}), trial("yeoh", 4, 301, {102, 99, 104})}};
  judge_laws(choice);
  EXPECT_EQ(chosen(choice).law, "yeoh");
  EXPECT_GT(choice.trials[0].evidence_loss, 1000);
  EXPECT_THAT(choice.text, HasSubstr("yeoh is better than neo_hookean"));
}

// Evidence alone would take the second law, but it predicts every held-out group worse.
TEST(LawChoice, HeldOutGroupsOverruleTheEvidence) {
  LawChoice choice{.trials = {trial("gent", 3, 310, {100, 100, 100}), trial("ogden", 3, 280, {180, 190, 200})}};
  judge_laws(choice);
  EXPECT_EQ(chosen(choice).law, "gent");
  EXPECT_THAT(choice.trials[1].verdict, HasSubstr("predicts held-out groups worse"));
}

TEST(LawChoice, FailedLawsAreRowsWithTheirReason) {
  LawChoice choice{.trials = {trial("gent", 3, 300, {100, 100, 100}), trial("fung", 3, 300, {})}};
  choice.trials[1].failure = "no equilibrium";
  judge_laws(choice);
  EXPECT_EQ(chosen(choice).law, "gent");
  EXPECT_EQ(choice.trials[1].verdict, "failed: no equilibrium");
  choice.trials[0].failure = "another reason";
  judge_laws(choice);
  EXPECT_EQ(choice.chosen, -1);
  EXPECT_EQ(choice.text, "No law could be fitted.");
}

TEST(LawChoice, UnpredictedGroupsExcludeALaw) {
  LawChoice choice{.trials = {trial("gent", 3, 300, {100, std::numeric_limits<double>::infinity(), 100}),
                              trial("yeoh", 4, 310, {100, 100, 100})}};
  judge_laws(choice);
  EXPECT_EQ(chosen(choice).law, "yeoh");
}

// The first law is simpler and predicts better, but its material is unreliable.
TEST(LawChoice, NeverPrefersALawWithABadVerdict) {
  LawChoice choice{.trials = {trial("neo_hookean", 2, 280, {90, 90, 90}), trial("gent", 3, 300, {100, 100, 100}),
                              trial("yeoh", 4, 301, {100, 100, 101})}};
  choice.trials[2].information = {1e3, 1e3, 1e3, 0.1};
  judge_laws(choice);
  EXPECT_EQ(chosen(choice).law, "neo_hookean");
  choice.trials[0].against = "poisson is at its bound";
  judge_laws(choice);
  EXPECT_EQ(chosen(choice).law, "gent");
  EXPECT_FALSE(choice.trials[0].is_as_good);
  EXPECT_TRUE(choice.trials[2].is_as_good) << "compared with the candidates alone";
  EXPECT_EQ(choice.trials[0].verdict, "its verdict is bad: poisson is at its bound");
  EXPECT_THAT(choice.text, HasSubstr("do not distinguish gent from yeoh"));
  EXPECT_THAT(choice.text,
              HasSubstr("neo_hookean would be preferred, but its verdict is bad: poisson is at its bound."));
}

TEST(LawChoice, ReportsThatNoLawHasAGoodVerdict) {
  LawChoice choice{.trials = {trial("neo_hookean", 2, 280, {90, 90, 90}), trial("gent", 3, 300, {100, 100, 100})}};
  for (LawTrial& t : choice.trials) t.against = "young is at its bound";
  choice.trials.push_back(trial("fung", 3, 300, {}));
  choice.trials.back().failure = "no equilibrium";
  judge_laws(choice);
  EXPECT_EQ(chosen(choice).law, "neo_hookean");
  EXPECT_EQ(choice.trials[0].verdict, "chosen, but its verdict is bad: young is at its bound");
  EXPECT_THAT(choice.text, HasSubstr("No law has a good verdict"));
}

// If no law explains the data, their standard deviations grow, and small differences of |r|^2 decide nothing.
TEST(LawChoice, UnexplainedDataDecideLess) {
  LawChoice choice{
      .trials = {trial("neo_hookean", 2, 30000, {10000, 10100, 9900}), trial("fung", 3, 29900, {10050, 10000, 9950})}};
  choice.trials[1].information = {1e3, 1e3, 1};
  judge_laws(choice);
  EXPECT_NEAR(choice.noise_factor, 10, 0.1);
  EXPECT_EQ(chosen(choice).law, "neo_hookean");
  EXPECT_TRUE(choice.trials[1].is_as_good);
  EXPECT_THAT(choice.text, HasSubstr("No law explains the readings"));
}

}  // namespace
}  // namespace aspic

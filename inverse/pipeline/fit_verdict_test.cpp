// Reasons of the verdict, from hand-made results without solves.
#include "pipeline/fit_verdict.h"

#include <gmock/gmock.h>

#include "data/capture_cases_test.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const DataSet& three_indentations() {
  static const DataSet data = test_data(3, 2);
  return data;
}

// A fit that explains every reading exactly.
FitOutcome perfect(const DataSet& data = three_indentations()) {
  FitOutcome outcome;
  outcome.report.status = Status::converged;
  outcome.report.message = "converged";
  for (const LoadCase& load : data.experiment.cases) {
    CaseOutcome& own = outcome.cases.emplace_back();
    own.ok = true;
    for (const MarkerReading& reading : load.positions) {
      own.markers.push_back(reading.position);
      own.marker_sigma.push_back(reading.sigma);
    }
    own.wrench.force = *load.force;
    own.force_sigma = load.force_sigma;
    outcome.residuals += static_cast<int>(3 * (load.positions.size() + 1));
  }
  return outcome;
}

std::vector<std::string> reasons(const FitOutcome& outcome, const DataSet& data = three_indentations()) {
  std::vector<std::string> names;
  const FitVerdict judged = verdict(data, outcome);
  EXPECT_EQ(judged.is_good(), judged.reasons.empty());
  for (const FitReason& reason : judged.reasons) names.push_back(reason.name);
  return names;
}

CrossValidation held_out(double position_error, double force_error) {
  CrossValidation result;
  result.position_error = position_error;
  result.force_error = force_error;
  return result;
}

// Held-out errors of the third indentation, with peaks of 0.01 m and 1 N.
CrossValidation held_out_indentation(double position_error, double force_error) {
  const std::vector<LoadCase>& cases = three_indentations().experiment.cases;
  CrossValidation result = held_out(position_error, force_error);
  const int readings = static_cast<int>(cases[4].positions.size() + cases[5].positions.size());
  result.groups = {{.group = "poke 3",
                    .ok = true,
                    .positions = {.count = readings, .peak = 0.01, .error = 0.01 * position_error},
                    .forces = {.count = 2, .peak = 1, .error = force_error}}};
  return result;
}

TEST(FitVerdict, IsGoodWhereEverythingIsExplained) {
  const FitVerdict judged = verdict(three_indentations(), perfect());
  EXPECT_TRUE(judged.is_good());
  EXPECT_THAT(judged.text, HasSubstr("explains the readings"));
}

TEST(FitVerdict, InterruptedFitsAreNotGood) {
  FitOutcome outcome = perfect();
  outcome.interrupted = true;
  EXPECT_THAT(reasons(outcome), ElementsAre("interrupted"));
}

TEST(FitVerdict, UnconvergedFitsAreNotGood) {
  FitOutcome outcome = perfect();
  outcome.report.status = Status::iteration_limit;
  EXPECT_THAT(reasons(outcome), ElementsAre("not_converged"));
}

TEST(FitVerdict, MeshErrorsMustSettle) {
  FitOutcome outcome = perfect();
  outcome.mesh_errors_settle = false;
  EXPECT_THAT(reasons(outcome), ElementsAre("mesh_not_settled"));
}

TEST(FitVerdict, ForcesThatTheMeshDoublesAreTooMany) {
  FitOutcome outcome = perfect();
  outcome.cases[4].relative_mesh_error = 0.9;
  EXPECT_THAT(reasons(outcome), ElementsAre());
  outcome.cases[4].relative_mesh_error = 1.1;
  EXPECT_THAT(reasons(outcome), ElementsAre("mesh_too_coarse"));
  EXPECT_THAT(verdict(three_indentations(), outcome).text,
              HasSubstr("'poke 3, depth 1': the mesh changes the force by"));
}

// Data sets above 2000 tets are simulated with linear tets unless they say otherwise.
TEST(FitVerdict, LinearTetsByDefaultAreJudgedByTheirError) {
  DataSet data = three_indentations();
  FitOutcome outcome = perfect(data);
  outcome.plan.mesh_errors = outcome.has_mesh_errors = true;
  outcome.mesh_error = 0.01;
  outcome.cases[4].relative_mesh_error = 0.14;
  EXPECT_THAT(reasons(outcome, data), ElementsAre()) << "the settings choose the order";
  data.is_order_reduced = true;
  EXPECT_THAT(reasons(outcome, data), ElementsAre("linear_tets"));
  EXPECT_THAT(verdict(data, outcome).text,
              testing::AllOf(HasSubstr("may leave an error of 14 %"), HasSubstr("order = 2")));
  EXPECT_DOUBLE_EQ(verdict(data, outcome).reasons[0].value.value_or(0), 0.14);
  outcome.cases[4].relative_mesh_error = 0.04;
  EXPECT_THAT(reasons(outcome, data), ElementsAre());
  outcome.has_mesh_errors = false;
  EXPECT_THAT(verdict(data, outcome).text, HasSubstr("their error is unknown"));
  outcome.plan.mesh_errors = false;
  EXPECT_THAT(reasons(outcome, data), ElementsAre()) << "the material is for this mesh alone";
}

TEST(FitVerdict, ValuesAtTheirBoundsAreNotGood) {
  FitOutcome outcome = perfect();
  outcome.at_bound = {"young in 3 tets"};
  EXPECT_THAT(reasons(outcome), ElementsAre("at_bound"));
  EXPECT_THAT(verdict(three_indentations(), outcome).text, HasSubstr("young in 3 tets is at its bound"));
}

TEST(FitVerdict, FrictionThatNoContactHasIsNotGood) {
  FitOutcome outcome = perfect();
  outcome.errors = {
      {.name = "friction of 'tip'", .value = std::log(15.0), .sigma = 0.2, .prior_sigma = 2, .stated = 0.3}};
  EXPECT_THAT(reasons(outcome), ElementsAre());
  outcome.errors[0].value = std::log(20.0);
  EXPECT_THAT(reasons(outcome), ElementsAre("at_bound"));
  EXPECT_THAT(verdict(three_indentations(), outcome).text, HasSubstr("the friction of 'tip' is 6, and no dry contact"));
  outcome.errors[0].unit = "Pa/m";
  EXPECT_THAT(reasons(outcome), ElementsAre()) << "a layer may be stiff";
}

TEST(FitVerdict, NamesGroupsMissedByFourSigma) {
  FitOutcome outcome = perfect();
  for (const size_t c : {2, 3}) outcome.cases[c].wrench.force[0] += 3.5 * 0.01;
  EXPECT_THAT(reasons(outcome), ElementsAre()) << "3.5 standard deviations";
  for (const size_t c : {2, 3}) outcome.cases[c].wrench.force[0] += 0.01;
  EXPECT_THAT(reasons(outcome), ElementsAre("group_missed"));
  EXPECT_THAT(verdict(three_indentations(), outcome).text,
              HasSubstr("the forces of 'poke 2' are missed by 4.5 standard"));
}

// The mean over all readings of a group would hide few forces among many markers.
TEST(FitVerdict, PositionsOfAGroupAreJudgedByThemselves) {
  FitOutcome outcome = perfect();
  for (const size_t c : {0, 1})
    for (Vec3d& marker : outcome.cases[c].markers) marker[2] += 10 * 2e-5;
  EXPECT_THAT(reasons(outcome), ElementsAre("group_missed"));
  EXPECT_THAT(verdict(three_indentations(), outcome).text, HasSubstr("the positions of 'poke 1' are missed by 5.77"));
}

TEST(FitVerdict, TorquesOfAGroupAreJudgedToo) {
  DataSet data = three_indentations();
  data.experiment.cases[5].torque = Vec3d{{0, 0, 0.02}};
  FitOutcome outcome = perfect(data);
  outcome.cases[5].wrench.torque = {{0, 0, 0.0225}};
  outcome.cases[5].torque_sigma = {{5e-4, 5e-4, 5e-4}};
  EXPECT_THAT(reasons(outcome, data), ElementsAre("group_missed"));
  EXPECT_THAT(verdict(data, outcome).text, HasSubstr("the torques of 'poke 3' are missed by 5 standard"));
}

TEST(FitVerdict, LeftOutGroupsDoNotCountAsMissed) {
  FitOutcome outcome = perfect();
  for (const size_t c : {2, 3}) outcome.cases[c].wrench.force[0] += 1, outcome.cases[c].left_out = true;
  EXPECT_THAT(reasons(outcome), ElementsAre());
}

TEST(FitVerdict, FieldsPredictingWorseThanOneValueFail) {
  FitOutcome outcome = perfect();
  outcome.held_out = held_out(0.04, 0.05);
  outcome.held_out_of_one_value = held_out(0.04, 0.05);
  EXPECT_THAT(reasons(outcome), ElementsAre());
  outcome.held_out_of_one_value = held_out(0.03, 0.04);
  EXPECT_THAT(reasons(outcome), ElementsAre("held_out_worse"));
}

// One of three indentations has fourfold forces, so the fit is a compromise.
TEST(FitVerdict, GroupsWhoseForcesContradictEachOtherAreNamed) {
  FitOutcome outcome = perfect();
  for (size_t c = 0; c < 6; ++c) {
    outcome.cases[c].wrench.force = (c < 2 ? 0.8 : 1.1) * *three_indentations().experiment.cases[c].force;
    outcome.cases[c].force_sigma = {{0.1, 0.1, 0.1}};
  }
  EXPECT_THAT(reasons(outcome), ElementsAre()) << "a ratio of 1.4";
  for (const size_t c : {0, 1}) outcome.cases[c].wrench.force = 0.4 * *three_indentations().experiment.cases[c].force;
  for (const size_t c : {0, 1}) outcome.cases[c].force_sigma = {{0.15, 0.15, 0.15}};
  EXPECT_THAT(reasons(outcome), ElementsAre("groups_disagree"));
  EXPECT_THAT(verdict(three_indentations(), outcome).text,
              testing::AllOf(HasSubstr("'poke 1' imply a body 2.75 times as stiff"), HasSubstr("'poke 2'")));
}

TEST(FitVerdict, TooManySquaresPerReadingAreNotGood) {
  FitOutcome outcome = perfect();
  outcome.report.misfit = 0.5 * 2.2 * outcome.residuals;
  EXPECT_THAT(reasons(outcome), ElementsAre());
  outcome.report.misfit = 0.5 * 2.3 * outcome.residuals;
  EXPECT_THAT(reasons(outcome), ElementsAre("unexplained"));
}

// The error of a law can hide that a model is wrong, because it moves all readings.
TEST(FitVerdict, ModelThatNeedsALargeErrorOfMeshOrLawIsNotGood) {
  FitOutcome outcome = perfect();
  outcome.common_errors = {{"the mesh", 1.5}, {"the law, by its stiffening", -3.9}};
  EXPECT_THAT(reasons(outcome), ElementsAre());
  outcome.common_errors[1].sigmas = -4.1;
  EXPECT_THAT(reasons(outcome), ElementsAre("unexplained"));
  EXPECT_THAT(verdict(three_indentations(), outcome).text,
              HasSubstr("4.1 standard deviations of the error of the law, by its stiffening"));
}

TEST(FitVerdict, PoorHeldOutTorquesAreNotGood) {
  FitOutcome outcome = perfect();
  outcome.held_out = held_out_indentation(0.01, 0.01);
  ReadingErrors& torques = outcome.held_out->groups[0].torques;
  torques = {.count = 2, .peak = 0.02, .error = 0.0019};
  EXPECT_THAT(reasons(outcome), ElementsAre());
  torques.error = 0.0021;
  EXPECT_THAT(reasons(outcome), ElementsAre("predicts_badly"));
  EXPECT_THAT(verdict(three_indentations(), outcome).text, HasSubstr("1 % (forces), 10.5 % (torques)"));
  torques = {.count = 2, .peak = 1e-6, .error = 3e-6, .noise = 2e-6};  // of a symmetric pull: noise alone
  EXPECT_THAT(reasons(outcome), ElementsAre("predicts_badly"));
  torques.error = 2.5e-6;
  EXPECT_THAT(reasons(outcome), ElementsAre());
}

TEST(FitVerdict, PoorHeldOutPredictionsAreNotGood) {
  FitOutcome outcome = perfect();
  outcome.held_out = held_out_indentation(0.01, 1.97);
  EXPECT_THAT(reasons(outcome), ElementsAre("predicts_badly"));
  EXPECT_THAT(verdict(three_indentations(), outcome).text, HasSubstr("(positions), 197 % (forces) beyond the noise"));
  outcome.held_out = held_out_indentation(0.06, 0.05);
  EXPECT_THAT(reasons(outcome), ElementsAre("predicts_badly"));
  outcome.held_out = held_out_indentation(0.04, 0.09);
  EXPECT_THAT(reasons(outcome), ElementsAre());
}

// A small motion has a relatively large noise.
TEST(FitVerdict, NoiseOfHeldOutReadingsIsTolerated) {
  FitOutcome outcome = perfect();
  outcome.held_out = held_out_indentation(0.09, 0.01);
  outcome.held_out->groups[0].positions.noise = 0.00087;
  EXPECT_THAT(reasons(outcome), ElementsAre());
  outcome.held_out->groups[0].positions.error = 0.0011;
  EXPECT_THAT(reasons(outcome), ElementsAre("predicts_badly"));
}

// Errors are relative to the largest motion and force of all groups: a group that is hardly pressed has a small force.
TEST(FitVerdict, HeldOutErrorsAreRelativeToTheLargestGroup) {
  FitOutcome outcome = perfect();
  outcome.held_out = held_out_indentation(0.01, 0.01);
  outcome.held_out->groups.push_back(outcome.held_out->groups[0]);
  outcome.held_out->groups[1].forces.peak = outcome.held_out->groups[1].forces.error = 0.05;
  EXPECT_THAT(reasons(outcome), ElementsAre());
}

TEST(FitVerdict, PoorPredictionsOfLeftOutGroupsAreNotGood) {
  FitOutcome outcome = perfect();
  outcome.plan.left_out = {"poke 3"};
  for (const size_t c : {4, 5}) outcome.cases[c].left_out = true;
  EXPECT_THAT(reasons(outcome), ElementsAre());
  outcome.cases[5].wrench.force = 1.5 * *three_indentations().experiment.cases[5].force;
  EXPECT_THAT(reasons(outcome), ElementsAre("predicts_badly"));
}

// One figure judges, is printed and is shown: that of all predicted groups, held out in turn or left out.
TEST(FitVerdict, HeldOutErrorsIncludeLeftOutGroups) {
  const std::vector<LoadCase>& cases = three_indentations().experiment.cases;
  FitOutcome outcome = perfect();
  outcome.held_out = held_out_indentation(0.01, 0.11);
  outcome.held_out->groups[0].group = "poke 1";
  const double alone = held_out_errors(three_indentations(), outcome).force;
  outcome.plan.left_out = {"poke 3"};
  for (const size_t c : {4, 5}) {
    outcome.cases[c].left_out = true;
    outcome.cases[c].wrench.force = 1.02 * *cases[c].force;
  }
  const double all = held_out_errors(three_indentations(), outcome).force;
  EXPECT_LT(all, 0.9 * alone);
  const FitVerdict judged = verdict(three_indentations(), outcome);
  for (const FitReason& reason : judged.reasons)
    EXPECT_DOUBLE_EQ(reason.name == "predicts_badly" ? reason.value.value_or(0) : all, all);
}

TEST(FitVerdict, OneValueInsteadOfFieldIsNotGood) {
  FitOutcome outcome = perfect();
  outcome.against_field = {{"at_bound", "young in 3 tets is at its bound"}};
  EXPECT_THAT(reasons(outcome), ElementsAre("field_rejected"));
  EXPECT_THAT(verdict(three_indentations(), outcome).text, HasSubstr("one value replaces the field: young in 3 tets"));
}

TEST(FitVerdict, ALawIsNotGoodIfNoneIs) {
  FitOutcome outcome = perfect();
  outcome.law_choice = LawChoice{.trials = {{.law = "gent"}, {.law = "fung", .against = "b is at its bound"}}};
  EXPECT_THAT(reasons(outcome), ElementsAre());
  outcome.law_choice->trials[0].against = "limit is at its bound";
  EXPECT_THAT(reasons(outcome), ElementsAre("no_good_law"));
}

TEST(FitVerdict, OnlySomeReasonsSpeakAgainstAField) {
  FitOutcome outcome = perfect();
  outcome.report.misfit = 5.0 * outcome.residuals;
  outcome.held_out = held_out_indentation(0.2, 0.2);
  EXPECT_THAT(reasons_against_field(three_indentations(), outcome), testing::IsEmpty());
  outcome.held_out_of_one_value = held_out(0.1, 0.1);
  outcome.mesh_errors_settle = false;
  std::vector<std::string> names;
  for (const FitReason& reason : reasons_against_field(three_indentations(), outcome)) names.push_back(reason.name);
  EXPECT_THAT(names, ElementsAre("mesh_not_settled", "held_out_worse"));
}

}  // namespace
}  // namespace aspic

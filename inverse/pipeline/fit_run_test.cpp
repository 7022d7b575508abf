#include "pipeline/fit_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/atomic_file.h"
#include "io/folder_test.h"
#include "material/registry.h"
#include "mesh/tet_nodes.h"
#include "model/refined_experiment.h"
#include "pipeline/fit_folder.h"
#include "pipeline/fit_verdict.h"
#include "pipeline/quick_plan_test.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const FittedQuantity& young(const FitOutcome& outcome) { return outcome.quantities.at(0); }

TEST(FitRun, FindsTheLayersOfABlock) {
  const FitOutcome outcome = fit_material(block(), quick_plan(), {}, {});
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  EXPECT_TRUE(is_success(outcome.report.status)) << outcome.report.message;
  ASSERT_EQ(young(outcome).rows.size(), 2u);
  EXPECT_EQ(young(outcome).rows[0].where, "region 1");
  EXPECT_NEAR(young(outcome).rows[0].value, kSoftLayer, 0.01 * kSoftLayer);
  EXPECT_NEAR(young(outcome).rows[1].value, kStiffLayer, 0.01 * kStiffLayer);
  ASSERT_TRUE(outcome.uniform);
  EXPECT_GT(outcome.uniform->misfit, 100 * outcome.report.misfit) << "one value explains the block worse";

  EXPECT_EQ(outcome.material.model, "neo_hookean");
  const std::vector<double>& E = *outcome.material.find("young");
  for (size_t t = 0; t < E.size(); ++t)
    EXPECT_NEAR(E[t], outcome.material.mesh.region[t] == 1 ? kSoftLayer : kStiffLayer, 0.01 * E[t]);
  EXPECT_DOUBLE_EQ(outcome.material.find("poisson")->front(), 0.4);
  EXPECT_EQ(outcome.material.find("density")->front(), 1000);
  for (size_t c = 0; c < outcome.cases.size(); ++c) {
    ASSERT_TRUE(outcome.cases[c].ok);
    EXPECT_NEAR(outcome.cases[c].wrench.force[1], (*block().experiment.cases[c].force)[1], 0.02);
  }
}

TEST(FitRun, DefaultFitsStiffnessOfEveryTet) {
  FitPlan plan;
  plan.fit.max_iterations = 4;
  plan.cross_validation = false;
  const FitOutcome outcome = fit_material(block(), plan, {}, {});
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  ASSERT_EQ(outcome.quantities.size(), 2u);
  EXPECT_EQ(outcome.quantities[0].name, "young");
  EXPECT_EQ(outcome.quantities[0].rows.size(), 3u);
  EXPECT_EQ(outcome.quantities[1].name, "poisson");
  EXPECT_EQ(outcome.parameter_count, block().experiment.mesh.tet_count() + 1);
}

TEST(FitRun, UninformativeDataKeepThePrior) {
  DataSet data = block();
  for (LoadCase& load : data.experiment.cases) {
    load.positions.clear();
    load.force_sigma = {{1e3, 1e3, 1e3}};
  }
  FitPlan plan = quick_plan({"young=tets"});
  plan.uncertainty = true;
  const FitOutcome outcome = fit_material(data, plan, {}, {});
  ASSERT_TRUE(outcome.posterior && outcome.posterior->ok) << outcome.failure;
  EXPECT_LT(outcome.posterior->informed, 0.1);
  for (const double sigma : outcome.posterior->sigma.front()) EXPECT_GT(sigma, 0.5);
  EXPECT_THAT(outcome.warnings, ::testing::Contains(HasSubstr("hardly determine")));
}

// The reported predictions have the errors of the misfit, even if the layers explain a part of the forces.
TEST(FitRun, ShowsThePredictionThatTheMisfitCounts) {
  DataSet data = block();
  for (LoadCase& load : data.experiment.cases) load.force = 1.2 * *load.force;
  FitPlan plan = quick_plan({"young=uniform"});
  plan.left_out = {"poke 2"};
  const FitOutcome outcome = fit_material(data, plan, {}, {});
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  double squares = 0;
  const auto add = [&](const Vec3d& shown, const Vec3d& measured, const Vec3d& sigma) {
    for (int i = 0; i < 3; ++i) squares += std::pow((shown[i] - measured[i]) / sigma[i], 2);
  };
  for (size_t c = 0; c < outcome.cases.size(); ++c) {
    const LoadCase& load = data.experiment.cases[c];
    if (outcome.cases[c].left_out) continue;
    for (size_t k = 0; k < load.positions.size(); ++k)
      add(outcome.cases[c].markers[k], load.positions[k].position, load.positions[k].sigma);
    add(outcome.cases[c].wrench.force, *load.force, load.force_sigma);
  }
  EXPECT_GT(outcome.report.misfit, 100);
  // The misfit also counts the deviations of the layers from their common stiffness.
  EXPECT_LE(squares, 2 * outcome.report.misfit * (1 + 1e-9));
  EXPECT_NEAR(squares, 2 * outcome.report.misfit, 1e-4 * squares);
}

// Forces of one indentation belong to another body, so that no field explains all three.
DataSet contradictory_block() {
  DataSet data = measured_block(2);
  for (LoadCase& load : data.experiment.cases)
    if (load.group == "poke 2") load.force = 8.0 * *load.force;
  return data;
}

TEST(FitRun, OneValueReplacesAFieldAtItsBounds) {
  FitPlan plan = quick_plan({"young=tets"});
  plan.fit.max_iterations = 30;
  plan.uncertainty = true;
  const DataSet data = contradictory_block();
  const FitOutcome outcome = fit_material(data, plan, {}, {});
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  ASSERT_THAT(outcome.against_field, ::testing::Not(::testing::IsEmpty()));
  EXPECT_EQ(outcome.against_field.front().name, "at_bound") << outcome.against_field.front().text;
  EXPECT_EQ(outcome.parameter_count, 1);
  ASSERT_EQ(young(outcome).rows.size(), 1u);
  EXPECT_EQ(young(outcome).rows[0].where, "everywhere");
  EXPECT_TRUE(young(outcome).rows[0].interval);
  for (const double E : *outcome.material.find("young")) EXPECT_DOUBLE_EQ(E, young(outcome).rows[0].value);
  const FitVerdict judged = verdict(data, outcome);
  EXPECT_FALSE(judged.is_good());
  EXPECT_EQ(judged.reasons.front().name, "field_rejected");
}

TEST(FitRun, AFieldThatExplainsTheDataStays) {
  FitPlan plan = quick_plan({"young=tets"});
  plan.fit.max_iterations = 30;
  const FitOutcome outcome = fit_material(block(), plan, {}, {});
  EXPECT_THAT(outcome.against_field, ::testing::IsEmpty());
  EXPECT_GT(young(outcome).rows.size(), 1u);
}

// With mesh correction, the values shown beside readings are predictions on fine meshes.
TEST(FitRun, ShowsForcesWithTheCorrectionForTheMesh) {
  DataSet data = measured_block(2);
  for (size_t c = 0; c < data.experiment.cases.size(); ++c)
    data.experiment.cases[c].force = (c % 2 == 0 ? 1.1 : 0.9) * *data.experiment.cases[c].force;
  FitPlan plan = quick_plan({"young=uniform"});
  plan.mesh_errors = true;
  const FitOutcome outcome = fit_material(data, plan, {}, {});
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  double squares = 0;
  const auto add = [&](const Vec3d& error, const Vec3d& sigma) {
    for (int i = 0; i < 3; ++i) squares += std::pow(error[i] / sigma[i], 2);
  };
  for (size_t c = 0; c < outcome.cases.size(); ++c) {
    const LoadCase& load = data.experiment.cases[c];
    const CaseOutcome& shown = outcome.cases[c];
    EXPECT_GT(shown.relative_mesh_error, 0.05);
    EXPECT_GT(shown.force_sigma[1], load.force_sigma[1]) << "with that of the correction";
    for (size_t k = 0; k < load.positions.size(); ++k)
      add(shown.markers[k] - load.positions[k].position, shown.marker_sigma[k]);
    add(shown.wrench.force - *load.force, shown.force_sigma);
  }
  EXPECT_NEAR(squares, 2 * outcome.report.misfit, 0.1 * squares) << "the page's residuals are those of the fit";
}

// A block of one material with Poisson's ratio 0.45, of quadratic tets, with its exact readings.
DataSet nearly_incompressible_block() {
  DataSet data = measured_block(2);
  Experiment& e = data.experiment;
  e.mesh = raise_order(std::move(e.mesh));
  e.fixed.clear();
  for (int v = 0; v < e.mesh.vertex_count(); ++v)
    if (e.mesh.rest[static_cast<size_t>(v)][1] < 1e-9) e.fixed.push_back(v);
  const std::vector<MaterialParameters> truth(e.mesh.tets.size(), {lame_from_young_poisson(2e4, 0.45), {}});
  const ParameterMap map(e.mesh, "neo_hookean", truth,
                         {{.quantity = "young", .parameterization = Parameterization::uniform}});
  Misfit model(e, map);
  std::vector<double> r(static_cast<size_t>(model.residual_count()));
  EXPECT_TRUE(model.evaluate(std::vector<double>{std::log(2e4)}, r)) << model.failure();
  for (size_t c = 0; c < e.cases.size(); ++c) {
    const CasePrediction& prediction = model.prediction(static_cast<int>(c));
    for (size_t i = 0; i < prediction.markers.size(); ++i) e.cases[c].positions[i].position = prediction.markers[i];
    e.cases[c].force = prediction.wrench.force;
  }
  return data;
}

// The energy of quadratic tets changes at a Poisson's ratio of 0.3. The one of the result counts, not that of the
// guess.
TEST(FitRun, FindsPoissonsRatioFromAGuessBelowMeanVolume) {
  const DataSet data = nearly_incompressible_block();
  for (const double guess : {0.2, 0.45}) {
    FitPlan plan = quick_plan({"young=uniform", "poisson=uniform"});
    plan.known.clear();
    plan.law_errors = false;
    plan.parameters[1].guess = guess;
    const FitOutcome outcome = fit_material(data, plan, {}, {});
    ASSERT_TRUE(outcome.has_material()) << outcome.failure;
    EXPECT_NEAR(young(outcome).rows.at(0).value, 2e4, 20) << guess;
    EXPECT_NEAR(outcome.quantities.at(1).rows.at(0).value, 0.45, 1e-3) << guess;
  }
}

TEST(FitRun, EveryModelBeginsInsideOfItsRanges) {
  for (const MaterialInfo& info : materials()) {
    FitPlan plan = quick_plan({"young=uniform"});
    plan.model = info.name;
    plan.known.clear();
    plan.fit.max_iterations = 1;
    if (info.extra.empty()) continue;
    EXPECT_TRUE(fit_material(block(), plan, {}, {}).has_material()) << info.name;
  }
}

TEST(FitRun, ReportsUndeterminedValues) {
  FitPlan plan = quick_plan();
  plan.uncertainty = true;
  const FitOutcome outcome = fit_material(block(), plan, {}, {});
  ASSERT_TRUE(outcome.posterior && outcome.posterior->ok);
  for (const ValueRow& row : young(outcome).rows) {
    ASSERT_TRUE(row.interval);
    EXPECT_LT(row.interval->lower, row.value);
    EXPECT_GT(row.interval->upper, row.value);
  }
  EXPECT_THAT(outcome.material.further, testing::SizeIs(2));
}

TEST(FitRun, PredictsWhatWasLeftOut) {
  FitPlan plan = quick_plan();
  plan.left_out = {"poke 2"};
  plan.cross_validation = true;
  const FitOutcome outcome = fit_material(block(), plan, {}, {});
  const auto& cases = block().experiment.cases;
  for (size_t c = 0; c < cases.size(); ++c) {
    EXPECT_EQ(outcome.cases[c].left_out, cases[c].group == "poke 2");
    ASSERT_TRUE(outcome.cases[c].has_held_out);
    EXPECT_NEAR(outcome.cases[c].held_out_wrench.force[1], (*cases[c].force)[1], 0.02 * std::abs((*cases[c].force)[1]));
  }
  ASSERT_TRUE(outcome.held_out);
  EXPECT_EQ(outcome.held_out->groups.size(), 2u);
  EXPECT_LT(outcome.held_out->position_error, 0.02);
  EXPECT_LT(outcome.held_out->force_error, 0.05);
}

// Forces that are 1e15 times too large, without other readings: no stiffness explains them.
TEST(FitRun, RefusesAStiffnessThatNoBodyHas) {
  DataSet data = block();
  for (LoadCase& c : data.experiment.cases) {
    c.positions.clear();
    c.force = 1e-15 * *c.force;
    c.force_sigma = 1e-17 * Vec3d{{1, 1, 1}};
  }
  FitPlan plan = quick_plan();
  plan.parameters = {parse_parameter("young=uniform")};
  const FitOutcome outcome = fit_material(data, plan, {}, {});
  EXPECT_FALSE(outcome.has_material());
  EXPECT_THAT(outcome.failure, HasSubstr("do not determine the stiffness"));
  EXPECT_THAT(outcome.failure, HasSubstr("positions of some markers"));
}

// Data of a body with the layers' moduli on a mesh with each tet split in 8.
void measure_on_finer_mesh(DataSet& data) {
  const Experiment fine = refined(data.experiment);
  const ParameterMap map(
      data.experiment.mesh, "neo_hookean",
      std::vector<MaterialParameters>(data.experiment.mesh.tets.size(), {lame_from_young_poisson(1e4, 0.4), {}}),
      {{.quantity = "young", .parameterization = Parameterization::regions}});
  Misfit model(fine, map);
  std::vector<double> r(static_cast<size_t>(model.residual_count()));
  ASSERT_TRUE(model.evaluate(std::vector<double>{std::log(kSoftLayer), std::log(kStiffLayer)}, r)) << model.failure();
  for (size_t c = 0; c < fine.cases.size(); ++c) {
    const CasePrediction& prediction = model.prediction(static_cast<int>(c));
    for (size_t i = 0; i < prediction.markers.size(); ++i)
      data.experiment.cases[c].positions[i].position = prediction.markers[i];
    data.experiment.cases[c].force = prediction.wrench.force;
  }
}

// On the measured mesh the material of the data's tets is exact.
TEST(FitRun, SimulatesOnAFinerMeshThanItFits) {
  DataSet data = block();
  measure_on_finer_mesh(data);
  FitPlan plan = quick_plan();
  const double without = young(fit_material(data, plan, {}, {})).rows.at(0).value;
  EXPECT_GT(std::abs(without / kSoftLayer - 1), 0.03)
      << "the discretization error must be visible without the correction";
  plan.refine = 1;
  plan.uncertainty = plan.cross_validation = true;
  plan.left_out = {"poke 3"};
  const FitOutcome outcome = fit_material(data, plan, {}, {});
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  EXPECT_EQ(outcome.simulated_tets, 8 * data.experiment.mesh.tet_count());
  EXPECT_NEAR(young(outcome).rows.at(0).value, kSoftLayer, 1e-3 * kSoftLayer);
  EXPECT_NEAR(young(outcome).rows.at(1).value, kStiffLayer, 1e-3 * kStiffLayer);
  EXPECT_EQ(outcome.material.mesh.tet_count(), data.experiment.mesh.tet_count());
  EXPECT_THAT(young(outcome).sigma, testing::SizeIs(data.experiment.mesh.tets.size()));
  EXPECT_LT(outcome.held_out->force_error, 0.01);
}

// Ratio of the stiff to the soft layer, of geometric means by volume.
double contrast_of_layers(const FittedMaterial& material) {
  const std::vector<double>& E = *material.find("young");
  double log_E[2] = {}, volumes[2] = {};
  for (int t = 0; t < material.mesh.tet_count(); ++t) {
    const int layer = material.mesh.region[static_cast<size_t>(t)] - 1;
    log_E[layer] += volume(material.mesh, t) * std::log(E[static_cast<size_t>(t)]);
    volumes[layer] += volume(material.mesh, t);
  }
  return std::exp(log_E[1] / volumes[1] - log_E[0] / volumes[0]);
}

// Standard deviations that include mesh errors exceed the random errors. A rule that treats them as noise finds a
// contrast of 1.5.
TEST(FitRun, FieldFindsLayersDespiteMeshErrors) {
  DataSet data = block();
  measure_on_finer_mesh(data);
  FitPlan plan = quick_plan({"young=tets"});
  plan.mesh_errors = true;
  const FitOutcome outcome = fit_material(data, plan, {}, {});
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  EXPECT_TRUE(outcome.mesh_errors_settle);
  EXPECT_THAT(outcome.against_field, ::testing::IsEmpty());
  EXPECT_GT(contrast_of_layers(outcome.material), 2) << "of " << kStiffLayer / kSoftLayer;
  EXPECT_LT(contrast_of_layers(outcome.material), 4);
}

TEST(FitRun, RefusesToRefineBeyondWhatIsSensible) {
  FitPlan plan = quick_plan();
  plan.refine = 6;
  EXPECT_THAT(message_of([&] { completed(plan, block().experiment); }), HasSubstr("are the most"));
}

class FitMemoryTest : public FolderTest {
 protected:
  // Stops after `limit` iterations of both stages together; counts them.
  FitOutcome fitted(const fs::path& memory, JournalStart start, int limit) {
    iterations = 0;
    fs::create_directories(memory);
    const FitCallbacks callbacks{
        .iterate = [&](FitStage, const FitIteration&, std::span<const double>) { ++iterations; },
        .stop = StopToken([&, limit] { return iterations >= limit; })};
    FitPlan plan = quick_plan({"young=handles:6"});
    plan.mesh_errors = mesh_errors;
    return fit_material(block(), plan, {memory, start}, callbacks);
  }
  int iterations = 0;
  bool mesh_errors = false;
};

TEST_F(FitMemoryTest, InterruptedFitResumesBitReproducibly) {
  const FitOutcome whole = fitted(path("whole"), JournalStart::anew, 1000);
  const int all = iterations;
  ASSERT_GT(all, 4);
  for (const int limit : {1, 3, all - 1}) {
    const fs::path memory = path("part" + std::to_string(limit));
    const FitOutcome part = fitted(memory, JournalStart::anew, limit);
    EXPECT_TRUE(part.interrupted);
    EXPECT_TRUE(part.has_material()) << "the current estimate is kept";
    const FitOutcome resumed = fitted(memory, JournalStart::resume, 1000);
    EXPECT_EQ(iterations, all);
    EXPECT_EQ(resumed.report.p, whole.report.p) << "interrupted after " << limit;
    EXPECT_EQ(*resumed.material.find("young"), *whole.material.find("young"));
    EXPECT_EQ(resumed.cases[1].wrench.force[1], whole.cases[1].wrench.force[1]);
  }
}

TEST_F(FitMemoryTest, MeshCorrectedFitResumesBitReproducibly) {
  mesh_errors = true;
  const FitOutcome whole = fitted(path("whole"), JournalStart::anew, 10000);
  ASSERT_TRUE(whole.has_material()) << whole.failure;
  EXPECT_GT(whole.mesh_error, 0);
  const int all = iterations;
  for (const int limit : {all / 3, all - 1}) {
    const fs::path memory = path("part" + std::to_string(limit));
    EXPECT_TRUE(fitted(memory, JournalStart::anew, limit).interrupted);
    const FitOutcome resumed = fitted(memory, JournalStart::resume, 10000);
    EXPECT_EQ(iterations, all);
    EXPECT_EQ(resumed.report.p, whole.report.p) << "interrupted after " << limit << " of " << all;
  }
}

TEST_F(FitMemoryTest, FolderRejectsOtherOptionsOfItsFit) {
  const fs::path material = path("block.vtu");
  const std::string options = text_of(completed(quick_plan(), block().experiment));
  {
    FitFolder begun = FitFolder::open(material, options, ExistingFit::refuse);
    EXPECT_EQ(begun.path().filename(), "block.fit");
    begun.add(FitStage::field, {.index = 1});
    begun.add(FitStage::field, {.index = 2});
    write_file(begun.path() / "fit.journal", "");
    EXPECT_THAT(message_of([&] { FitFolder::open(material, options, ExistingFit::resume); }),
                HasSubstr("is writing results into it"));
  }
  const auto opened = [&](ExistingFit existing, const std::string& with) {
    return message_of([&] { FitFolder::open(material, with, existing); });
  };
  EXPECT_THAT(opened(ExistingFit::refuse, options), HasSubstr("--resume continues it, --force replaces it"));
  FitPlan other = quick_plan();
  other.regularizer.smoothness = Smoothness::total_variation;
  EXPECT_THAT(opened(ExistingFit::resume, text_of(completed(other, block().experiment))),
              AllOf(HasSubstr("'smooth = \"h1\"'"), HasSubstr("'smooth = \"tv\"'")));
  {
    FitFolder again = FitFolder::open(material, options, ExistingFit::resume);
    EXPECT_EQ(again.iterations_before(), 2);
    const std::string before = read_file(again.path() / "history.csv");
    for (int i = 1; i <= 3; ++i) again.add(FitStage::field, {.index = i});
    EXPECT_TRUE(read_file(again.path() / "history.csv").starts_with(before));
    again.finish();
  }
  EXPECT_THAT(opened(ExistingFit::resume, options), HasSubstr("this fit is complete"));
  EXPECT_THAT(opened(ExistingFit::refuse, options), HasSubstr("exists; --force replaces it"));
  EXPECT_EQ(opened(ExistingFit::overwrite, options), "");
}

}  // namespace
}  // namespace aspic

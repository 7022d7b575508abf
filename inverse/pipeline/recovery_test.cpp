// Recovers the material of scenes: virtual bench, fit, comparison with the truth. tests/bench/results/capture.md has
// more and harder cases.
#include <gtest/gtest.h>

#include "data/capture_cases_test.h"
#include "data/judge.h"
#include "data/synthesis.h"
#include "pipeline/fit_run.h"

namespace aspic {
namespace {

class Recovery : public FolderTest {
 protected:
  Scene block(const std::string& young, int cells) {
    const std::string n = std::to_string(cells);
    return load_scene(
        folder.write("block.toml",
                     "gravity = [0, 0, 0]\n[time]\nduration = 0.1\n[[body]]\nname = \"block\"\nshape = { box = { lower "
                     "= [0, 0, 0], upper = [0.1, 0.1, 0.1], cells = [" +
                         n + ", " + n + ", " + n + "] } }\nmaterial = { model = \"neo_hookean\", young = \"" + young +
                         "\", poisson = 0.4 }\n[[body.pin]]\nwhere = \"Z < 1e-6\"\n"));
  }
  static SynthesisOptions bench(int indentations, double noise) {
    SynthesisOptions options;
    options.indentations = indentations, options.depths = 1, options.markers = 60;
    options.noise = options.force_noise = noise;
    options.indenter_radius = 0.02;
    return options;
  }
  static FitPlan plan(const std::string& parameter) {
    FitPlan plan;
    plan.parameters = {parse_parameter(parameter)};
    plan.known = {{"poisson", 0.4}};
    plan.uncertainty = plan.cross_validation = false;
    return plan;
  }
  static double factor(const Synthesis& made, const FitPlan& plan) {  // ratio of fitted and true E of one phase
    const FitOutcome outcome = fit_material(made.data, plan, {}, {});
    EXPECT_TRUE(outcome.has_material()) << outcome.failure;
    const Phase phase = judge(outcome.material, made.truth).at(0).phases.at(0);
    return phase.fitted / phase.truth;
  }
};

TEST_F(Recovery, OfAHomogeneousCubeToAThousandth) {
  const Scene scene = block("2e4", 4);
  SynthesisOptions options = bench(2, 0);
  options.mesh = to_user(scene.simulation.model().numbering, scene.simulation.model().mesh);
  EXPECT_NEAR(factor(synthesize(scene, options), plan("young=uniform")), 1, 1e-3);
}

// A hanging body on a mesh of three cells, which is 20 % too stiff.
TEST_F(Recovery, OnCoarseMeshNeedsErrorCorrection) {
  SynthesisOptions options = bench(0, 0);
  options.gravity = {{{0, 0, -1}}, {{1, 0, 0}}};
  options.mesh = make_box({{0, 0, 0}}, {{0.1, 0.1, 0.1}}, {3, 3, 3});
  const Synthesis made = synthesize(block("2e4", 10), options);
  FitPlan fit = plan("young=uniform");
  EXPECT_LT(factor(made, fit), 0.9);
  fit.mesh_errors = true;
  EXPECT_NEAR(factor(made, fit), 1, 0.03);  // the truth itself has a ninth of the error
}

// Indented by a bonded sphere on a mesh of four cells: the discretization error at the indenter must not act like
// another layer stiffness, which would change E.
TEST_F(Recovery, MeshErrorsMakeNoIndentationWorse) {
  SynthesisOptions options = bench(3, 0);
  options.contact = IndenterContact::bonded;
  options.mesh = make_box({{0, 0, 0}}, {{0.1, 0.1, 0.1}}, {5, 5, 5});
  const Synthesis made = synthesize(block("2e4", 10), options);
  FitPlan fit = plan("young=uniform");
  const double without = std::abs(std::log(factor(made, fit)));
  EXPECT_GT(without, 0.05);
  fit.mesh_errors = true;
  EXPECT_LT(std::abs(std::log(factor(made, fit))), without);
}

TEST_F(Recovery, OfTwoLayersAtOnePercentNoise) {
  const Scene scene = block("Z < 0.05 ? 6e4 : 2e4", 4);
  SynthesisOptions options = bench(4, 0.01);
  options.regions = true;
  options.mesh = to_user(scene.simulation.model().numbering, scene.simulation.model().mesh);
  const Synthesis made = synthesize(scene, options);
  FitPlan fit = plan("young=regions");
  fit.uncertainty = true;
  const FitOutcome outcome = fit_material(made.data, fit, {}, {});
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  const FittedQuantity& young = outcome.quantities.at(0);
  const Judgment found = judge(outcome.material, made.truth).at(0);
  ASSERT_EQ(young.sigma.size(), outcome.material.mesh.tets.size());
  const double sigma = *std::max_element(young.sigma.begin(), young.sigma.end());
  EXPECT_LT(sigma, 0.05);
  EXPECT_LT(found.largest, 4 * sigma) << "four standard deviations: once in 16 000 times by chance";
}

// A stiffness per tet, with unknown number and locations of parts.
TEST_F(Recovery, OfTwoPartsThatNobodyNamed) {
  const Scene scene = block("Z < 0.05 ? 6e4 : 2e4", 4);
  SynthesisOptions options = bench(4, 0.01);
  options.mesh = to_user(scene.simulation.model().numbering, scene.simulation.model().mesh);
  const Synthesis made = synthesize(scene, options);
  FitPlan fit = plan("young=tets");
  fit.parts = -1;
  fit.uncertainty = true;
  const FitOutcome outcome = fit_material(made.data, fit, {}, {});
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  ASSERT_TRUE(outcome.parts && outcome.parts->are_kept);
  ASSERT_EQ(outcome.parts->values.size(), 2u);
  EXPECT_NEAR(outcome.parts->values[0], 2e4, 0.1 * 2e4);
  EXPECT_NEAR(outcome.parts->values[1], 6e4, 0.2 * 6e4);
  EXPECT_NEAR(outcome.parts->volume[0], 0.5, 0.1);
  const std::vector<ValueRow>& rows = outcome.quantities.front().rows;
  ASSERT_EQ(rows.size(), 2u);
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(rows[k].where, "part " + std::to_string(k + 1));
    EXPECT_EQ(rows[k].value, outcome.parts->values[k]);
    ASSERT_TRUE(rows[k].interval);
    EXPECT_LT(rows[k].interval->lower, k == 0 ? 2e4 : 6e4);
    EXPECT_GT(rows[k].interval->upper, k == 0 ? 2e4 : 6e4);
  }
  ASSERT_TRUE(outcome.parts->contrast);
  EXPECT_LT(outcome.parts->contrast->lower, 3);
  EXPECT_GT(outcome.parts->contrast->upper, 3);
}

}  // namespace
}  // namespace aspic

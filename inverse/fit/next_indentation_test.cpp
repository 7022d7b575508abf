#include "fit/next_indentation.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "fit/common_errors.h"
#include "fit/indented_block_test.h"
#include "mesh/generators.h"

namespace aspic {
namespace {

using test::IndentedBlock;
using testing::HasSubstr;

// Indented on the left only.
struct IndentationStudy {
  IndentedBlock block{{4, 3, 2}};
  ParameterMap map = block.map();
  std::unique_ptr<Regularizer> prior = make_regularizer(block.experiment.mesh, map, {.prior_sigma = 1});
  std::vector<double> p{map.guess().begin(), map.guess().end()};

  IndentationStudy() {
    block.add_indentation(IndentedBlock::sites()[0], 0.005, 0.02);
    std::mt19937_64 random(3);
    block.measure(map, p, random);
  }
  FittedField field() const { return {map, block.experiment.mesh, p}; }
  Posterior posterior_of(const Experiment& experiment) {
    Misfit misfit(experiment, map);
    WithUncertainLayers data(misfit);
    return posterior(data, *prior, 1, {map, experiment.mesh, p});
  }
};

TEST(NextIndentation, PredictedGainAndSigmaMatchActualIndentation) {
  IndentationStudy study;
  Posterior before = study.posterior_of(study.block.experiment);
  const NextIndentation next =
      next_indentation(study.block.experiment, study.field(), before, {.sites = 5, .spectrum = {.dense = 600}});
  ASSERT_EQ(next.candidates.size(), 5u);
  for (const IndentationCandidate& candidate : {next.candidates.front(), next.candidates.back()}) {
    ASSERT_TRUE(candidate.ok) << candidate.failure;
    Experiment with = study.block.experiment;
    with.cases.push_back(candidate.load);
    std::mt19937_64 random(1);
    IndentedBlock measured;
    measured.experiment = with;
    measured.measure(study.map, study.p, random);
    const Posterior after = study.posterior_of(measured.experiment);
    double gain = 0;  // 1/2 log det(C / C after)
    for (const double d : after.gaussian->spectrum().d) gain += std::log1p(d) / 2;
    for (const double d : before.gaussian->spectrum().d) gain -= std::log1p(d) / 2;
    // By itself, the indentation lacks the information of the others about the layer of the indenter.
    EXPECT_LT(candidate.gain, gain * (1 + 1e-6));
    EXPECT_GT(candidate.gain, 0.85 * gain);
    for (int t = 0; t < study.map.size(); ++t) {
      EXPECT_GT(candidate.sigma[0][t], after.sigma[0][t] * (1 - 1e-6));
      EXPECT_LT(candidate.sigma[0][t], after.sigma[0][t] * 1.15);
    }
  }
}

TEST(NextIndentation, IsWhereNothingIsKnownYet) {
  IndentationStudy study;
  Posterior before = study.posterior_of(study.block.experiment);
  const NextIndentation next = next_indentation(study.block.experiment, study.field(), before, {.sites = 16});
  ASSERT_FALSE(next.candidates.empty());
  const IndentationCandidate& best = next.candidates.front();
  EXPECT_GE(best.site[0], 0.5 * IndentedBlock::kSide);
  EXPECT_LT(next.candidates.back().site[0], 0.4 * IndentedBlock::kSide);
  EXPECT_LT(next.candidates.back().gain, 0.8 * best.gain);
  EXPECT_THAT(best.description, HasSubstr("young around"));
  EXPECT_THAT(best.description, HasSubstr("would be within"));
  for (size_t i = 1; i < next.candidates.size(); ++i) {
    EXPECT_LE(next.candidates[i].gain, next.candidates[i - 1].gain);
    EXPECT_GT(next.candidates[i].gain, 0);
  }
  EXPECT_EQ(next.gain[best.vertex], std::ranges::max(next.gain));
  EXPECT_TRUE(next.warnings.empty());
}

TEST(NextIndentation, FewDirectionsTellNearlyAsMuchAsAll) {
  IndentationStudy study;
  Posterior before = study.posterior_of(study.block.experiment);
  const NextIndentation all =
      next_indentation(study.block.experiment, study.field(), before, {.sites = 6, .spectrum = {.dense = 600}});
  const NextIndentation few = next_indentation(study.block.experiment, study.field(), before,
                                               {.sites = 6, .spectrum = {.dense = 10, .max_rank = 24}});
  for (size_t i = 0; i < all.candidates.size(); ++i) {
    EXPECT_LE(few.candidates[i].gain, all.candidates[i].gain * (1 + 1e-6));
    EXPECT_GT(few.candidates[i].gain, all.candidates[i].gain * 0.85);
  }
}

TEST(NextIndentation, NeedsAnIndenter) {
  IndentationStudy study;
  Posterior before = study.posterior_of(study.block.experiment);
  for (LoadCase& load : study.block.experiment.cases) load.indenter.reset();
  EXPECT_THROW(next_indentation(study.block.experiment, study.field(), before), InvalidInput);
}

TEST(IndentationSites, AreFarApartOnFreeFlatSurface) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 0.5}}, {8, 8, 4});
  std::vector<int> fixed;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.rest[v][2] < 1e-9) fixed.push_back(v);
  const std::vector<IndentationSite> sites = indentation_sites(mesh, fixed, 0.1, 9);
  ASSERT_EQ(sites.size(), 9u);
  for (const IndentationSite& site : sites) {
    const Vec3d& X = mesh.rest[site.vertex];
    EXPECT_GT(X[2], 0.1);
    int faces = 0, normal = 0;  // not on an edge
    for (int i = 0; i < 3; ++i) {
      const double upper = i == 2 ? 0.5 : 1;
      faces += X[i] < 1e-9 || X[i] > upper - 1e-9;
      if (X[i] < 1e-9) normal += site.inward[i] > 0.9;
      if (X[i] > upper - 1e-9) normal += site.inward[i] < -0.9;
    }
    EXPECT_EQ(faces, 1);
    EXPECT_EQ(normal, 1);
    for (const IndentationSite& other : sites)
      if (other.vertex != site.vertex) {
        const Vec3d d = mesh.rest[other.vertex] - X;
        EXPECT_GT(dot(d, d), 0.25 * 0.25);
      }
  }
  EXPECT_TRUE(indentation_sites(mesh, fixed, 1, 9).empty());
}

TEST(IndentationSites, OfASphereAreAllOverIt) {
  const TetMesh mesh = make_sphere(1, 0.3);
  const std::vector<IndentationSite> sites = indentation_sites(mesh, {}, 0.3, 12);
  ASSERT_EQ(sites.size(), 12u);
  Vec3d sum{};
  for (const IndentationSite& site : sites) {
    sum = sum + mesh.rest[site.vertex];
    EXPECT_GT(-1.0 * dot(site.inward, mesh.rest[site.vertex]), 0.97);
  }
  EXPECT_LT(dot(sum, sum), 4);
}

}  // namespace
}  // namespace aspic

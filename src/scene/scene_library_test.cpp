// The scenes in scenes/, and the page docs/scene.md.
#include "scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "dynamics/step_derivatives.h"
#include "io/atomic_file.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

const std::vector<fs::path>& scene_files() {
  static const std::vector<fs::path> files = [] {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ASPIC_SOURCE_DIR) / "scenes"))
      if (entry.path().extension() == ".toml" && entry.path().stem() != "bunny") found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
  }();
  return files;
}

class SceneFile : public ::testing::TestWithParam<fs::path> {};

TEST_P(SceneFile, LoadsAndTakesTwoConvergedSteps) {
  Scene scene = load_scene(GetParam());
  EXPECT_GT(scene.steps, 0);
  EXPECT_EQ(scene.name, GetParam().stem());
  for (int step = 0; step < 2; ++step) {
    const StepReport report = scene.simulation.step();
    EXPECT_TRUE(is_success(report.status)) << to_string(report.status);
    EXPECT_GT(report.min_det_F, 0);
  }
}

TEST_P(SceneFile, ResolvedSceneGivesTheSameBits) {
  const TestFolder folder;
  Scene scene = load_scene(GetParam());
  write_inputs(scene, folder / "run");
  Scene again = load_scene(folder.write("run/scene.toml", scene.resolved));
  EXPECT_EQ(scene.resolved, again.resolved);
  scene.simulation.step();
  again.simulation.step();
  EXPECT_EQ(scene.simulation.state().q, again.simulation.state().q);
  EXPECT_EQ(scene.simulation.state().qdot, again.simulation.state().qdot);
}

TEST_P(SceneFile, DerivativesOfEveryTermAreRight) {
  Scene scene = load_scene(GetParam());
  scene.simulation.step();
  for (const TermDerivatives& of : check_step_derivatives(scene.simulation))
    for (const DerivativeCheck* check : {&of.report.gradient, &of.report.hessian})
      EXPECT_TRUE(check->passed) << of.term << " (" << of.state << "), " << entry_name(check->row) << ": "
                                 << check->smallest_error;
}

TEST_P(SceneFile, IsShort) {
  const std::string text = read_file(GetParam());
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 35);
}

TEST(SceneLibrary, ModuliOfEachTetAreExported) {
  const Scene scene = load_scene(fs::path(ASPIC_SOURCE_DIR) / "scenes" / "heterogeneous.toml");
  const Model& model = scene.simulation.model();
  ASSERT_EQ(model.tet_fields.size(), 2u);
  EXPECT_EQ(model.tet_fields[0].first, "young");
  EXPECT_EQ(model.tet_fields[1].first, "poisson");
  int stiff = 0;
  for (int t = 0; t < model.mesh.tet_count(); ++t) {
    Vec3d center{};
    for (const int v : model.mesh.tets[t]) center = center + 0.25 * model.mesh.rest[v];
    const bool core = std::hypot(center[1], center[2]) < 0.06;
    EXPECT_NEAR(model.tet_fields[0].second[t] / (core ? 1e7 : 5e4 * (1 + center[0])), 1, 1e-12);
    EXPECT_NEAR(model.tet_fields[1].second[t], core ? 0.3 : 0.45, 1e-12);
    EXPECT_EQ(model.density[t], core ? 1900 : 1050);
    stiff += core;
  }
  EXPECT_GT(stiff, 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneFile, ::testing::ValuesIn(scene_files()),
                         [](const auto& file) { return file.param.stem().string(); });

TEST(SceneReference, MatchesCommittedPage) {
  const fs::path page = fs::path(ASPIC_SOURCE_DIR) / "docs" / "scene.md";
  if (std::getenv("ASPIC_UPDATE_DOCS")) write_file(page, scene_reference());
  EXPECT_EQ(read_file(page), scene_reference()) << "ASPIC_UPDATE_DOCS=1 test_scene writes docs/scene.md anew";
}

}  // namespace
}  // namespace aspic

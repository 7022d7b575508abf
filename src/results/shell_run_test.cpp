// Runs of shells whose states have angles besides the vertices.
#include <gtest/gtest.h>

#include "dynamics/internal_terms.h"
#include "io/folder_test.h"
#include "io/vtu.h"
#include "mesh/elements.h"
#include "results/run_directory.h"
#include "scene/scene.h"

namespace aspic {
namespace {

constexpr const char* kShellFlag = R"(
gravity = [0.0, 0.0, -9.81]
[time]
duration = 0.12
step = 0.02
[[body]]
name = "flag"
shape = { rectangle = { width = 1.0, height = 0.5, size = 0.15 } }
shell = { thickness = 0.002, bending = "mid_edge" }
material = { young = 1e6, poisson = 0.3, density = 300 }
[[body.pin]]
name = "wall"
where = "X < -0.4"
[output]
mechanics = true
checkpoint_every = 0
)";

void run_shell_to(RunDirectory& run, Simulation& simulation, int last_step) {
  while (simulation.steps_taken() < last_step) run.on_step(simulation.step(), simulation);
}

TEST(ShellRun, FramesHaveTheVerticesOnly) {
  const TestFolder folder;
  const auto scene_file = folder.write("flag.toml", kShellFlag);
  Scene scene = load_scene(scene_file, {});
  const auto path = scene_file.parent_path() / "run";
  RunDirectory run = RunDirectory::create(path.string(), scene, ExistingRun::refuse);
  run_shell_to(run, scene.simulation, 2);
  const Model& model = scene.simulation.model();
  ASSERT_FALSE(model.angle_rows.empty());
  const std::string file = (path / "frames" / "body_000002.vtu").string();
  EXPECT_EQ(read_vtu_points(file).size(), 3 * model.mesh.rest.size());
  EXPECT_EQ(read_vtu_cell_field(file, "bending_density").size(), model.mesh.sheet.size());
  EXPECT_TRUE(read_vtu_cell_field(file, "bending").empty());
  const Vtu frame = read_vtu(file);
  EXPECT_FALSE(frame.point_fields.empty());
  for (const Field& field : frame.point_fields)
    EXPECT_EQ(field.values.size(), field.components * model.mesh.rest.size()) << field.name;
}

TEST(ShellRun, DensitiesSumToTheEnergy) {
  const TestFolder folder;
  Scene scene = load_scene(folder.write("flag.toml", kShellFlag), {});
  for (int i = 0; i < 4; ++i) scene.simulation.step();
  const Model& model = scene.simulation.model();
  const State& state = scene.simulation.state();
  const TetFields fields = scene.simulation.tet_fields();
  const std::vector<double> bending = bending_density(model, state.q, state.internal);
  double sum = 0, bent = 0;
  for (int t = 0; t < model.mesh.element_count(); ++t) {
    bent += bending[t] * element_volume(model.mesh, t);
    sum += (fields.energy_density[t] + bending[t]) * element_volume(model.mesh, t);
  }
  const TetElasticity& V = *model.elasticity.front();
  const double expected = V.value(state.q, *V.make_context());
  EXPECT_GT(bent, 0.01 * expected);
  EXPECT_NEAR(sum, expected, 1e-6 * expected);
}

TEST(ShellRun, InterruptedRunResumesToTheSameBits) {
  const TestFolder folder;
  const auto scene_file = folder.write("flag.toml", kShellFlag);
  for (const char* integrator : {"backward_euler", "bdf2"}) {
    const SceneOptions options{.overrides = {"time.integrator=\"" + std::string(integrator) + "\""}};
    Scene whole = load_scene(scene_file, options);
    for (int i = 0; i < 6; ++i) whole.simulation.step();
    const auto path = (scene_file.parent_path() / integrator).string();
    {
      Scene scene = load_scene(scene_file, options);
      RunDirectory run = RunDirectory::create(path, scene, ExistingRun::refuse);
      run_shell_to(run, scene.simulation, 3);
    }
    Scene scene = load_scene(scene_file, options);
    RunDirectory run = RunDirectory::resume(path, scene);
    ASSERT_EQ(scene.simulation.steps_taken(), 3);
    run_shell_to(run, scene.simulation, 6);
    EXPECT_EQ(scene.simulation.state().q, whole.simulation.state().q) << integrator;
    EXPECT_EQ(scene.simulation.state_hash(), whole.simulation.state_hash()) << integrator;
  }
}

}  // namespace
}  // namespace aspic

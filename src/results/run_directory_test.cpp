#include "results/run_directory.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>

#include "base/error.h"
#include "dynamics/model_builder.h"
#include "io/atomic_file.h"
#include "io/checkpoint.h"
#include "io/folder_test.h"
#include "io/gltf_file.h"
#include "io/pc2.h"
#include "io/vtu.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "results/run_gltf.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int kRunSteps = 7;
constexpr double kDensity = 1000;  // [kg/m^3]

// A soft bar of 16 vertices, held at x = 0, that sags under gravity.
Model sagging_bar() {
  Model model = ModelBuilder(make_box({{0, 0, 0}}, {{3, 1, 1}}, {3, 1, 1}), "soft bar")
                    .material("neo_hookean", {.young = 1e5, .poisson = 0.3})
                    .density(kDensity)
                    .gravity({{0, -9.81, 0}})
                    .pin("wall", {0, 1, 2, 3})
                    .build();
  model.tet_fields = {{"young", std::vector<double>(model.density.size(), 1e5)}};
  return model;
}

Scene sagging_scene(const OutputOptions& output = {.checkpoint_every = 0}, const SimulationOptions& options = {}) {
  Model model = sagging_bar();
  const BoundarySurface boundary = boundary_surface(model.mesh);
  Skin skin{boundary.surface, embed(model.mesh, boundary.surface), "soft bar"};
  return {.name = "bar",
          .resolved = "name = \"bar\"\nyoung = 1e5\n",
          .notes = {},
          .simulation = Simulation(std::move(model), options),
          .skins = {std::move(skin)},
          .steps = kRunSteps,
          .output = output,
          .input_files = {},
          .generated_meshes = {}};
}

void run_to(RunDirectory& run, Simulation& simulation, int last_step) {
  while (simulation.steps_taken() < last_step) {
    const int step = simulation.steps_taken() + 1;
    const StepReport report = simulation.step([&](const Iteration& iteration) {
      run.on_iteration(step, iteration);
      return true;
    });
    run.on_step(report, simulation);
  }
}

void run_whole(const fs::path& path, const OutputOptions& output) {
  Scene scene = sagging_scene(output);
  RunDirectory run = RunDirectory::create(path, scene, ExistingRun::refuse);
  run_to(run, scene.simulation, kRunSteps);
  run.finish(scene.simulation);
}

// Every file by its relative name, except wall times.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    if (entry.is_regular_file() && name != "timings.csv") files[name] = read_file(entry.path());
  }
  return files;
}

std::vector<std::string> names(const fs::path& folder) {
  std::vector<std::string> result;
  for (const auto& [name, text] : contents(folder)) result.push_back(name);
  return result;
}

int line_count(const std::string& text) { return static_cast<int>(std::count(text.begin(), text.end(), '\n')); }

using RunResults = FolderTest;

TEST_F(RunResults, HoldTheDocumentedFiles) {
  run_whole(path("run"), {.every = 0.03, .obj = true, .ply = true});
  EXPECT_THAT(names(path("run")),
              testing::UnorderedElementsAre("scene.toml", "steps.csv", "iterations.csv", "checkpoint.bin", "run.pvd",
                                            "run.usda", "frames/body_000000.vtu", "frames/body_000001.vtu",
                                            "frames/body_000002.vtu", "frames/skin_soft_bar_000000.ply",
                                            "frames/skin_soft_bar_000001.ply", "frames/skin_soft_bar_000002.ply",
                                            "frames/skin_soft_bar_000000.obj", "frames/skin_soft_bar_000001.obj",
                                            "frames/skin_soft_bar_000002.obj", "skins/skin_soft_bar.obj",
                                            "skins/skin_soft_bar.pc2"));
  EXPECT_EQ(line_count(read_file(path("run/steps.csv"))), 2 + kRunSteps) << "head, start, steps";
  EXPECT_THAT(read_file(path("run/steps.csv")), HasSubstr("\n0,0,start,"));
  EXPECT_THAT(read_file(path("run/steps.csv")),
              HasSubstr(",reaction_wall_x,reaction_wall_y,reaction_wall_z,reaction_moment_wall_x,"));
  EXPECT_EQ(line_count(read_file(path("run/timings.csv"))), 1 + kRunSteps);
  EXPECT_THAT(read_file(path("run/steps.csv")), HasSubstr(",potential_elasticity,potential_gravity,potential_total,"));
  EXPECT_THAT(read_file(path("run/run.pvd")),
              HasSubstr("timestep=\"0.03\" group=\"\" part=\"0\" file=\"frames/body_000001.vtu\""));
  EXPECT_EQ(scene_of_run(path("run")), path("run/scene.toml"));
}

TEST_F(RunResults, FramesCarryStateStressAndMaterial) {
  Scene scene = sagging_scene();
  RunDirectory run = RunDirectory::create(path("run"), scene, ExistingRun::refuse);
  run_to(run, scene.simulation, 2);
  const Vtu frame = read_vtu(path("run/frames/body_000002.vtu"));
  const State& state = scene.simulation.state();
  const TetFields tet = scene.simulation.tet_fields();
  for (int i = 0; i < frame.mesh.vertex_count(); ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(frame.mesh.rest[i][k], state.q[3 * i + k]);
  }
  std::map<std::string, Field> fields;
  for (const auto* list : {&frame.point_fields, &frame.cell_fields}) {
    for (const Field& field : *list) fields[field.name] = field;
  }
  for (const char* name : {"displacement", "velocity", "energy_density", "det_F", "cauchy", "von_mises", "body",
                           "region", "density", "young"}) {
    EXPECT_TRUE(fields.contains(name)) << name;
  }
  EXPECT_EQ(fields["velocity"].values[40], static_cast<float>(state.qdot[40]));
  EXPECT_EQ(fields["displacement"].values[40],
            static_cast<float>(state.q[40] - scene.simulation.model().mesh.rest[13][1]));
  EXPECT_EQ(fields["cauchy"].components, 6);
  EXPECT_EQ(fields["cauchy"].values[7], static_cast<float>(tet.cauchy[7]));
  EXPECT_EQ(fields["young"].values[0], 1e5);
}

TEST_F(RunResults, FramesHaveDoublePrecisionOnRequest) {
  Scene scene = sagging_scene({.double_precision = true});
  RunDirectory run = RunDirectory::create(path("run"), scene, ExistingRun::refuse);
  run_to(run, scene.simulation, 2);
  for (const Field& field : read_vtu(path("run/frames/body_000002.vtu")).point_fields)
    if (field.name == "velocity") {
      EXPECT_EQ(field.values, scene.simulation.state().qdot);
    }
}

// Drops the run without finish(), like a killed process, after any number of steps.
TEST_F(RunResults, InterruptedRunResumesToSameBytes) {
  for (const double every : {0.0, 0.02}) {
    const OutputOptions output{.every = every, .obj = true, .checkpoint_every = 0};
    const std::string whole = "whole" + std::to_string(every > 0);
    run_whole(path(whole), output);
    for (int stop = 0; stop <= kRunSteps; ++stop) {
      const fs::path torn = path("torn" + std::to_string(stop) + std::to_string(every > 0));
      {
        Scene scene = sagging_scene(output);
        RunDirectory run = RunDirectory::create(torn, scene, ExistingRun::refuse);
        run_to(run, scene.simulation, stop);
      }
      std::ofstream(torn / "steps.csv", std::ios::app) << stop + 1 << ",0.0";  // a torn line
      std::ofstream(torn / "frames" / "body_000099.vtu") << "later";
      std::ofstream(torn / "frames" / ".aspic-1-1") << "unfinished";
      Scene scene = sagging_scene(output);
      RunDirectory run = RunDirectory::resume(torn, scene);
      run_to(run, scene.simulation, kRunSteps);
      run.finish(scene.simulation);
      EXPECT_EQ(contents(torn), contents(path(whole))) << "stopped after step " << stop << ", every " << every;
    }
  }
}

// The state of integrators is in the checkpoint: previous step, length of substeps.
TEST_F(RunResults, EveryIntegratorResumesToSameBits) {
  const OutputOptions output{.vtu = false, .pc2 = false, .usd = false, .checkpoint_every = 1e9};
  std::vector<SimulationOptions> ways = {{.initial_guess = "last_increment"}};
  for (const std::string& integrator : integrator_names()) ways.push_back({.h = 1e-3, .integrator = integrator});
  for (const char* integrator : {"tr_bdf2", "rk4"})
    ways.push_back({.h = 4e-3, .integrator = integrator, .adaptive = {.tolerance = 1e-4}});
  for (const SimulationOptions& way : ways) {
    Scene whole = sagging_scene(output, way);
    for (int i = 0; i < kRunSteps; ++i) whole.simulation.step();
    {
      Scene scene = sagging_scene(output, way);
      RunDirectory run = RunDirectory::create(path("run"), scene, ExistingRun::overwrite);
      run_to(run, scene.simulation, 3);
      run.finish(scene.simulation);
    }
    Scene scene = sagging_scene(output, way);
    RunDirectory run = RunDirectory::resume(path("run"), scene);
    EXPECT_EQ(scene.simulation.steps_taken(), 3);
    run_to(run, scene.simulation, kRunSteps);
    EXPECT_EQ(scene.simulation.state().q, whole.simulation.state().q) << way.integrator;
    EXPECT_EQ(scene.simulation.state().qdot, whole.simulation.state().qdot) << way.integrator;
  }
}

TEST_F(RunResults, FramesAfterLastCheckpointAreRecomputed) {
  const OutputOptions output{.checkpoint_every = 1e9};  // [s]: only at the start and the end
  run_whole(path("whole"), output);
  {
    Scene scene = sagging_scene(output);
    RunDirectory run = RunDirectory::create(path("run"), scene, ExistingRun::refuse);
    run_to(run, scene.simulation, 5);
  }
  Scene scene = sagging_scene(output);
  RunDirectory run = RunDirectory::resume(path("run"), scene);
  EXPECT_EQ(scene.simulation.steps_taken(), 0);
  EXPECT_FALSE(fs::exists(path("run/frames/body_000001.vtu")));
  EXPECT_EQ(line_count(read_file(path("run/steps.csv"))), 2);
  run_to(run, scene.simulation, kRunSteps);
  run.finish(scene.simulation);
  EXPECT_EQ(contents(path("run")), contents(path("whole")));
}

TEST_F(RunResults, FinishedRunResumesWithoutChange) {
  run_whole(path("run"), {});
  const auto before = contents(path("run"));
  Scene scene = sagging_scene();
  RunDirectory run = RunDirectory::resume(path("run"), scene);
  EXPECT_EQ(scene.simulation.steps_taken(), kRunSteps);
  run.finish(scene.simulation);
  EXPECT_EQ(contents(path("run")), before);
}

TEST_F(RunResults, CheckpointWithImpossibleStepCountIsRejected) {
  run_whole(path("run"), {});
  for (const int64_t steps : {int64_t{-1}, int64_t{1} << 32}) {
    Checkpoint checkpoint = read_checkpoint(path("run/checkpoint.bin"));
    checkpoint.integers = {{"steps_taken", steps}};
    write_checkpoint(path("run/checkpoint.bin"), checkpoint);
    Scene scene = sagging_scene();
    EXPECT_THAT(message_of<InvalidInput>([&] { RunDirectory::resume(path("run"), scene); }),
                HasSubstr("counts " + std::to_string(steps) + " steps"));
  }
}

TEST_F(RunResults, DamagedCheckpointFallsBackToPrevious) {
  run_whole(path("whole"), {});
  {
    Scene scene = sagging_scene();
    RunDirectory run = RunDirectory::create(path("run"), scene, ExistingRun::refuse);
    run_to(run, scene.simulation, 4);
  }
  fs::resize_file(path("run/checkpoint.bin"), 100);
  Scene scene = sagging_scene();
  RunDirectory run = RunDirectory::resume(path("run"), scene);
  EXPECT_EQ(scene.simulation.steps_taken(), 3);
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_THAT(scene.notes[0], HasSubstr("continuing from checkpoint.previous.bin"));
  EXPECT_EQ(read_newest_checkpoint(path("run/checkpoint.bin")).checkpoint.integer("steps_taken"), 3);
  run_to(run, scene.simulation, kRunSteps);
  run.finish(scene.simulation);
  EXPECT_EQ(contents(path("run")), contents(path("whole")));
}

TEST_F(RunResults, UsdSceneIsUprightForGravityAlongZ) {
  Scene scene = sagging_scene();
  scene.gravity = {{0, 0, -9.81}};
  RunDirectory::create(path("run"), scene, ExistingRun::refuse).finish(scene.simulation);
  EXPECT_THAT(read_file(path("run/run.usda")), HasSubstr("upAxis = \"Z\""));
}

TEST_F(RunResults, GltfEndsAtTheLastFrame) {
  run_whole(path("run"), {});
  const RunGltf gltf = run_glb(RunLayout(path("run")), sagging_scene());
  EXPECT_EQ(gltf.frames, kRunSteps + 1);
  GltfFile file("run.glb", gltf.bytes, {});
  const GltfFile::Json& part = file.item("meshes", 0)["primitives"][0];
  const std::vector<double> start = file.reals(part["attributes"]["POSITION"], "VEC3"),
                            moved = file.reals(part["targets"].back()["POSITION"], "VEC3");
  const std::vector<float> last = Pc2Reader(path("run/skins/skin_soft_bar.pc2")).sample(kRunSteps);
  ASSERT_EQ(start.size(), last.size());
  for (size_t i = 0; i < last.size(); ++i) EXPECT_NEAR(start[i] + moved[i], last[i], 1e-6);
  const auto refusal = [&] {
    return message_of<InvalidInput>([&] { run_glb(RunLayout(path("run")), sagging_scene()); });
  };
  const std::string whole = read_file(path("run/skins/skin_soft_bar.pc2"));
  put(path("run/skins/skin_soft_bar.pc2"), whole.substr(0, whole.size() - 4) + std::string("\0\0\xc0\x7f", 4));  // NaN
  EXPECT_THAT(refusal(), HasSubstr("skin_soft_bar.pc2: a point of sample 7 is not finite"));
  put(path("run/skins/skin_soft_bar.pc2"), whole.substr(0, whole.size() / 2));
  EXPECT_THAT(refusal(), HasSubstr("is cut short"));
  fs::remove_all(path("run/skins"));
  EXPECT_THAT(refusal(), HasSubstr("output.pc2 = true"));
}

TEST_F(RunResults, ResumeNamesTheDamagedFile) {
  const OutputOptions output{.obj = true, .checkpoint_every = 0};
  {
    Scene scene = sagging_scene(output);
    RunDirectory run = RunDirectory::create(path("run"), scene, ExistingRun::refuse);
    run_to(run, scene.simulation, 5);
  }
  for (const std::string name : {"steps.csv", "iterations.csv", "frames/body_000003.vtu",
                                 "frames/skin_soft_bar_000002.obj", "skins/skin_soft_bar.pc2"}) {
    const std::string whole = read_file(path("run") / name);
    std::string damaged = whole;
    damaged[damaged.size() / 2] ^= 1;
    put(path("run") / name, damaged);
    Scene scene = sagging_scene(output);
    EXPECT_THAT(message_of<InvalidInput>([&] { RunDirectory::resume(path("run"), scene); }), HasSubstr(name)) << name;
    put(path("run") / name, whole);
  }
  Scene scene = sagging_scene(output);
  EXPECT_EQ(message_of<InvalidInput>([&] { RunDirectory::resume(path("run"), scene); }), "");
}

TEST_F(RunResults, ResumeRestoresCommentsAndRestSkin) {
  run_whole(path("run"), {});
  const auto before = contents(path("run"));
  std::ofstream(path("run/scene.toml"), std::ios::app) << "# damage\n";
  put(path("run/skins/skin_soft_bar.obj"), "v 0 0 0\n");
  Scene scene = sagging_scene();
  RunDirectory run = RunDirectory::resume(path("run"), scene);
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_THAT(scene.notes[0], HasSubstr("scene.toml: its text had changed"));
  run.finish(scene.simulation);
  EXPECT_EQ(contents(path("run")), before);
}

TEST_F(RunResults, OtherSceneIsRejectedWithDifferingLine) {
  run_whole(path("run"), {});
  Scene scene = sagging_scene();
  scene.resolved = "name = \"bar\"\nyoung = 2e5\n";
  const std::string message = message_of<InvalidInput>([&] { RunDirectory::resume(path("run"), scene); });
  EXPECT_THAT(message, HasSubstr("was computed with another scene"));
  EXPECT_THAT(message, HasSubstr(":2: 'young = 2e5' now, 'young = 1e5' in the run"));
}

TEST_F(RunResults, UnfinishedFilesOfKilledRunAreRemoved) {
  run_whole(path("whole"), {});
  fs::create_directories(path("run/frames"));
  std::ofstream(path("run/.aspic-1-0")) << "unfinished";
  run_whole(path("run"), {});
  EXPECT_EQ(contents(path("run")), contents(path("whole")));
}

TEST_F(RunResults, ExistingRunIsReplacedOnRequestOnly) {
  run_whole(path("run"), {});
  const auto before = contents(path("run"));
  const Scene scene = sagging_scene();
  const std::string message =
      message_of<InvalidInput>([&] { RunDirectory::create(path("run"), scene, ExistingRun::refuse); });
  EXPECT_THAT(message, HasSubstr("--force"));
  EXPECT_THAT(message, HasSubstr("--resume"));
  EXPECT_EQ(contents(path("run")), before);
}

TEST_F(RunResults, ReplacingARunSparesForeignFiles) {
  run_whole(path("run"), {.obj = true, .ply = true});
  const std::vector<std::string> foreign = {"notes.txt", "frames/body_1.vtu", "frames/body_000001.png",
                                            "skins/bunny.obj", "frames/body_x_000001.vtu"};
  for (const std::string& name : foreign) put(path("run") / name, "mine");
  const Scene scene = sagging_scene({.vtu = false, .pc2 = false, .usd = false});
  RunDirectory::create(path("run"), scene, ExistingRun::overwrite);
  std::vector<std::string> expected = {"scene.toml", "steps.csv", "iterations.csv", "checkpoint.bin"};
  expected.insert(expected.end(), foreign.begin(), foreign.end());
  EXPECT_THAT(names(path("run")), testing::UnorderedElementsAreArray(expected));
}

TEST_F(RunResults, InputsAreStoredWithSceneAndReplaced) {
  put(path("bar.msh"), "a mesh");
  Scene scene = sagging_scene();
  scene.resolved += "mesh = \"inputs/bar.msh\"\n";
  scene.input_files = {{"inputs/bar.msh", path("bar.msh")}};
  RunDirectory::create(path("run"), scene, ExistingRun::refuse);
  EXPECT_EQ(read_file(path("run/inputs/bar.msh")), "a mesh");

  scene.input_files = {{"inputs/bar.msh", path("run/inputs/bar.msh")}};  // the run's own scene, run again
  RunDirectory::create(path("run"), scene, ExistingRun::overwrite);
  EXPECT_EQ(read_file(path("run/inputs/bar.msh")), "a mesh");

  put(path("run/inputs/mine.msh"), "mine");
  RunDirectory::create(path("run"), sagging_scene(), ExistingRun::overwrite);
  EXPECT_FALSE(fs::exists(path("run/inputs/bar.msh")));
  EXPECT_EQ(read_file(path("run/inputs/mine.msh")), "mine");
}

// The scene of an untrusted run may name any file.
TEST_F(RunResults, OverwritingSparesTargetsOfInputLinks) {
  Scene scene = sagging_scene();
  scene.resolved += "mesh = \"inputs/mine.msh\"\nskin = \"inputs/deep/mine.msh\"\n";
  RunDirectory::create(path("run"), scene, ExistingRun::refuse);
  fs::create_directories(path("elsewhere/deep"));
  put(path("elsewhere/mine.msh"), "mine");
  put(path("elsewhere/deep/mine.msh"), "mine");
  fs::create_directories(path("run/inputs"));
  fs::create_directory_symlink(path("elsewhere/deep"), path("run/inputs/deep"));
  RunDirectory::create(path("run"), scene, ExistingRun::overwrite);
  EXPECT_TRUE(fs::exists(path("elsewhere/deep/mine.msh")));
  fs::remove_all(path("run/inputs"));
  fs::create_directory_symlink(path("elsewhere"), path("run/inputs"));
  RunDirectory::create(path("run"), scene, ExistingRun::overwrite);
  EXPECT_TRUE(fs::exists(path("elsewhere/mine.msh")));
}

TEST_F(RunResults, ForeignDirectoryIsNeverTouched) {
  fs::create_directories(path("mine"));
  put(path("mine/scene.toml"), "my scene");
  const Scene scene = sagging_scene();
  for (const ExistingRun existing : {ExistingRun::refuse, ExistingRun::overwrite}) {
    EXPECT_THAT(message_of<InvalidInput>([&] { RunDirectory::create(path("mine"), scene, existing); }),
                HasSubstr("mine: is not empty and contains no run"));
    EXPECT_THAT(message_of<InvalidInput>([&] { RunDirectory::create(path("mine/scene.toml"), scene, existing); }),
                HasSubstr("is a file"));
  }
  EXPECT_EQ(read_file(path("mine/scene.toml")), "my scene");
  EXPECT_THAT(names(path("mine")), testing::ElementsAre("scene.toml"));
}

TEST_F(RunResults, RefusesASecondProcessInTheSameFolder) {
  const Scene scene = sagging_scene();
  std::optional<RunDirectory> running(RunDirectory::create(path("run"), scene, ExistingRun::refuse));
  const auto before = contents(path("run"));
  Scene second = sagging_scene();
  for (const std::string& message :
       {message_of<InvalidInput>([&] { RunDirectory::resume(path("run"), second); }),
        message_of<InvalidInput>([&] { RunDirectory::create(path("run"), second, ExistingRun::overwrite); })}) {
    EXPECT_THAT(message, HasSubstr("process "));
    EXPECT_THAT(message, HasSubstr("is writing results into it"));
  }
  EXPECT_EQ(contents(path("run")), before);
  running.reset();
  RunDirectory::resume(path("run"), second);
}

TEST_F(RunResults, RefusesToResumeWithoutItsIterations) {
  run_whole(path("run"), {});
  const std::string whole = read_file(path("run/iterations.csv"));
  const size_t last_row = whole.rfind('\n', whole.size() - 2) + 1;
  write_file(path("run/iterations.csv"), whole.substr(0, last_row));
  Scene scene = sagging_scene();
  EXPECT_THAT(message_of<InvalidInput>([&] { RunDirectory::resume(path("run"), scene); }),
              HasSubstr("iterations.csv: has " + std::to_string(last_row) + " bytes"));
}

TEST_F(RunResults, RefusesToResumeWithoutAFrame) {
  run_whole(path("run"), {});
  const std::string frame = read_file(path("run/frames/body_000002.vtu"));
  Scene scene = sagging_scene();
  const auto message = [&] { return message_of<InvalidInput>([&] { RunDirectory::resume(path("run"), scene); }); };
  write_file(path("run/frames/body_000002.vtu"), "");
  EXPECT_THAT(message(), HasSubstr("body_000002.vtu: is empty"));
  fs::remove(path("run/frames/body_000002.vtu"));
  EXPECT_THAT(message(), HasSubstr("body_000002.vtu: is missing"));
  write_file(path("run/frames/body_000002.vtu"), frame);
  RunDirectory::resume(path("run"), scene);
}

TEST_F(RunResults, MissingRunIsReported) {
  Scene scene = sagging_scene();
  EXPECT_THAT(message_of<InvalidInput>([&] { RunDirectory::resume(path("no"), scene); }),
              HasSubstr("contains no run to continue"));
  EXPECT_THAT(message_of<InvalidInput>([&] { scene_of_run(path("no")); }), HasSubstr("contains no run to continue"));
}

}  // namespace
}  // namespace aspic

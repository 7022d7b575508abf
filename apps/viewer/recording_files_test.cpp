// Recordings of long, incomplete and damaged runs.
#include <gmock/gmock.h>

#include <regex>

#include "base/hash.h"
#include "viewer/page.h"
#include "viewer/recording.h"
#include "viewer/recording_test.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST_F(RunRecording, ThinsOutFramesEvenlyBelowTheSizeLimit) {
  const fs::path directory = run("run", "", 120);
  const RecordedRun whole = recording(directory);
  EXPECT_EQ(whole.frames, 121);
  EXPECT_EQ(whole.note, "");
  const size_t limit = whole.text.size() * 7 / 10;
  const RecordedRun thin = recording(directory, limit);
  EXPECT_LE(thin.text.size(), limit);
  EXPECT_LT(thin.frames, 121);
  EXPECT_EQ(thin.frames_of_run, 121);
  EXPECT_THAT(thin.note, HasSubstr("of the run's 121 frames are included"));
  const Decoded decoded(thin.text);
  const std::vector<int> steps = decoded.head["frames"]["step"];
  ASSERT_EQ(static_cast<int>(steps.size()), thin.frames);
  EXPECT_EQ(steps.front(), 0);
  EXPECT_EQ(steps.back(), 120);
  const double apart = 120.0 / (thin.frames - 1);
  for (size_t i = 0; i < steps.size(); ++i) EXPECT_NEAR(steps[i], apart * static_cast<double>(i), 1.01);
  EXPECT_EQ(decoded.head["scenes"][0]["notes"][0], thin.note);
  EXPECT_EQ(decoded.head["steps"].size(), 120u);  // tables stay complete
  EXPECT_THAT(refusal(directory, 3000), HasSubstr("raise --max-size"));
}

TEST_F(RunRecording, ShowsTheSkinsOfARunWithoutFrames) {
  const Decoded decoded(recording(run("run", "[output]\nvtu = false\n")).text);
  EXPECT_EQ(decoded.frame_count(), 13);
  EXPECT_EQ(decoded.head["scenes"][0]["fields"].size(), 1u);
  EXPECT_GT(decoded.array<uint32_t>("cage.triangles").size(), 0u);
  EXPECT_THAT(refusal(run("none", "[output]\nvtu = false\npc2 = false\nusd = false\n")),
              HasSubstr("run it again with output.vtu = true"));
}

TEST_F(RunRecording, ShowsAKilledRunUpToItsCheckpoint) {
  write_file(path("beam.toml"), kRecordedBeam + "[output]\ncheckpoint_every = 0\n");
  Scene scene = load_scene(path("beam.toml"));
  {
    RunDirectory directory = RunDirectory::create(path("run"), scene, ExistingRun::refuse);
    for (int i = 0; i < 5; ++i) directory.on_step(scene.simulation.step(), scene.simulation);
  }  // dropped without finish(), as by a killed process
  write_file(path("run/steps.csv"), read_file(path("run/steps.csv")) + "6,0.0");
  EXPECT_EQ(recording(path("run")).frames, 6);
}

TEST_F(RunRecording, RefusesDamagedFilesByName) {
  int count = 0;
  const auto after = [&](auto damage) {
    const fs::path directory = run("run" + std::to_string(++count));
    damage(directory);
    return refusal(directory);
  };
  EXPECT_THAT(after([](const fs::path& d) { cut(d / "frames/body_000004.vtu", "</Points>"); }),
              HasSubstr("body_000004.vtu"));
  EXPECT_THAT(after([](const fs::path& d) { fs::remove(d / "frames/body_000004.vtu"); }),
              HasSubstr("body_000004.vtu: cannot be read"));
  EXPECT_THAT(after([](const fs::path& d) {
                fs::copy_file(d / "frames/body_000000.vtu", d / "frames/body_000004.vtu",
                              fs::copy_options::overwrite_existing);
              }),
              "");
  EXPECT_THAT(after([](const fs::path& d) { cut(d / "steps.csv", "\n7,"); }), HasSubstr("steps.csv: ends at step"));
  EXPECT_THAT(after([](const fs::path& d) { cut(d / "checkpoint.bin", "q"); }), HasSubstr("checkpoint.bin"));
  EXPECT_THAT(after([](const fs::path& d) { fs::remove(d / "steps.csv"); }), HasSubstr("holds no run"));
  EXPECT_THAT(after([](const fs::path& d) { fs::remove(d / "iterations.csv"); }),
              HasSubstr("iterations.csv: cannot be read"));
  EXPECT_THAT(
      after([](const fs::path& d) { write_file(d / "scene.toml", read_file(d / "scene.toml") + "# changed\n"); }),
      HasSubstr("scene.toml was changed after the start of the run"));
}

TEST_F(RunRecording, HasCertificatesOnlyIfTheRunHasThem) {
  const fs::path directory = run("run", "", 3);
  Scene scene = load_scene(path("beam.toml"));
  const Decoded whole(recording(directory).text);
  for (const Json& row : whole.head["steps"]) {
    const StepReport report = scene.simulation.step();
    EXPECT_EQ(row["state_hash"], hex_digits(report.state_hash));
    EXPECT_EQ(row["energy_bound"], "holds");
    EXPECT_EQ(row["energy_slack"], report.energy_slack);
    EXPECT_EQ(row["decrement"], report.decrement);
    ASSERT_EQ(row["reactions"].size(), 1u);
    EXPECT_EQ(row["reactions"].begin().value()[1], report.resultants.pins[0].force[1]);
  }
  // Earlier versions lack the last four columns.
  std::string text = read_file(directory / "steps.csv");
  text = std::regex_replace(text, std::regex("(,[^,\n]*){4}\n"), "\n");
  write_file(directory / "steps.csv", text);
  const Decoded earlier(recording(directory).text);
  for (const Json& row : earlier.head["steps"]) {
    EXPECT_TRUE(row["state_hash"].is_null());
    EXPECT_TRUE(row["energy_slack"].is_null());
    EXPECT_EQ(row["energy_bound"], "none");
  }
}

// A changed table is refused or shown, without a crash.
TEST_F(RunRecording, SurvivesChangedBytesOfTheTable) {
  const fs::path directory = run("run", "", 2);
  const std::string text = read_file(directory / "steps.csv");
  for (size_t i = 0; i < text.size(); i += 7) {
    std::string changed = text;
    changed[i] = static_cast<char>(changed[i] ^ 0x15);
    write_file(directory / "steps.csv", changed);
    try {
      recording(directory);
    } catch (const InvalidInput&) {
    }
  }
}

TEST_F(RunRecording, KeepsTheReportBelowItsSizeLimit) {
  // The number of vertices of the default scene.
  write_file(path("block.toml"), R"(
[time]
step = 0.01
[solver]
max_iterations = 1
[[body]]
name = "block"
shape = { box = { upper = [1, 1, 1], cells = [13, 14, 14] } }
material = { model = "neo_hookean", young = 1e5, poisson = 0.4, density = 1000 }
[[body.pin]]
name = "base"
where = "y < 1e-6"
)");
  Scene scene = load_scene(path("block.toml"));
  ASSERT_GT(scene.simulation.model().mesh.vertex_count(), 3000);
  RunDirectory directory = RunDirectory::create(path("run"), scene, ExistingRun::refuse);
  take_steps(scene, directory, 30);
  const RecordedRun report = make_report(path("run"), scene);
  EXPECT_EQ(report.frames, 31);
  const size_t recorded = report.text.size() - page().size();
  EXPECT_LT(recorded * 201 / 31, 5'000'000u);  // extrapolated to 200 steps
}

}  // namespace
}  // namespace aspic::viewer

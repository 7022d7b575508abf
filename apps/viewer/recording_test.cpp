#include "viewer/recording_test.h"

#include <gmock/gmock.h>

#include "dynamics/mesh_error_text.h"
#include "io/vtu.h"
#include "viewer/fields.h"
#include "viewer/recording_code.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST_F(RunRecording, RoundsPositionsToTheNearestCode) {
  const fs::path directory = run("run");
  const Decoded decoded(recording(directory).text);
  ASSERT_EQ(decoded.frame_count(), 13);
  const std::vector<uint32_t> vertex = decoded.array<uint32_t>("cage.vertex");
  const std::vector<uint32_t> corner = decoded.array<uint32_t>("cage.corners");
  for (const int frame : {0, 1, 2, 12}) {
    const Vtu body = read_vtu(directory / ("frames/body_0000" + std::to_string(100 + frame).substr(1) + ".vtu"));
    const std::vector<double> x = decoded.positions(frame);
    ASSERT_EQ(vertex.size(), corner.size());
    for (size_t v = 0; v < vertex.size(); ++v)
      for (int k = 0; k < 3; ++k)
        ASSERT_NEAR(x[3 * corner[v] + k], body.mesh.rest[vertex[v]][k],
                    decoded.head["size"][k].get<double>() / 65535 / 2 + 1e-6);
  }
}

TEST(PositionRange, ExcludesFramesThatBlewUp) {
  const std::vector<float> start = {0, 0, 0, 1, 1, 1}, moved = {5, 0, 0, 6, 1, 1},
                           blown_up = {-1e30F, 0, 0, 1e30F, 1, 1};
  PositionRange range(start);
  range.add(moved);
  range.add(blown_up);
  EXPECT_EQ(range.lower[0], 0);
  EXPECT_EQ(range.upper[0], 6);
  PositionCode code(range);
  for (const std::vector<float>& frame : {start, moved, blown_up}) code.add(frame);
  EXPECT_EQ(code.bytes().size(), 3 * 2 * start.size());
}

TEST(ValueScale, CodesZeroExactlyAndKeepsSigns) {
  const std::vector<float> values = {-3, -1e-6F, 0, 1e-6F, 1, 250, std::numeric_limits<float>::quiet_NaN()};
  const ValueScale scale(values);
  EXPECT_LE(scale.min, -3);
  EXPECT_GE(scale.max, 250);
  const double step = (double{scale.max} - scale.min) / 254, zero = std::round(-scale.min / step);
  EXPECT_EQ(scale.code(0), zero);
  EXPECT_NEAR(zero * step, -scale.min, 1e-5 * step);
  EXPECT_LT(scale.code(-1e-6F), zero);
  EXPECT_GT(scale.code(1e-6F), zero);
  EXPECT_EQ(scale.code(values.back()), 255);
  for (const float value : {-3.F, 0.F, 1.F, 250.F}) EXPECT_NEAR((scale.code(value) - zero) * step, value, step);
  EXPECT_EQ(ValueScale(std::vector<float>{0, 5}).code(1e-9F), 1);
}

TEST_F(RunRecording, HasTheFieldsOfALiveSession) {
  const fs::path directory = run("run");
  const Decoded decoded(recording(directory).text);
  const Scene scene = load_scene(scene_of_run(directory));
  const Model& model = scene.simulation.model();
  const Surface surface = boundary_of(model);
  const std::vector<double> x =
      model.numbering.vertex.from_user(read_vtu_points(directory / "frames/body_000007.vtu"), 3);
  const std::vector<uint32_t> place = decoded.array<uint32_t>("cage.place");
  for (const std::string field : {"von_mises", "energy_density", "det_F", "stretch"}) {
    std::vector<float> live(surface.rest.size());
    FieldValues().evaluate(field, {scene.simulation, x}, surface, live);
    const std::vector<double> values = decoded.values(field, 7);
    const std::vector<float> range = decoded.array<float>("field." + field + ".range");
    const double step = 1.001 * (range[15] - range[14]) / 254;  // small values keep their sign
    for (size_t v = 0; v < live.size(); ++v)
      ASSERT_NEAR(values[place[v]], live[v], std::abs(live[v]) < step ? step : step / 2) << field;
  }
  EXPECT_EQ(decoded.array<float>("field.young")[0], 1e5f);
  const Json& fields = decoded.head["scenes"][0]["fields"];
  EXPECT_EQ(fields[0]["name"], "displacement");
  EXPECT_EQ(fields[1]["name"], "von_mises");
}

TEST_F(RunRecording, HasTheMessagesOfALiveSession) {
  const Decoded decoded(recording(run("run")).text);
  const Json& scene = decoded.head["scenes"][0];
  EXPECT_EQ(decoded.head["hello"]["live"], false);
  EXPECT_EQ(scene["name"], "beam");
  EXPECT_EQ(scene["surface"], "cage");
  EXPECT_EQ(scene["potentials"], Json({"elasticity", "gravity"}));
  EXPECT_EQ(scene["up"], Json({0.0, 1.0, 0.0}));
  EXPECT_THAT(decoded.head["toml"].get<std::string>(), HasSubstr("[[body.pin]]"));
  const Json& steps = decoded.head["steps"];
  ASSERT_EQ(steps.size(), 12u);
  EXPECT_EQ(steps[11]["step"], 12);
  EXPECT_EQ(steps[11]["status"], "converged");
  EXPECT_GT(steps[0]["iterations"].size(), 0u);
  EXPECT_GT(steps[0]["iterations"][0]["gradient_norm"].get<double>(), 0);
  EXPECT_EQ(steps[0]["iterations"][0]["trials"].size(), 0u);
  EXPECT_EQ(decoded.head["frames"]["step"][12], 12);
}

TEST_F(RunRecording, HasTheErrorOfTheMeshWhereEstimated) {
  write_file(path("beam.toml"), kRecordedBeam);
  Scene scene = load_scene(path("beam.toml"));
  RunDirectory directory = RunDirectory::create(path("run"), scene, ExistingRun::refuse);
  StepReport report;
  for (int step = 1; step <= 3; ++step) {
    report = scene.simulation.step();
    if (step == 3) add_mesh_error(scene.simulation, {}, report);
    directory.on_step(report, scene.simulation);
  }
  directory.finish(scene.simulation);
  const Decoded decoded(recording(path("run")).text);
  EXPECT_EQ(decoded.head["steps"][1]["mesh_error"], "");
  EXPECT_EQ(decoded.head["steps"][2]["mesh_error"], report.mesh_error);
  EXPECT_THAT(decoded.head["scenes"][0]["fields"].dump(), HasSubstr("mesh error"));
  const std::vector<uint8_t> codes = decoded.array<uint8_t>("field.mesh_error");
  EXPECT_EQ(codes[0], 255);  // no value
  const Surface surface = boundary_of(scene.simulation.model());
  std::vector<float> expected(surface.rest.size());
  const View view{scene.simulation, scene.simulation.state().q, report.mesh_density};
  FieldValues().evaluate("mesh_error", view, surface, expected);
  const std::vector<double> values = decoded.values("mesh_error", 3);
  const std::vector<uint32_t> place = decoded.array<uint32_t>("cage.place");
  const float largest = *std::max_element(expected.begin(), expected.end());
  EXPECT_GT(largest, 0);
  for (size_t v = 0; v < expected.size(); ++v) EXPECT_NEAR(values[place[v]], expected[v], largest / 250);
}

TEST_F(RunRecording, HasNoWallTimes) {
  const Decoded decoded(recording(run("run", "", 0, true)).text);
  for (const Json& step : decoded.head["steps"]) {
    EXPECT_EQ(step["seconds"], 0);
    for (const Json& iteration : step["iterations"])
      for (const auto& [stage, seconds] : iteration["seconds"].items()) EXPECT_EQ(seconds, 0) << stage;
  }
}

TEST_F(RunRecording, IsEqualAfterAResumedRun) {
  const fs::path whole = run("whole"), again = run("again", "", 5);
  Scene scene = load_scene(scene_of_run(again));
  RunDirectory directory = RunDirectory::resume(again, scene);
  take_steps(scene, directory, 12);
  EXPECT_TRUE(recording(whole).text == recording(again).text);
}

TEST_F(RunRecording, HasTheTrialsOfATrace) {
  const fs::path directory = run("run", "", 6, true);
  Scene scene = load_scene(scene_of_run(directory));
  RunDirectory resumed = RunDirectory::resume(directory, scene);
  take_steps(scene, resumed, 12, true);  // writes trace_after_6
  const Decoded decoded(recording(directory).text);
  for (const Json& step : decoded.head["steps"])
    for (const Json& iteration : step["iterations"]) {
      ASSERT_GT(iteration["trials"].size(), 0u) << step["step"];
      EXPECT_EQ(iteration["trials"].back()["accepted"], iteration["alpha"].get<double>() > 0);
    }
  cut(directory / "iterations.csv", "\n7,");
  write_file(directory / "iterations.csv", read_file(directory / "iterations.csv") + "\n");
  EXPECT_THAT(refusal(directory), HasSubstr("trials.csv: step 7 has no such iteration"));
}

TEST_F(RunRecording, HasBothSurfacesOfAFineSkin) {
  write_file(path("skin.obj"),
             "v 0.1 0.02 0.02\nv 0.9 0.02 0.02\nv 0.5 0.18 0.02\nv 0.5 0.1 0.18\n"
             "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  std::string text = kRecordedBeam;
  text.insert(text.find("material ="), "skin = \"skin.obj\"\n");
  write_file(path("beam.toml"), text);
  Scene scene = load_scene(path("beam.toml"));
  RunDirectory fine = RunDirectory::create(path("fine"), scene, ExistingRun::refuse);
  take_steps(scene, fine, 3);
  const Decoded decoded(recording(path("fine")).text);
  ASSERT_EQ(decoded.head["scenes"].size(), 2u);
  EXPECT_EQ(decoded.head["scenes"][0]["surface"], "skin");
  EXPECT_EQ(decoded.head["scenes"][1]["surface"], "cage");
  EXPECT_EQ(decoded.array<uint32_t>("skin.vertex"), std::vector<uint32_t>(4, 0xffffffff));
  const std::vector<uint32_t> corners = decoded.array<uint32_t>("skin.corners");
  const std::vector<float> weights = decoded.array<float>("skin.weights");
  ASSERT_EQ(corners.size(), 16u);
  const std::vector<double> x = decoded.positions(0);
  for (int k = 0; k < 3; ++k) {
    double carried = 0;
    for (size_t c = 0; c < 4; ++c) carried += weights[c] * x[3 * corners[c] + k];
    EXPECT_NEAR(carried, scene.skins[0].rest.vertices[0][k], 1e-4);
  }
}

}  // namespace
}  // namespace aspic::viewer

#include "viewer/recording.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <regex>

#include "base/error.h"
#include "base/hash.h"
#include "io/atomic_file.h"
#include "io/base64.h"
#include "io/folder_test.h"
#include "io/gzip.h"
#include "io/vtu.h"
#include "scene/run_directory.h"
#include "scene/trace.h"
#include "viewer/arguments.h"
#include "viewer/fields.h"
#include "viewer/page.h"
#include "viewer/recording_code.h"
#include "viewer/report.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kRecordedBeam = R"(
[time]
step = 0.01
duration = 0.12
[[body]]
name = "beam"
shape = { box = { upper = [1, 0.2, 0.2], cells = [6, 2, 2] } }
material = { model = "neo_hookean", young = 1e5, poisson = 0.3, density = 1000 }
[[body.pin]]
name = "clamp"
where = "x < 1e-6"
)";

// As web/src/recording.ts does.
class Decoded {
 public:
  explicit Decoded(const std::string& text) {
    std::string_view rest = text;
    std::string packed;
    EXPECT_TRUE(decode_base64(rest, text.size(), packed));
    bytes_ = gunzipped(packed, size_t{1} << 30);
    uint32_t length = 0;
    std::memcpy(&length, bytes_.data(), 4);
    head = Json::parse(bytes_.substr(4, length));
    start_ = (4 + length + 3) / 4 * 4;
  }

  template <class T>
  std::vector<T> array(const std::string& name) const {
    for (const Json& entry : head["arrays"]) {
      if (entry["name"] != name) continue;
      const std::map<std::string, size_t> sizes = {{"u8", 1}, {"u32", 4}, {"f32", 4}};
      EXPECT_EQ(sizes.at(entry["type"]), sizeof(T));
      std::vector<T> numbers(entry["count"].get<size_t>());
      std::memcpy(numbers.data(), bytes_.data() + start_ + entry["at"].get<size_t>(), numbers.size() * sizeof(T));
      return numbers;
    }
    ADD_FAILURE() << "no array " << name;
    return {};
  }

  int frame_count() const { return static_cast<int>(head["frames"]["step"].size()); }

  // 3 per point.
  std::vector<double> positions(int frame) const {
    const std::vector<uint8_t> bytes = array<uint8_t>("positions");
    const size_t n = bytes.size() / 2 / static_cast<size_t>(frame_count());
    std::vector<uint16_t> now(n), before(n), earlier(n);
    for (int f = 0; f <= frame; ++f) {
      for (size_t i = 0; i < n; ++i) {
        const int folded = bytes[2 * n * f + i] | bytes[2 * n * f + n + i] << 8;
        const int line = f == 0 ? 0 : f == 1 ? before[i] : 2 * before[i] - earlier[i];
        now[i] = static_cast<uint16_t>(line + ((folded >> 1) ^ -(folded & 1)));
      }
      earlier = before, before = now;
    }
    std::vector<double> x;
    for (size_t i = 0; i < n; ++i)
      x.push_back(head["lower"][i % 3].get<double>() + head["size"][i % 3].get<double>() * now[i] / 65535);
    return x;
  }

  // One per place.
  std::vector<double> values(const std::string& field, int frame) const {
    const std::vector<uint8_t> codes = array<uint8_t>("field." + field);
    const std::vector<float> range = array<float>("field." + field + ".range");
    const size_t n = codes.size() / static_cast<size_t>(frame_count());
    std::vector<double> values;
    for (size_t i = 0; i < n; ++i) {
      uint8_t code = 0;
      for (int f = 0; f <= frame; ++f) code = static_cast<uint8_t>(code + codes[n * f + i]);
      values.push_back(range[2 * frame] + (range[2 * frame + 1] - range[2 * frame]) * code / 254);
    }
    return values;
  }

  Json head;

 private:
  std::string bytes_;
  size_t start_ = 0;
};

class RunRecording : public FolderTest {
 protected:
  // Takes the steps of a scene into a directory; the rest of the scene's text comes after the beam's.
  fs::path run(const std::string& name, const std::string& more = "", int steps = 0, bool is_traced = false) {
    write_file(path("beam.toml"), kRecordedBeam + more);
    Scene scene = load_scene(path("beam.toml"));
    RunDirectory directory = RunDirectory::create(path(name), scene, ExistingRun::overwrite);
    take_steps(scene, directory, steps > 0 ? steps : scene.steps, is_traced);
    return path(name);
  }
  static void take_steps(Scene& scene, RunDirectory& directory, int last, bool is_traced = false) {
    std::optional<Trace> trace;
    if (is_traced) trace.emplace(directory.trace_folder(scene.simulation.steps_taken()));
    while (scene.simulation.steps_taken() < last) {
      const int step = scene.simulation.steps_taken() + 1;
      const StepReport report = scene.simulation.step([&](const LiveIteration& iteration) {
        directory.on_iteration(step, iteration);
        if (trace) trace->on_iteration(step, iteration);
      });
      directory.on_step(report, scene.simulation);
    }
    directory.finish(scene.simulation);
  }
  static RecordedRun recording(const fs::path& run, size_t max_bytes = RecordingOptions().max_bytes) {
    return record(run, load_scene(scene_of_run(run)), {.max_bytes = max_bytes});
  }
  static std::string refusal(const fs::path& run, size_t max_bytes = RecordingOptions().max_bytes) {
    return message_of<InvalidInput>([&] { recording(run, max_bytes); });
  }
  static void cut(const fs::path& file, const std::string& from) {
    const std::string text = read_file(file);
    write_file(file, text.substr(0, text.find(from)));
  }
};

TEST_F(RunRecording, HoldsPositionsToHalfAStepOfTheirCode) {
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

TEST(PositionRange, LeavesOutFramesThatBlewUp) {
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

TEST_F(RunRecording, HoldsTheFieldsOfALiveSession) {
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
    for (size_t v = 0; v < live.size(); ++v)
      ASSERT_NEAR(values[place[v]], live[v], (range[15] - range[14]) / 254 / 2 * 1.001) << field;
  }
  EXPECT_EQ(decoded.array<float>("field.young")[0], 1e5f);
  const Json& fields = decoded.head["scenes"][0]["fields"];
  EXPECT_EQ(fields[0]["name"], "displacement");
  EXPECT_EQ(fields[1]["name"], "von_mises");
}

TEST_F(RunRecording, TellsWhatALiveSessionTells) {
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

TEST_F(RunRecording, HoldsNoWallTimes) {
  const Decoded decoded(recording(run("run", "", 0, true)).text);
  for (const Json& step : decoded.head["steps"]) {
    EXPECT_EQ(step["seconds"], 0);
    for (const Json& iteration : step["iterations"])
      for (const auto& [stage, seconds] : iteration["seconds"].items()) EXPECT_EQ(seconds, 0) << stage;
  }
}

TEST_F(RunRecording, IsTheSameForTheSameResults) {
  const fs::path whole = run("whole"), again = run("again", "", 5);
  Scene scene = load_scene(scene_of_run(again));
  RunDirectory directory = RunDirectory::resume(again, scene);
  take_steps(scene, directory, 12);
  EXPECT_TRUE(recording(whole).text == recording(again).text);
}

TEST_F(RunRecording, HoldsTheTrialsOfATrace) {
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

TEST_F(RunRecording, LeavesOutFramesEvenlyToStayBelowItsLimit) {
  const fs::path directory = run("run", "", 120);
  const RecordedRun whole = recording(directory);
  EXPECT_EQ(whole.frames, 121);
  EXPECT_EQ(whole.note, "");
  const size_t limit = whole.text.size() * 7 / 10;
  const RecordedRun thin = recording(directory, limit);
  EXPECT_LE(thin.text.size(), limit);
  EXPECT_LT(thin.frames, 121);
  EXPECT_EQ(thin.frames_of_run, 121);
  EXPECT_THAT(thin.note, HasSubstr("of the run's 121 frames are shown"));
  const Decoded decoded(thin.text);
  const std::vector<int> steps = decoded.head["frames"]["step"];
  ASSERT_EQ(static_cast<int>(steps.size()), thin.frames);
  EXPECT_EQ(steps.front(), 0);
  EXPECT_EQ(steps.back(), 120);
  const double apart = 120.0 / (thin.frames - 1);
  for (size_t i = 0; i < steps.size(); ++i) EXPECT_NEAR(steps[i], apart * static_cast<double>(i), 1.01);
  EXPECT_EQ(decoded.head["scenes"][0]["notes"][0], thin.note);
  EXPECT_EQ(decoded.head["steps"].size(), 120u);  // tables stay whole
  EXPECT_THAT(refusal(directory, 3000), HasSubstr("raise --max-size"));
}

TEST_F(RunRecording, OfAFineSkinHasBothSurfaces) {
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

TEST_F(RunRecording, WithoutFramesShowsTheSkins) {
  const Decoded decoded(recording(run("run", "[output]\nvtu = false\n")).text);
  EXPECT_EQ(decoded.frame_count(), 13);
  EXPECT_EQ(decoded.head["scenes"][0]["fields"].size(), 1u);
  EXPECT_GT(decoded.array<uint32_t>("cage.triangles").size(), 0u);
  EXPECT_THAT(refusal(run("none", "[output]\nvtu = false\npc2 = false\nusd = false\n")),
              HasSubstr("run it again with output.vtu = true"));
}

TEST_F(RunRecording, ThatWasKilledIsShownUpToItsCheckpoint) {
  write_file(path("beam.toml"), kRecordedBeam + "[output]\ncheckpoint_every = 0\n");
  Scene scene = load_scene(path("beam.toml"));
  {
    RunDirectory directory = RunDirectory::create(path("run"), scene, ExistingRun::refuse);
    for (int i = 0; i < 5; ++i) directory.on_step(scene.simulation.step(), scene.simulation);
  }  // dropped without finish(), as a killed process drops it
  write_file(path("run/steps.csv"), read_file(path("run/steps.csv")) + "6,0.0");
  EXPECT_EQ(recording(path("run")).frames, 6);
}

TEST_F(RunRecording, RefusesWhatIsDamagedNamingTheFile) {
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
      HasSubstr("scene.toml was changed after the run began"));
}

TEST_F(RunRecording, HasTheCertificateOfEveryStepAndNoneWhereTheRunHasNone) {
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
  // As earlier versions wrote it: the last four columns are newer.
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

// Every byte of a table and of a frame: refused or shown, never a crash.
TEST_F(RunRecording, SurvivesEveryChangedByteOfItsTable) {
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

TEST_F(RunRecording, ReportIsBelowItsLimitWithAMargin) {
  // As many vertices and steps as the default scene has.
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
  const Report report = make_report(path("run"), scene);
  EXPECT_EQ(report.frames, 31);
  const size_t recorded = report.html.size() - page().size();
  EXPECT_LT(recorded * 201 / 31, 5'000'000u);  // of 200 steps
}

}  // namespace
}  // namespace aspic::viewer

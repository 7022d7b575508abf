// Runs, their recordings and the decoder for the tests of recordings.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/base64.h"
#include "io/folder_test.h"
#include "io/gzip.h"
#include "results/run_directory.h"
#include "results/trace.h"
#include "viewer/arguments.h"
#include "viewer/recording.h"

namespace aspic::viewer {

inline const std::string kRecordedBeam = R"(
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

// The decoder of web/src/recording.ts.
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
      if (!numbers.empty())
        std::memcpy(numbers.data(), bytes_.data() + start_ + entry["at"].get<size_t>(), numbers.size() * sizeof(T));
      return numbers;
    }
    ADD_FAILURE() << "no array " << name;
    return {};
  }

  int frame_count() const { return static_cast<int>(head["frames"]["step"].size()); }

  // Returns 3 coordinates per point.
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

  // Returns one value per place.
  std::vector<double> values(const std::string& field, int frame) const {
    const std::vector<uint8_t> codes = array<uint8_t>("field." + field);
    const std::vector<float> range = array<float>("field." + field + ".range");
    const size_t n = codes.size() / static_cast<size_t>(frame_count());
    std::vector<double> values;
    for (size_t i = 0; i < n; ++i) {
      uint8_t code = 0;
      for (int f = 0; f <= frame; ++f) code = static_cast<uint8_t>(code + codes[n * f + i]);
      const double min = range[2 * frame], step = (range[2 * frame + 1] - min) / 254, zero = std::round(-min / step);
      values.push_back(zero >= 0 && zero <= 254 ? (code - zero) * step : min + code * step);
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
  // Writes a run of the beam with further scene text. 0 steps: the number in the scene.
  std::filesystem::path run(const std::string& name, const std::string& more = "", int steps = 0,
                            bool is_traced = false) {
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
  static RecordedRun recording(const std::filesystem::path& run, size_t max_bytes = RecordingOptions().max_bytes) {
    return record(run, load_scene(scene_of_run(run)), {.max_bytes = max_bytes});
  }
  static std::string refusal(const std::filesystem::path& run, size_t max_bytes = RecordingOptions().max_bytes) {
    return message_of<InvalidInput>([&] { recording(run, max_bytes); });
  }
  static void cut(const std::filesystem::path& file, const std::string& from) {
    const std::string text = read_file(file);
    write_file(file, text.substr(0, text.find(from)));
  }
};

}  // namespace aspic::viewer

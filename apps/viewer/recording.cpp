#include "viewer/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <span>
#include <utility>

#include "base/error.h"
#include "contact/barrier.h"
#include "io/atomic_file.h"
#include "io/base64.h"
#include "io/checkpoint.h"
#include "io/gzip.h"
#include "scene/scene_document.h"
#include "viewer/fibre_lines.h"
#include "viewer/fields.h"
#include "viewer/page.h"
#include "viewer/recorded_body.h"
#include "viewer/recording_code.h"
#include "viewer/run_positions.h"
#include "viewer/run_tables.h"
#include "viewer/scene_json.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;

// Bounds the memory of unpacked frames relative to the maximum size of the text.
constexpr double kBytesInMemoryPerByteOfText = 12;
// Target size relative to the limit when frames are omitted, since fewer frames compress slightly worse.
constexpr double kAim = 0.95;

// The complete part of the run, up to its latest checkpoint.
struct Known {
  std::vector<double> frame_times;  // [s]
  int steps = 0;
  std::vector<double> obstacle_times;  // of the obstacles in the frames [s]
};

Known known(const RunLayout& layout, const std::string& scene_text) {
  if (!layout.holds_run()) throw InvalidInput(layout.root().string() + ": holds no run (there is no steps.csv of one)");
  const Checkpoint checkpoint = read_newest_checkpoint(layout.checkpoint()).checkpoint;
  if (checkpoint.fingerprint != fingerprint(scene_text))
    throw InvalidInput(layout.root().string() +
                       ": scene.toml was changed after the start of the run; restore the original, or run again");
  const int64_t steps = checkpoint.integer("steps_taken");
  if (steps < 0 || steps > std::numeric_limits<int>::max())
    throw InvalidInput(layout.root().string() + ": the checkpoint counts " + std::to_string(steps) +
                       " steps; it is damaged");
  const std::vector<double>* obstacles = checkpoint.find("obstacle_times");
  Known result{checkpoint.array("frame_times"), static_cast<int>(steps),
               obstacles ? *obstacles : checkpoint.array("frame_times")};
  if (result.obstacle_times.size() != result.frame_times.size())
    throw InvalidInput(layout.root().string() + ": the checkpoint is damaged");
  if (result.frame_times.empty()) throw InvalidInput(layout.root().string() + ": the checkpoint has no frames");
  return result;
}

// Returns the step that ends at the time of each frame. The start is step 0.
std::vector<int> steps_of_frames(const Known& known, const RunTables& tables, const fs::path& run) {
  std::vector<int> steps;
  size_t step = 0;
  for (const double time : known.frame_times) {
    if (!steps.empty())
      while (step < tables.steps.size() && (step == 0 || tables.steps[step - 1].report.time < time)) ++step;
    if (!steps.empty() && (step == 0 || tables.steps[step - 1].report.time != time))
      throw InvalidInput(run.string() + ": steps.csv has no step at the time " + std::to_string(time) + " s of frame " +
                         std::to_string(steps.size()) + "; the files are of different runs");
    steps.push_back(static_cast<int>(step));
  }
  return steps;
}

// Returns at most `wanted` of `count` indices, evenly spread, including the first and the last.
std::vector<int> evenly(int count, int wanted) {
  std::vector<int> indices;
  wanted = std::min(wanted, count);
  for (int i = 0; i < wanted; ++i)
    indices.push_back(static_cast<int>(std::lround(static_cast<double>(i) * (count - 1) / std::max(1, wanted - 1))));
  return indices;
}

struct Frame {
  int index = 0;
  std::vector<float> x;                    // 3 per point
  std::vector<std::vector<float>> values;  // values of kMoving fields
  std::vector<float> contacts;             // position and pressure of each contact point
  std::vector<uint32_t> contact_points;    // recorded point of each contact point; kNoVertex: of an obstacle
};

const std::set<std::string> kDerived = {"displacement", "contact_pressure"};  // from positions and contact points
const std::set<std::string> kMoving = {"von_mises", "energy_density",        "det_F",
                                       "stretch",   std::string(kMeshError), std::string(kBendingDensity)};

std::vector<float> flat(const std::vector<Vec3d>& points) {
  std::vector<float> numbers;
  for (const Vec3d& X : points)
    for (int k = 0; k < 3; ++k) numbers.push_back(static_cast<float>(X[k]));
  return numbers;
}

// Names the scene after its bodies. The recording does not depend on the name of the directory.
std::string name_of(const Scene& scene) {
  std::string name;
  for (const BodyRange& body : scene.simulation.model().bodies) name += (name.empty() ? "" : ", ") + body.name;
  return shortened(name);
}

class Recorder {
 public:
  Recorder(const fs::path& run, const Scene& scene, const RecordingOptions& options)
      : layout_(run),
        scene_(scene),
        options_(options),
        document_(read_scene_document(scene.resolved, "scene.toml")),
        scene_text_(read_file(layout_.scene())),
        known_(known(layout_, scene_text_)),
        tables_(read_run_tables(layout_, known_.steps)),
        step_of_frame_(steps_of_frames(known_, tables_, run)),
        positions_(run_positions(layout_, scene, frame_count())) {
    choose_fields();
    body_ = positions_->are_of_model() ? body_with_interior(scene) : body_of_skins(scene);
  }

  RecordedRun record() {
    const std::vector<Frame> frames = read(evenly(frame_count(), most_in_memory()));
    for (int wanted = static_cast<int>(frames.size());;) {
      const std::vector<int> chosen = evenly(static_cast<int>(frames.size()), wanted);
      const std::string note = omission_note(wanted);
      std::string text = packed(frames, chosen, note);
      if (text.size() <= options_.max_bytes) return {std::move(text), frame_count(), wanted, note};
      if (wanted <= 2) refuse(text.size());
      const double share = kAim * static_cast<double>(options_.max_bytes) / static_cast<double>(text.size());
      wanted = std::max(2, std::min(wanted - 1, static_cast<int>(wanted * share)));
    }
  }

 private:
  int frame_count() const { return static_cast<int>(known_.frame_times.size()); }

  int most_in_memory() const {
    const size_t numbers = 3 * body_.rest.size() + moving_.size() * body_.places.rest.size();
    const double per_frame = static_cast<double>(numbers) * sizeof(float);
    const double most =
        kBytesInMemoryPerByteOfText * static_cast<double>(options_.max_bytes) / std::max(1.0, per_frame);
    return static_cast<int>(std::clamp(most, 2.0, 1e9));
  }

  // Chooses the fields of a live session that positions determine.
  void choose_fields() {
    const bool has_interior = positions_->are_of_model();
    bool has_mesh_error = false;
    for (int frame = 0; frame < frame_count(); ++frame) has_mesh_error = has_mesh_error || is_estimated(frame);
    for (const Field& field : fields_of(scene_.simulation.model(), has_mesh_error)) {
      if (field.name == "speed" || (!has_interior && field.name != "displacement")) continue;
      fields_.push_back(field);
      if (kMoving.contains(field.name)) moving_.push_back(field.name);
      if (!kDerived.contains(field.name) && !kMoving.contains(field.name)) fixed_.push_back(field.name);
    }
  }

  // Whether the error of the mesh was estimated in the step of a frame.
  bool is_estimated(int frame) const {
    const int step = step_of_frame_[static_cast<size_t>(frame)];
    return step > 0 && tables_.steps[static_cast<size_t>(step) - 1].report.mesh_worst_tet >= 0;
  }

  // Returns NaN for a field of the frame that it does not have.
  std::vector<float> values(const std::string& field, const View& view) {
    std::vector<float> result(body_.places.rest.size(), std::numeric_limits<float>::quiet_NaN());
    if ((field == kMeshError && view.mesh_error.empty()) || (field == kBendingDensity && view.bending.empty()))
      return result;
    evaluator_.evaluate(field, view, body_.places, result);
    return result;
  }

  std::vector<Frame> read(const std::vector<int>& indices) {
    std::vector<Frame> frames;
    for (const int index : indices) {
      const std::vector<double> x = positions_->frame(index);
      std::vector<double> mesh_error, bending;
      if (is_estimated(index)) mesh_error = positions_->cell_field(index, kMeshError);
      if (std::find(moving_.begin(), moving_.end(), kBendingDensity) != moving_.end())
        bending = positions_->cell_field(index, kBendingDensity);
      const View view{scene_.simulation, x, mesh_error, bending};
      Frame& frame = frames.emplace_back(Frame{.index = index});
      for (const int v : body_.source)
        for (size_t k = 0; k < 3; ++k) frame.x.push_back(static_cast<float>(x[3 * static_cast<size_t>(v) + k]));
      for (const TubePoint& point : body_.tube) {
        const Vec3d position = point.position(x);
        for (int k = 0; k < 3; ++k) frame.x.push_back(static_cast<float>(position[k]));
      }
      for (const std::string& field : moving_) frame.values.push_back(values(field, view));
      if (fixed_values_.empty())
        for (const std::string& field : fixed_) fixed_values_.push_back(values(field, view));
      if (positions_->are_of_model()) add_contacts(frame, x);
    }
    return frames;
  }

  // Contact points are recorded as they are: codes would lose pairs that barely touch.
  void add_contacts(Frame& frame, std::span<const double> x) const {
    const Barrier* contact = scene_.simulation.model().contact;
    if (!contact) return;
    const double time = known_.obstacle_times[static_cast<size_t>(frame.index)];
    for (const ContactPoint& touching : contact->contact_points(x, time)) {
      for (int k = 0; k < 3; ++k) frame.contacts.push_back(static_cast<float>(touching.position[k]));
      frame.contacts.push_back(static_cast<float>(touching.pressure));
      const auto point = std::lower_bound(body_.source.begin(), body_.source.end(), touching.row);
      const bool is_recorded = point != body_.source.end() && *point == touching.row;
      frame.contact_points.push_back(is_recorded ? static_cast<uint32_t>(point - body_.source.begin()) : kNoVertex);
    }
  }

  std::string omission_note(int frames) const {
    if (frames == frame_count()) return "";
    return std::to_string(frames) + " of the run's " + std::to_string(frame_count()) +
           " frames are included, at even intervals, to respect the size limit (--max-size)";
  }

  [[noreturn]] void refuse(size_t bytes) const {
    throw InvalidInput(layout_.root().string() + ": two frames and the tables need " +
                       std::to_string(bytes / 1'000'000 + 1) + " MB, more than the limit; raise --max-size");
  }

  std::string packed(const std::vector<Frame>& frames, const std::vector<int>& chosen, const std::string& note) const {
    ArrayPack pack;
    add_body(pack);
    const PositionRange range = add_motion(pack, frames, chosen);
    std::vector<float> contacts;
    std::vector<uint32_t> contact_points;
    Json head = {{"format", 1}};
    head["hello"] = hello();
    head["scenes"] = scene_messages(box_of(std::span<const float>(frames.front().x)), note);
    const Model& model = scene_.simulation.model();
    head["obstacles"] = obstacles_json(model, 0);
    if (has_fibres(model))
      for (const RecordedSurface& recorded : body_.surfaces)
        head["fibres"].push_back(fibre_lines(model, recorded.surface));
    head["toml"] = scene_text_;
    head["steps"] = Json::array();
    for (const StepRow& row : tables_.steps) head["steps"].push_back(to_json(row));
    head["frames"]["step"] = Json::array();
    head["frames"]["time"] = Json::array();
    for (const int i : chosen) {
      const size_t index = static_cast<size_t>(frames[i].index);
      head["frames"]["step"].push_back(step_of_frame_[index]);
      head["frames"]["time"].push_back(known_.frame_times[index]);
      head["frames"]["contacts"].push_back(frames[i].contact_points.size());
      contacts.insert(contacts.end(), frames[i].contacts.begin(), frames[i].contacts.end());
      contact_points.insert(contact_points.end(), frames[i].contact_points.begin(), frames[i].contact_points.end());
      if (model.contact && model.contact->has_moving_obstacle())
        head["frames"]["obstacles"].push_back(obstacles_json(model, known_.obstacle_times[index]));
    }
    pack.add("contact.at", contacts);
    pack.add("contact.point", contact_points);
    head["lower"] = range.lower.a;
    head["size"] = range.size().a;
    std::string text;
    append_base64(gzipped(pack.bytes(std::move(head))), text);
    return text;
  }

  Json hello() const {
    const Value* version = document_.find("version");
    return {{"kind", "hello"}, {"protocol", 1}, {"version", version ? version->text() : ""},
            {"steers", true},  {"live", false}, {"lessons", Json::array()}};
  }

  // Returns one message per surface. The solver is the requested one: the summary of the run names the choice of
  // `auto`.
  Json scene_messages(const Box& start, const std::string& note) const {
    const Value& solver = *document_.find("solver");
    const bool is_implicit = scene_.simulation.integrator().is_implicit;
    Json message = scene_json(scene_, document_, start, fields_);
    message.update({{"side", "a"},
                    {"name", name_of(scene_)},
                    {"label", ""},
                    {"path", ""},
                    {"overrides", Json::array()},
                    {"loaded_overrides", Json::array()},
                    {"notes", Json::array()},
                    {"solver", is_implicit ? fmt::format("{}, {} for the linear systems", solver["method"].text(),
                                                         solver["linear"].text())
                                           : ""},
                    {"potentials", tables_.potentials},
                    {"field", ""},
                    {"stiffness", 0}});
    if (!note.empty()) message["notes"].push_back(note);
    Json messages = Json::array();
    for (size_t i = 0; i < body_.surfaces.size(); ++i) {
      message["generation"] = i + 1;
      message["surface"] = body_.surfaces[i].name;
      messages.push_back(message);
    }
    return messages;
  }

  void add_body(ArrayPack& pack) const {
    pack.add("point.rest", flat(body_.rest));
    pack.add("point.mass", std::vector<float>(body_.mass.begin(), body_.mass.end()));
    pack.add("point.pinned", body_.is_pinned);
    for (const RecordedSurface& surface : body_.surfaces) add_surface(pack, surface);
    for (size_t i = 0; i < fixed_.size(); ++i) pack.add("field." + fixed_[i], fixed_values_[i]);
  }

  void add_surface(ArrayPack& pack, const RecordedSurface& recorded) const {
    const Surface& surface = recorded.surface;
    const std::string prefix = recorded.name + ".";
    int width = 1;  // the same for all vertices
    for (const Carrier& carrier : surface.carrier) width = std::max(width, carrier.count);
    std::vector<uint32_t> triangles, corners;
    std::vector<float> weights;
    for (const Triangle& t : surface.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
    for (const Carrier& carrier : surface.carrier)
      for (int n = 0; n < width; ++n) {
        corners.push_back(carrier.vertex[n < carrier.count ? n : 0]);
        weights.push_back(static_cast<float>(carrier.weight[n]));  // 0 beyond its vertices
      }
    pack.add(prefix + "rest", flat(surface.rest));
    pack.add(prefix + "triangles", triangles);
    pack.add(prefix + "tet", recorded.tet);
    pack.add(prefix + "vertex", recorded.vertex);
    pack.add(prefix + "corners", corners);
    if (width > 1) pack.add(prefix + "weights", weights);
    if (!recorded.place.empty()) pack.add(prefix + "place", recorded.place);
  }

  PositionRange add_motion(ArrayPack& pack, const std::vector<Frame>& frames, const std::vector<int>& chosen) const {
    PositionRange range(frames.front().x);
    for (const int i : chosen) range.add(frames[i].x);
    PositionCode positions(range);
    for (const int i : chosen) positions.add(frames[i].x);
    pack.add("positions", positions.bytes());
    for (size_t k = 0; k < moving_.size(); ++k) {
      ValueCode values;
      for (const int i : chosen) values.add(frames[i].values[k]);
      pack.add("field." + moving_[k], values.bytes());
      pack.add("field." + moving_[k] + ".range", values.ranges());
    }
    return range;
  }

  RunLayout layout_;
  const Scene& scene_;
  RecordingOptions options_;
  Table document_;  // with all values
  std::string scene_text_;
  Known known_;
  RunTables tables_;
  std::vector<int> step_of_frame_;
  std::unique_ptr<RunPositions> positions_;
  RecordedBody body_;
  std::vector<Field> fields_;                // fields to show; only the displacement if the run has no interior
  std::vector<std::string> moving_, fixed_;  // names of the fields stored per frame and once
  std::vector<std::vector<float>> fixed_values_;
  FieldValues evaluator_;
};

}  // namespace

RecordedRun record(const fs::path& run, const Scene& scene, const RecordingOptions& options) {
  return Recorder(run, scene, options).record();
}

std::string page_with_recording(std::string_view text) {
  return page_with(fmt::format("<script type=\"application/json\" id=\"recording\">\"{}\"</script>", text));
}

RecordedRun make_report(const fs::path& run, const Scene& scene, const RecordingOptions& options) {
  const size_t page_alone = page_with_recording("").size();
  if (page_alone >= options.max_bytes)
    throw InvalidInput(fmt::format("--max-size: the page alone has {:.1f} MB; allow more", page_alone / 1e6));
  RecordedRun report = record(run, scene, {.max_bytes = options.max_bytes - page_alone});
  report.text = page_with_recording(report.text);
  return report;
}

}  // namespace aspic::viewer

// The commands for settings, scenes, comparisons, replays, colors and surfaces.
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include "base/error.h"
#include "base/printable.h"
#include "io/atomic_file.h"
#include "io/base64.h"
#include "io/external_program.h"
#include "io/gzip.h"
#include "viewer/arguments.h"
#include "viewer/commands.h"
#include "viewer/playback.h"
#include "viewer/settings.h"

namespace aspic::viewer {
namespace {

using Overrides = std::vector<std::string>;
using Uploaded = std::shared_ptr<const TemporaryFolder>;

constexpr size_t kMaxUploadedFiles = 64, kMaxUploadedBytes = size_t{200} << 20;

namespace fs = std::filesystem;

constexpr size_t kLongestName = 200;  // [bytes]
// A scene may read from its parent folder. The upload therefore has a parent folder, too.
const char* const kScenes = "files";

// Throws InvalidInput for a name outside the upload.
fs::path confined(const std::string& name) {
  const fs::path path = name;
  bool is_plain = !name.empty() && name.size() <= kLongestName && path.is_relative() && !path.has_root_path();
  for (const fs::path& part : path) is_plain = is_plain && !part.empty() && part != "." && part != "..";
  for (const char c : name) is_plain = is_plain && static_cast<unsigned char>(c) >= ' ' && c != '\\' && c != ':';
  if (!is_plain)
    throw InvalidInput(
        fmt::format("load.files: invalid name '{}'; a relative path of at most {} bytes without "
                    "'..' is expected",
                    printable(shortened(name)), kLongestName));
  return path;
}

std::string unpacked(const std::string& name, const std::string& text, size_t most) {
  std::string_view rest = text;
  std::string packed;
  if (!decode_base64(rest, text.size(), packed) || !rest.empty())
    throw InvalidInput("load.files: " + printable(name) + ": is not base64");
  try {
    return gunzipped(packed, most);
  } catch (const InvalidInput& error) {
    throw InvalidInput("load.files: " + printable(name) + ": " + error.what());
  }
}

// Writes [{"name", "gzip"}, ...], each file gzipped and in base64, into a new temporary folder. Names are relative
// paths below it. Throws InvalidInput for malformed data, and above kMaxUploadedFiles or kMaxUploadedBytes.
std::unique_ptr<TemporaryFolder> written_upload(const Json& files) {
  if (!files.is_array() || files.empty() || files.size() > kMaxUploadedFiles)
    refuse("load.files", files.is_array() ? Json(files.size()) : files,
           fmt::format("a list of 1 to {} files is expected", kMaxUploadedFiles));
  auto folder = std::make_unique<TemporaryFolder>();
  size_t left = kMaxUploadedBytes;
  for (const Json& file : files) {
    Arguments arguments(file, "load.files");
    const fs::path path = folder->path() / kScenes / confined(arguments.text("name"));
    const Json& packed = arguments.value("gzip");
    arguments.finish();
    if (!packed.is_string()) refuse("load.files.gzip", packed, "base64 is expected");
    const std::string bytes = unpacked(path.filename().string(), packed.get_ref<const std::string&>(), left);
    left -= bytes.size();
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) throw InvalidInput(path.parent_path().string() + ": cannot be created: " + error.message());
    write_file(path, bytes);
  }
  return folder;
}

// Returns the uploaded file of that name. Throws InvalidInput if it is missing.
fs::path uploaded_file(const TemporaryFolder& folder, const std::string& name) {
  const fs::path path = folder.path() / kScenes / confined(name);
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    throw InvalidInput("load.scene: '" + printable(shortened(name)) + "' is not one of the files that came with it");
  return path;
}

constexpr size_t kMaxRecordingBytes = size_t{32} << 20;

void set(const SessionOptions& options, Stage& stage, Arguments& arguments) {
  const std::string key = arguments.text("key", 200);
  const Json value = arguments.value("value");
  const ShownSide* only = arguments.has("side") ? &stage.named(arguments) : nullptr;
  arguments.finish();
  const auto is_compared = [&] {  // such a key keeps its values
    if (!stage.comparison()) return false;
    const std::vector<std::string>& overrides = stage.comparison()->overrides;
    return std::any_of(overrides.begin(), overrides.end(), [&](const std::string& o) { return key_of(o) == key; });
  };
  struct Prepared {
    ShownSide& shown;
    SceneChange change;
  };
  std::vector<Prepared> prepared;
  Busy busy(options);
  for (ShownSide& shown : stage.sides()) {
    if (only ? only != &shown : &shown == stage.b() && is_compared()) continue;
    const SteeredScene& steered = shown.side.steered();
    const std::string change = value.is_null() ? setting_key(key) : setting_override(steered.document, key, value);
    prepared.push_back({shown, changed_scene(steered, change, std::ref(busy), options)});
  }
  for (Prepared& p : prepared) {
    p.shown.side.apply(std::move(p.change));
    stage.send_scene(p.shown);
  }
  stage.body_changed();
  Json done = {{"do", "set"}, {"key", key}, {"value", value}};
  if (only) done["side"] = only->name;
  stage.record(std::move(done));
}

// Returns the uploaded files of the page; null: none.
Uploaded load(const SessionOptions& options, Stage& stage, Playback& playback, Arguments& arguments) {
  const std::string path = arguments.text("scene");
  const Overrides overrides = arguments.has("overrides") ? arguments.texts("overrides") : Overrides{};
  Uploaded files;
  if (arguments.has("files")) files = written_upload(arguments.value("files"));
  arguments.finish();
  const std::filesystem::path place = files ? uploaded_file(*files, path) : std::filesystem::path(path);
  playback.install(stage.loaded(place, overrides));
  if (!files && options.note_loaded) options.note_loaded(place);
  return files;
}

const Lesson& lesson_of(const std::vector<Lesson>& lessons, const std::string& id) {
  std::vector<std::string> known;
  for (const Lesson& lesson : lessons) {
    known.push_back(lesson.id);
    if (lesson.id != id) continue;
    if (!lesson.missing.empty()) throw InvalidInput(lesson.missing);
    return lesson;
  }
  throw InvalidInput(fmt::format("no lesson '{}'{}", id, suggestion(id, known)));
}

Overrides with_overrides(Overrides overrides, const Overrides& further) {
  for (const std::string& text : further) overrides = with_override(std::move(overrides), text);
  return overrides;
}

void lesson(const SessionOptions& options, Stage& stage, Playback& playback, Arguments& arguments) {
  const std::string id = arguments.text("lesson", 200);
  arguments.finish();
  const Lesson& lesson = lesson_of(options.lessons, id);
  if (lesson.scene.empty()) return;  // opens only its panel
  std::optional<Recording> recording;
  if (lesson.recording) recording = read_recording(parse_json(lesson.recording(), kMaxRecordingBytes));
  std::optional<Recording::Comparison> compared;
  std::optional<Overrides> of_b;
  if (!lesson.comparison.empty()) {
    compared = {lesson.comparison.front().overrides, lesson.comparison.front().label};
    of_b = with_overrides(lesson.overrides, compared->overrides);
  }
  std::vector<ShownSide> sides = stage.loaded(lesson.scene, lesson.overrides, of_b);
  stage.set_field(lesson.field);
  playback.install(std::move(sides), std::move(compared), std::move(recording));
}

void compare(Stage& stage, Playback& playback, Arguments& arguments) {
  Recording::Comparison compared{arguments.texts("overrides"), arguments.text("label", 200)};
  arguments.finish();
  for (const std::string& text : compared.overrides)
    if (text.find('=') == std::string::npos)  // with_override() would drop a setting
      throw InvalidInput("overrides: '" + text + "' is not KEY=VALUE");
  const SteeredScene& steered = stage.a().side.steered();
  std::vector<ShownSide> sides =
      stage.loaded(steered.path, steered.overrides, with_overrides(steered.overrides, compared.overrides));
  playback.install(std::move(sides), std::move(compared));
}

void replay(Stage& stage, Playback& playback, Arguments& arguments) {
  Recording recording = read_recording(arguments.value("recording"));
  arguments.finish();
  std::optional<Recording::Comparison> compared = recording.compare;
  std::optional<Overrides> of_b;
  if (compared) of_b = with_overrides(recording.overrides, compared->overrides);
  std::vector<ShownSide> sides = stage.loaded(recording.scene, recording.overrides, of_b);
  playback.install(std::move(sides), std::move(compared), std::move(recording));
}

void color(Stage& stage, Arguments& arguments) {
  const std::string name = arguments.text("field", 100);
  arguments.finish();
  std::vector<std::string> known;
  for (const Field& f : stage.a().fields()) known.push_back(f.name);
  if (!name.empty() && !stage.a().has_field(name))
    throw InvalidInput(fmt::format("no field '{}'{}", name, suggestion(name, known)));
  stage.set_field(name);
  stage.mark_changed();
  for (const ShownSide& shown : stage.sides()) stage.send_scene(shown);
}

void surface(Stage& stage, Arguments& arguments) {
  const std::string which = arguments.choice("which", {"skin", "cage"});
  arguments.finish();
  stage.show_surface(which == "skin");
  for (const ShownSide& shown : stage.sides()) {
    stage.send_scene(shown);
    stage.send_shape(shown);
    stage.send(pins_message(shown));
  }
  stage.record({{"do", "surface"}, {"which", which}});
}

}  // namespace

void add_scene_commands(const SessionOptions& options, Stage& stage, Playback& playback, Commands& commands) {
  commands["set"] = {[&](Arguments& a) { set(options, stage, a); }};
  commands["load"] = {[&, latest = Uploaded()](Arguments& a) mutable {
    if (Uploaded files = load(options, stage, playback, a)) latest = std::move(files);
  }};
  commands["lesson"] = {[&](Arguments& a) { lesson(options, stage, playback, a); }, false};
  commands["compare"] = {[&](Arguments& a) { compare(stage, playback, a); }};
  commands["end_compare"] = {plain([&] { stage.end_comparison(); })};
  commands["replay"] = {[&](Arguments& a) { replay(stage, playback, a); }, false};
  commands["color"] = {[&](Arguments& a) { color(stage, a); }, false};
  commands["surface"] = {[&](Arguments& a) { surface(stage, a); }};
}

}  // namespace aspic::viewer

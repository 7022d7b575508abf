// The commands about what is simulated: other settings, other scenes, and comparisons.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "viewer/session_impl.h"
#include "viewer/upload.h"

namespace aspic::viewer {

void Session::Impl::set(Arguments& arguments) {
  const std::string key = arguments.text("key", 200);
  const Json value = arguments.value("value");
  const bool has_side = arguments.has("side");
  ShownSide* only = has_side ? &side_of(arguments) : nullptr;
  arguments.finish();
  const auto is_compared = [&] {  // what the sides differ in stays different
    if (!comparison) return false;
    return std::any_of(comparison->overrides.begin(), comparison->overrides.end(),
                       [&](const std::string& o) { return key_of(o) == key; });
  };
  struct Prepared {
    ShownSide& shown;
    Side::Change change;
  };
  std::vector<Prepared> prepared;
  Busy busy(options);
  for (ShownSide* shown : {a.get(), b.get()}) {
    if (!shown || (only && only != shown)) continue;
    if (!only && shown == b.get() && is_compared()) continue;
    const SteeredScene& steered = shown->side.steered();
    const std::string change = value.is_null() ? setting_key(key) : setting_override(steered.document, key, value);
    prepared.push_back({*shown, shown->side.prepared(change, busy.announce())});
  }
  for (Prepared& p : prepared) {
    p.shown.side.apply(std::move(p.change));
    tell(scene_message(p.shown, field));
  }
  keep_bench();
  ++version;
  Json done = {{"do", "set"}, {"key", key}, {"value", value}};
  if (only) done["side"] = only->name;
  note(std::move(done));
}

void Session::Impl::load(Arguments& arguments) {
  const std::string path = arguments.text("scene");
  const std::vector<std::string> overrides =
      arguments.has("overrides") ? arguments.texts("overrides") : std::vector<std::string>{};
  std::unique_ptr<TemporaryFolder> files;
  if (arguments.has("files")) files = written_upload(arguments.value("files"));
  arguments.finish();
  const std::filesystem::path place = files ? uploaded_file(*files, path) : std::filesystem::path(path);
  install(loaded("a", place, overrides), nullptr, std::nullopt);
  if (files) {
    uploaded = std::move(files);
  } else if (options.note_loaded) {
    options.note_loaded(place);
  }
}

void Session::Impl::lesson(Arguments& arguments) {
  const std::string id = arguments.text("lesson", 200);
  arguments.finish();
  std::vector<std::string> known;
  const Lesson* lesson = nullptr;
  for (const Lesson& candidate : options.lessons) {
    known.push_back(candidate.id);
    if (candidate.id == id) lesson = &candidate;
  }
  if (!lesson) throw InvalidInput(fmt::format("no lesson '{}'{}", id, suggestion(id, known)));
  if (!lesson->missing.empty()) throw InvalidInput(lesson->missing);
  if (lesson->scene.empty()) return;  // its panel needs none
  std::optional<Recording> recording;
  if (lesson->recording) recording = read_recording(parse_json(lesson->recording(), size_t{32} << 20));
  auto first = loaded("a", lesson->scene, lesson->overrides);
  std::unique_ptr<ShownSide> second;
  std::optional<Recording::Comparison> compared;
  if (!lesson->comparison.empty()) {
    compared = {lesson->comparison.front().overrides, lesson->comparison.front().label};
    std::vector<std::string> overrides = lesson->overrides;
    overrides.insert(overrides.end(), compared->overrides.begin(), compared->overrides.end());
    second = loaded("b", lesson->scene, overrides);
  }
  field = lesson->field;
  install(std::move(first), std::move(second), std::move(compared));
  if (recording) start_replay(*std::move(recording));
}

void Session::Impl::compare(Arguments& arguments) {
  Recording::Comparison compared{arguments.texts("overrides"), arguments.text("label", 200)};
  arguments.finish();
  const SteeredScene& steered = a->side.steered();
  std::vector<std::string> overrides = steered.overrides;
  for (const std::string& text : compared.overrides)
    if (text.find('=') == std::string::npos)  // which drops a setting elsewhere
      throw InvalidInput("overrides: '" + text + "' is not KEY=VALUE");
  for (const std::string& text : compared.overrides) overrides = with_override(std::move(overrides), text);
  auto second = loaded("b", steered.path, overrides);
  install(loaded("a", steered.path, steered.overrides), std::move(second), std::move(compared));
}

void Session::Impl::end_compare(Arguments& arguments) {
  arguments.finish();
  if (!b) throw InvalidInput("nothing is being compared");
  b.reset();
  comparison.reset();
  log.forget_side_b();
  a->label.clear();
  ++version;
  tell(text({{"kind", "end_compare"}}));
  tell(scene_message(*a, field));
}

}  // namespace aspic::viewer

// Messages of the viewer's page, and runs packed into a page.
#include <string>

#include "io/checkpoint.h"
#include "results/run_directory.h"
#include "run_files.h"
#include "several_files.h"
#include "targets.h"
#include "viewer/arguments.h"
#include "viewer/command_log.h"
#include "viewer/recording.h"
#include "viewer/server_access.h"
#include "viewer/server_message.h"
#include "viewer/session.h"

namespace aspic::fuzz {
namespace {

namespace fs = std::filesystem;
using viewer::Json;

constexpr size_t kMaxMessages = 8;
constexpr double kFewTets = 100;

// Checks that messages to a page are valid and that refusals are printable.
void require_messages(const viewer::Messages& messages) {
  for (const viewer::Message& message : messages) {
    if (message.is_binary) continue;
    const Json json = Json::parse(message.bytes, nullptr, false);
    require(json.is_object() && json.contains("kind"), "a message to a page is a JSON object with a kind");
    if (json["kind"] == "refused") require_message(json["why"].get<std::string>());
  }
}

// The only command that writes files.
bool saves(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  return json.is_object() && json.contains("do") && json["do"] == "save_capture";
}

}  // namespace

void page_text(std::string_view bytes) {
  const viewer::Target address = viewer::parse_target(bytes);
  require(bytes.starts_with(address.path), "an address begins with its path");
  const viewer::MessageHead head = viewer::parse_head(bytes);
  require(Json::parse(head.id, nullptr, false).is_primitive(), "the id of a message is a number or null");
  const viewer::Recording recording = viewer::read_recording(viewer::parse_json(bytes, bytes.size()));
  const Json json = viewer::to_json(recording);
  require(viewer::to_json(viewer::read_recording(json)) == json, "a recorded session reads back the same");
}

void session(std::string_view bytes) {
  static const fs::path scene = [] {
    const fs::path path = folder_of_process() / "session.toml";
    put_file(path,
             "[time]\nstep = 0.01\n[[body]]\nname = \"a\"\nshape = { box = { upper = [1, 1, 1], cells = [1, 1, 1] } }\n"
             "[[body.pin]]\nwhere = \"y < 0.5\"\n");
    return path;
  }();
  viewer::Session session(scene, {}, {.timeline_bytes = 1 << 20, .most_tets = kFewTets});
  for (size_t count = 0; !bytes.empty() && count < kMaxMessages; ++count) {
    const std::string_view line = bytes.substr(0, bytes.find('\n'));
    bytes.remove_prefix(std::min(bytes.size(), line.size() + 1));
    if (saves(line)) continue;
    const viewer::Answer answer = session.handle(line, viewer::Role::steers);
    require_messages(answer.to_sender);
    require_messages(answer.to_all);
    require_messages(session.advance());
  }
  require_messages(session.greeting(viewer::Role::steers));
}

void run_recording(std::string_view bytes) {
  static const Folder begun = begun_run(2);
  const fs::path run = folder_of_process() / "run";
  begun.restore(run);
  const Files files(run, bytes,
                    {"checkpoint.bin", "steps.csv", "iterations.csv", "trace/trials.csv", "frames/body_000001.vtu",
                     "skins/skin_a.pc2", "run.pvd"});
  const Scene scene = load_scene(scene_of_run(run), small_scenes());
  make_checkpoint_right(run / "checkpoint.bin", fingerprint(scene.resolved));
  viewer::record(run, scene);
}

}  // namespace aspic::fuzz

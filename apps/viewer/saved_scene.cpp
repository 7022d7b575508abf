#include "viewer/saved_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/base64.h"
#include "io/external_program.h"
#include "io/gzip.h"
#include "scene/schema.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxReplyBytes = size_t{40} << 20;
constexpr double kSameTime = 1e-6;  // fraction of a step
const char* const kByHand = "by_hand";

Value of(double number) { return {number, {}}; }
Value of(int number) { return {static_cast<std::int64_t>(number), {}}; }
Value of(const Vec3d& v) { return {Array{of(v[0]), of(v[1]), of(v[2])}, {}}; }
Value of(Table table) { return {std::move(table), {}}; }

// The body of a vertex, and the user's number of the vertex in it.
struct BodyVertex {
  size_t body = 0;
  int vertex = 0;
};
BodyVertex in_body(const Model& model, int vertex) {
  const int user = model.numbering.vertex.to_user(vertex);
  for (size_t b = 0; b < model.bodies.size(); ++b)
    if (const int local = user - model.bodies[b].first_vertex; local >= 0 && local < model.bodies[b].vertex_count)
      return {b, local};
  return {};
}

void append(Table& body, const char* key, Table entry) {
  Value* list = body.find(key);
  if (!list) {
    body.set(key, {Array{}, {}});
    list = body.find(key);
  }
  list->array().push_back(of(std::move(entry)));
}

// ---------------------------------------------------------------- the mouse

bool continues(const Grab& before, const Grab& next) {
  const double h = next.to_time - next.from_time;
  return before.vertices == next.vertices && before.weights == next.weights && before.stiffness == next.stiffness &&
         std::equal(before.to.a, before.to.a + 3, next.from.a) &&
         std::abs(next.from_time - before.to_time) < kSameTime * h;
}

Table grab_table(const Model& model, const Grab& grab) {
  Array point;
  for (int i = 0; i < 4; ++i) {
    Table share;
    share.set("vertex", of(in_body(model, grab.vertices[i]).vertex));
    share.set("weight", of(grab.weights[i]));
    point.push_back(of(std::move(share)));
  }
  Table table;
  table.set("stiffness", of(grab.stiffness));
  table.set("point", {std::move(point), {}});
  return table;
}

Value place(double time, const Vec3d& position) {
  Table table;
  table.set("time", of(time));
  table.set("position", of(position));
  return of(std::move(table));
}

void add_drags(const Side& side, Table& document) {
  const std::vector<History::Pull>& pulls = side.history().pulls();
  for (size_t k = 0; k < pulls.size();) {
    const Grab& first = pulls[k].grab;
    Array path = {place(first.from_time, first.from)};
    do {
      path.push_back(place(pulls[k].grab.to_time, pulls[k].grab.to));
      ++k;
    } while (k < pulls.size() && continues(pulls[k - 1].grab, pulls[k].grab));
    Table table = grab_table(side.model(), first);
    table.set("path", {std::move(path), {}});
    const size_t body = in_body(side.model(), first.vertices[0]).body;
    append(document.find("body")->array()[body].table(), "grab", std::move(table));
  }
  Table& time = document.find("time")->table();
  if (!pulls.empty()) time.set("duration", of(std::max((*time.find("duration")).number(), pulls.back().grab.to_time)));
}

// ---------------------------------------------------------------- pins by hand

using VerticesOfPin = std::map<std::string, std::vector<int>>;  // key: name of the pin in its body

std::vector<VerticesOfPin> by_body(const Model& model, const std::vector<Pin>& pins) {
  std::vector<VerticesOfPin> found(model.bodies.size());
  for (const Pin& pin : pins)
    for (const int v : pin.vertices) {
      const BodyVertex at = in_body(model, v);
      const std::string prefix = model.bodies[at.body].name + ".";
      const bool is_of_scene = pin.name.starts_with(prefix);
      found[at.body][is_of_scene ? pin.name.substr(prefix.size()) : kByHand].push_back(at.vertex);
    }
  for (VerticesOfPin& body : found)
    for (auto& [name, vertices] : body) std::sort(vertices.begin(), vertices.end());
  return found;
}

Value where_vertices(const std::vector<int>& vertices) {
  Array list;
  for (const int v : vertices) list.push_back(of(v));
  Table where;
  where.set("vertices", {std::move(list), {}});
  return of(std::move(where));
}

// Pins of the scene keep their selection unless the brush changed it.
void set_pins(const VerticesOfPin& before, const VerticesOfPin& now, Table& body) {
  if (Value* pins = body.find("pin")) {
    Array kept;
    for (Value& pin : pins->array()) {
      const std::string& name = pin["name"].text();
      const auto left = now.find(name), was = before.find(name);
      if (left == now.end()) continue;
      if (was == before.end() || was->second != left->second) pin.table().set("where", where_vertices(left->second));
      kept.push_back(std::move(pin));
    }
    pins->array() = std::move(kept);
  }
  if (const auto by_hand = now.find(kByHand); by_hand != now.end()) {
    Table pin;
    pin.set("name", {std::string(kByHand), {}});
    pin.set("where", where_vertices(by_hand->second));
    append(body, "pin", std::move(pin));
  }
  if (const Value* pins = body.find("pin"); pins && pins->array().empty())
    std::erase_if(body.members, [](const Member& m) { return m.key == "pin"; });
}

void add_pins(const Side& side, Table& document, std::vector<std::string>& notes) {
  const Model& model = side.model();
  const auto scene = by_body(model, side.pins().of_scene());
  const auto start = by_body(model, *side.history().timeline().nearest(0).pins);
  Array& bodies = document.find("body")->array();
  for (size_t b = 0; b < bodies.size(); ++b)
    if (scene[b] != start[b]) set_pins(scene[b], start[b], bodies[b].table());
  if (start != by_body(model, *side.pins().now()))
    notes.emplace_back("pins that were changed after the first step are not saved; change them at the start");
}

// ---------------------------------------------------------------- files

std::vector<ZipEntry> zipped_inputs(const Scene& scene) {
  const TemporaryFolder folder;
  write_inputs(scene, folder.path());
  std::vector<ZipEntry> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    if (entry.is_regular_file())
      files.push_back({entry.path().lexically_relative(folder.path()).generic_string(), read_file(entry.path())});
  std::sort(files.begin(), files.end(), [](const ZipEntry& x, const ZipEntry& y) { return x.name < y.name; });
  return files;
}

std::string base64(const std::string& bytes) {
  std::string text;
  append_base64(bytes, text);
  return text;
}

}  // namespace

std::string saved_name(const Scene& scene) {
  std::string plain;
  for (const char c : scene.name)
    plain += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '_';
  return plain.empty() ? "scene" : plain.substr(0, 100);
}

SavedScene saved_scene(const Side& side, SavedHand hand) {
  const Scene& scene = side.steered().scene;
  SavedScene saved{.name = saved_name(scene), .files = {}, .notes = {}};
  Table document = side.steered().document;
  add_pins(side, document, saved.notes);
  if (hand == SavedHand::with_drags) add_drags(side, document);
  if (side.tool().resting(side.time())) saved.notes.emplace_back("the tool on the body is not saved");
  put_in_order(document);
  saved.files.push_back({saved.name + ".toml", "# Saved by the viewer, with all values. To run it: aspic run " +
                                                   saved.name + ".toml\n" + to_toml(document)});
  for (ZipEntry& file : zipped_inputs(scene)) saved.files.push_back(std::move(file));
  return saved;
}

Json file_reply(const std::string& name, const std::string& bytes) {
  if (bytes.size() > kMaxReplyBytes)
    throw InvalidInput(
        fmt::format("{}: {} MB; the page exports at most {} MB. Use aspic run, which writes files of any size", name,
                    bytes.size() / 1'000'000, kMaxReplyBytes / 1'000'000));
  return {{"name", name}, {"base64", base64(bytes)}};
}

Json scene_reply(const SavedScene& saved) {
  Json reply;
  if (saved.files.size() == 1) {
    reply = {{"name", saved.files[0].name}, {"text", saved.files[0].bytes}};
  } else {
    std::vector<ZipEntry> below = saved.files;
    for (ZipEntry& file : below) file.name = saved.name + "/" + file.name;
    reply = file_reply(saved.name + ".zip", zipped(below));
  }
  reply["notes"] = saved.notes;
  return reply;
}

Json scene_files_reply(const SavedScene& saved) {
  Json reply = {{"scene", saved.files[0].name}, {"files", Json::array()}, {"notes", saved.notes}};
  size_t total = 0;
  for (const ZipEntry& file : saved.files) {
    const std::string packed = gzipped(file.bytes);
    total += packed.size();
    if (total > kMaxReplyBytes) file_reply(saved.name, packed + std::string(total, ' '));
    reply["files"].push_back({{"name", file.name}, {"gzip", base64(packed)}});
  }
  return reply;
}

}  // namespace aspic::viewer

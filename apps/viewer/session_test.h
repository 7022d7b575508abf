// Scenes and a page for the tests of sessions.
#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "io/atomic_file.h"
#include "io/folder_test.h"
#include "viewer/arguments.h"
#include "viewer/session.h"

namespace aspic::viewer {

inline const std::string kBeam = R"(
gravity = [0, -9.81, 0]
[time]
step = 0.01
[[body]]
name = "beam"
shape = { box = { upper = [1, 0.2, 0.2], cells = [6, 2, 2] } }
material = { model = "neo_hookean", young = 1e5, poisson = 0.3, density = 1000 }
[[body.pin]]
name = "clamp"
where = "x < 1e-6"
)";

inline double number(const Json& json) { return json.get<double>(); }
inline std::vector<double> vec(const Json& json) { return json.get<std::vector<double>>(); }
inline double sum(const Json& list) {
  double total = 0;
  for (const Json& x : list) total += number(x);
  return total;
}

// Returns the last message of a kind.
inline Json last(const Messages& messages, const std::string& kind) {
  Json found;
  for (const Message& message : messages) {
    if (message.is_binary) continue;
    Json json = Json::parse(message.bytes);
    if (json["kind"] == kind) found = std::move(json);
  }
  return found;
}

struct Picture {
  int side = 0, generation = 0, step = 0, iteration = -1;
  double time = 0;
  std::vector<float> positions, values, contacts;
  std::vector<int8_t> normals;
  float min = 0, max = 0;
};

template <class T>
T take(const std::string& bytes, size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}
template <class T>
std::vector<T> take(const std::string& bytes, size_t at, size_t count) {
  std::vector<T> values(count);
  if (count > 0) std::memcpy(values.data(), bytes.data() + at, count * sizeof(T));
  return values;
}

// Decodes a picture like web/src/protocol.ts.
inline Picture decoded(const std::string& bytes) {
  EXPECT_EQ(take<uint32_t>(bytes, 0), 2u);
  Picture picture{.side = take<int>(bytes, 4), .generation = take<int>(bytes, 8), .step = take<int>(bytes, 16)};
  const size_t n = take<uint32_t>(bytes, 12);
  picture.iteration = take<int>(bytes, 20);
  picture.time = take<double>(bytes, 24);
  const bool has_values = take<uint32_t>(bytes, 32) == 1;
  picture.min = take<float>(bytes, 36);
  picture.max = take<float>(bytes, 40);
  const size_t end = 48 + n * (has_values ? 20 : 16), contacts = take<uint32_t>(bytes, 44);
  EXPECT_EQ(bytes.size(), end + 16 * contacts);
  picture.contacts = take<float>(bytes, end, 4 * contacts);
  picture.positions = take<float>(bytes, 48, 3 * n);
  picture.normals = take<int8_t>(bytes, 48 + 12 * n, 4 * n);
  if (has_values) picture.values = take<float>(bytes, 48 + 16 * n, n);
  return picture;
}

struct Geometry {
  int side = 0, generation = 0;
  std::vector<float> rest;
  std::vector<uint32_t> triangles, edges, tet, vertex;
};

inline Geometry decoded_geometry(const std::string& bytes) {
  EXPECT_EQ(take<uint32_t>(bytes, 0), 1u);
  Geometry geometry{.side = take<int>(bytes, 4), .generation = take<int>(bytes, 8)};
  const size_t n = take<uint32_t>(bytes, 12), m = take<uint32_t>(bytes, 16), e = take<uint32_t>(bytes, 20);
  EXPECT_EQ(bytes.size(), 32 + 4 * (3 * n + 3 * m + 2 * e + m + n));
  size_t at = 32;
  const auto words = [&](size_t count) {
    at += 4 * count;
    return take<uint32_t>(bytes, at - 4 * count, count);
  };
  geometry.rest = take<float>(bytes, at, 3 * n);
  at += 12 * n;
  geometry.triangles = words(3 * m);
  geometry.edges = words(2 * e);
  geometry.tet = words(m);
  geometry.vertex = words(n);
  return geometry;
}

// A steering page that stores its messages.
class Page {
 public:
  explicit Page(const std::string& toml = kBeam, const std::vector<std::string>& overrides = {},
                SessionOptions options = {})
      : session_(scene_file(toml), overrides, std::move(options)) {
    hear(session_.greeting(Role::steers));
  }

  Session& session() { return session_; }

  Json send(Json message) {  // the reply; a refusal is a failure
    const Json answer = ask(std::move(message));
    EXPECT_EQ(answer["kind"], "reply") << answer;
    return answer["reply"];
  }
  std::string refused(const Json& message) {  // returns the refusal
    const Json answer = ask(message);
    EXPECT_EQ(answer["kind"], "refused") << message << " was not refused";
    return answer.value("why", "");
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) send({{"do", "step"}});
  }
  void play_until_it_stops(int most = 1000) {
    for (int i = 0; i < most && session_.is_playing(); ++i) hear(session_.advance());
  }
  void advance() { hear(session_.advance()); }

  Json state() const { return state_; }
  Json heard(const std::string& kind) const { return heard_.at(kind); }  // the latest message
  Json obstacles() const { return obstacles_; }                          // the latest message
  Json side(const std::string& name = "a") const { return state_.at(name); }
  Json scene(const std::string& name = "a") const { return scene_.at(name); }
  const std::vector<Json>& rows(const std::string& name = "a") { return rows_[name]; }
  Json pins(const std::string& name = "a") const { return pins_.at(name); }
  const Geometry& geometry(const std::string& name = "a") { return geometry_[name]; }
  Picture picture(int side = 0) { return decoded(session_.pictures().at(side).bytes); }

  // Returns a triangle at the free end.
  int end_triangle() {
    const Geometry& g = geometry();
    for (size_t t = 0; t < g.triangles.size() / 3; ++t) {
      bool at_end = true;
      for (int c = 0; c < 3; ++c) at_end = at_end && g.rest[3 * g.triangles[3 * t + c]] > 0.999F;
      if (at_end) return static_cast<int>(t);
    }
    return -1;
  }
  Json grab_end(const std::vector<double>& target) {
    return send({{"do", "grab"},
                 {"side", "a"},
                 {"triangle", end_triangle()},
                 {"weights", {0.25, 0.25, 0.5}},
                 {"target", target}});
  }

  static std::string scene_file(const std::string& toml) {
    static const TestFolder folder;
    static int count = 0;
    const auto path = folder.path() / ("scene" + std::to_string(++count) + ".toml");
    write_file(path, toml);
    return path.string();
  }

 private:
  Json ask(Json message) {
    message["id"] = ++id_;
    const Answer answer = session_.handle(message.dump(), Role::steers);
    hear(answer.to_all);
    EXPECT_EQ(answer.to_sender.size(), 1u);
    Json json = Json::parse(answer.to_sender.at(0).bytes);
    EXPECT_EQ(json["id"], id_);
    return json;
  }

  void hear(const Messages& messages) {
    for (const Message& message : messages) {
      if (message.is_binary) {
        Geometry g = decoded_geometry(message.bytes);
        geometry_[g.side == 0 ? "a" : "b"] = std::move(g);
        continue;
      }
      const Json json = Json::parse(message.bytes);
      const std::string kind = json["kind"], side = json.value("side", "");
      if (kind == "state") state_ = json;
      heard_[kind] = json;
      if (kind == "scene") scene_[side] = json;
      if (kind == "obstacles") obstacles_ = json;
      if (kind == "pins") pins_[side] = json["vertices"];
      if (kind != "steps") continue;
      auto& rows = rows_[side];
      rows.resize(std::min(rows.size(), json["from"].get<size_t>()));
      for (const Json& row : json["steps"]) rows.push_back(row);
    }
  }

  Session session_;
  int id_ = 0;
  Json state_, heard_ = Json::object(), obstacles_, scene_ = Json::object(), pins_ = Json::object();
  std::map<std::string, std::vector<Json>> rows_;
  std::map<std::string, Geometry> geometry_;
};

}  // namespace aspic::viewer

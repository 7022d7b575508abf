#include "scene/scene_document.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "material/registry.h"
#include "scene/overrides.h"
#include "scene/scene_attachments.h"
#include "scene/schema.h"
#include "scene/toml_reader.h"
#include "scene/value.h"

namespace aspic {
namespace {

constexpr size_t kMaxBodies = 10000;
constexpr double kWeightRoundOff = 1e-9;  // tolerance of weights that sum to 1

void put_first(Table& table, const std::string& key, Value value) {
  table.members.insert(table.members.begin(), Member{key, value.place, std::move(value)});
}

// Names become parts of file names and of --set paths.
void check_name(const std::string& name, const Place& place) {
  const bool good = !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (!good)
    throw error_at(place, "name = " + shortened(toml_string(name)) +
                              "; a name has at most 64 letters, digits, _ and - (try \"body1\")");
}

// Names each table that has no name by `name_of`, and refuses duplicates.
template <class NameOf>
void name_tables(Array& tables, const NameOf& name_of) {
  std::map<std::string, Place> taken;
  for (size_t i = 0; i < tables.size(); ++i) {
    Table& table = tables[i].table();
    if (!table.find("name")) put_first(table, "name", {name_of(table, i), tables[i].place});
    const Value& name = *table.find("name");
    check_name(name.text(), name.place);
    const auto [earlier, is_new] = taken.emplace(name.text(), name.place);
    if (!is_new)
      throw error_at(name.place, "name = " + toml_string(name.text()) + " is taken by " + to_string(earlier->second) +
                                     "; choose another");
  }
}

// Rejects keys beside a fitted material, of which only the density may be replaced.
void check_beside_file(const Value& material) {
  const std::string file = toml_string(material["file"].text());
  for (const Member& m : material.table().members) {
    if (m.key == "model" || m.key == "density" || m.key == "file" || m.key == "frame" || m.key == "hash") continue;
    throw error_at(m.place, m.key + " = " + shortened(inline_toml(m.value)) + "; file = " + file +
                                " already has the elastic constants of every tet (remove " + m.key +
                                "; only density may be given beside a file)");
  }
}

void check_fibres(const Value& material) {
  const Value* ratio = material.find("fibre_ratio");
  if (ratio && !material.find("fibre_x") && !material.find("fibre_y") && !material.find("fibre_z"))
    throw error_at(ratio->place, "fibre_ratio = " + shortened(inline_toml(*ratio)) +
                                     "; these fibres have no direction (add fibre_x, fibre_y, fibre_z)");
}

void complete_material(Value& material) {
  if (material.find("file")) return check_beside_file(material);
  const MaterialInfo& info = material_info(material["model"].text());
  const std::vector<std::string> plain = {"model", "density", "young", "poisson", "lambda", "mu", "shear", "bulk"};
  std::vector<std::string> accepted = plain;
  check_fibres(material);
  for (const ExtraParameter& extra : info.extra) {
    accepted.push_back(extra.name);
    if (!material.find(extra.name)) material.table().set(extra.name, {extra.fallback, material.place});
  }
  for (const Member& m : material.table().members)
    if (std::find(accepted.begin(), accepted.end(), m.key) == accepted.end())
      throw error_at(m.place, m.key + " = " + shortened(inline_toml(m.value)) + "; the material " + info.name +
                                  " has no such parameter" + suggestion(m.key, accepted));
  const Value *lambda = material.find("lambda"), *mu = material.find("mu");
  if (lambda && lambda->is_number() && mu->is_number() && !(lambda->number() > -2.0 / 3 * mu->number()))
    throw error_at(lambda->place, "lambda = " + number_text(lambda->number()) +
                                      "; must be > -2/3 mu = " + number_text(-2.0 / 3 * mu->number()));
}

void check_axis(const Value& table, const std::string& key = "axis") {
  const Value* axis = table.find(key);
  if (!axis) return;
  const Vec3d a = axis->vector();
  if (dot(a, a) == 0) throw error_at(axis->place, key + " = [0, 0, 0]; a direction is needed (try [0, 0, 1])");
}

void check_times(const Array& places) {
  double last = -1;
  for (const Value& place : places) {
    const Value& time = place["time"];
    if (time.number() <= last)
      throw error_at(time.place, "time = " + number_text(time.number()) + "; must be later than the previous one, " +
                                     number_text(last));
    last = time.number();
  }
}

void check_keyframes(const Value& keyframes, const std::string& key) {
  check_times(keyframes.array());
  if (keyframes.array().empty()) throw error_at(keyframes.place, key + " = []; at least one is needed");
}

void check_motion(const Value& holder) {
  const Value* motion = holder.find("motion");
  if (!motion || !motion->is_table()) return;
  if (const Value* spin = motion->find("rotate")) check_axis(*spin);
  if (const Value* keyframes = motion->find("keyframes")) check_keyframes(*keyframes, "keyframes");
  if (const Value* recording = motion->find("recording"); recording && !recording->find("mesh"))
    throw error_at(recording->place, "recording needs `mesh`, the recorded surface at rest");
}

void check_springs(const Value& springs, const Array& bodies) {
  std::vector<std::string> names;
  for (const Value& body : bodies) names.push_back(body["name"].text());
  for (const Value& spring : springs.array()) {
    check_motion(spring);
    if (const Value* edges = spring.find("edges"); edges && !edges->boolean())
      throw error_at(edges->place, "edges = false; omit the spring, or write edges = true");
    const Value* other = spring.find("to_body");
    if (other && std::find(names.begin(), names.end(), other->text()) == names.end())
      throw error_at(other->place, "to_body = " + toml_string(other->text()) + "; there is no such body" +
                                       suggestion(other->text(), names));
  }
}

void check_grabs(const Value& grabs) {
  for (const Value& grab : grabs.array()) {
    const Array &path = grab["path"].array(), &point = grab["point"].array();
    check_times(path);
    if (path.size() < 2)
      throw error_at(grab["path"].place, "path: " + std::to_string(path.size()) +
                                             " positions; at least two are needed, the start and the end");
    if (point.size() != 4)
      throw error_at(grab["point"].place, "point: " + std::to_string(point.size()) +
                                              " vertices; the four of one tet are needed (weight = 0 for one without "
                                              "influence)");
    double sum = 0;
    for (const Value& share : point) sum += share["weight"].number();
    if (!(std::abs(sum - 1) <= kWeightRoundOff))
      throw error_at(grab["point"].place, "point: the weights sum to " + number_text(sum) + "; they must sum to 1");
  }
}

void check_box(const Value& shape) {
  const Value* box = shape.find("box");
  if (!box) return;
  const Vec3d lower = (*box)["lower"].vector(), upper = (*box)["upper"].vector();
  for (int i = 0; i < 3; ++i)
    if (!(upper[i] > lower[i]))
      throw error_at((*box)["upper"].place,
                     "upper = " + inline_toml((*box)["upper"]) +
                         "; each number must be above that of lower = " + inline_toml((*box)["lower"]));
  if (const Value* cells = box->find("cells"); cells && cells->array().size() != 3)
    throw error_at(cells->place, "cells = " + shortened(inline_toml(*cells)) + "; three numbers are needed");
}

void check_obstacle(const Value& obstacle) {
  check_motion(obstacle);
  if (const Value* rotate = obstacle.find("rotate")) check_axis(*rotate);
  if (const Value* shape = obstacle.find("shape")) check_box(*shape);
  const Value* recording = obstacle.find("recording");
  if (recording && !obstacle.find("mesh"))
    throw error_at(recording->place, "recording needs `mesh`, whose vertices it moves");
  if (recording && !obstacle["motion"].is_text())
    throw error_at(recording->place, "motion and recording exclude each other");
  if (const Value* mesh = recording ? recording->find("mesh") : nullptr)
    throw error_at(mesh->place, "the recording of an obstacle moves its own `mesh`; remove this one");
  if (const Value& motion = obstacle["motion"]; motion.is_table() && motion.find("recording"))
    throw error_at(motion.place, "an obstacle follows its own `recording` beside `mesh`; move it out of `motion`");
}

// Names bodies and pins, fills in the extra parameters of materials, and checks conditions between keys. Requires a
// document that passed check_and_complete(). Throws InvalidInput.
void complete_scene(Table& document) {
  Value& list = *document.find("body");
  Array& bodies = list.array();
  if (bodies.empty()) throw error_at(list.place, "body = []; at least one is needed");
  if (bodies.size() > kMaxBodies)
    throw error_at(list.place, std::to_string(bodies.size()) + " bodies; at most " + std::to_string(kMaxBodies) +
                                   " are supported (combine similar bodies in one mesh)");
  name_tables(bodies, body_name);
  pin_to_obstacles(document);
  for (Value& body : bodies) {
    complete_material(*body.table().find("material"));
    if (const Value* muscles = body.find("muscle"))
      for (const Value& muscle : muscles->array())
        if (muscle["activation"].is_array()) check_keyframes(muscle["activation"], "activation");
    if (Value* pins = body.table().find("pin")) {
      name_tables(pins->array(), [](const Table&, size_t i) { return "pin" + std::to_string(i + 1); });
      for (const Value& pin : pins->array()) {
        check_motion(pin);
        check_axis(pin, "direction");
      }
    }
    if (const Value* springs = body.find("spring")) check_springs(*springs, bodies);
    if (const Value* grabs = body.find("grab")) check_grabs(*grabs);
    if (const Value* rotate = body.find("rotate")) check_axis(*rotate);
    if (const Value* shape = body.find("shape")) check_box(*shape);
    const Value* deform = body.find("deform");
    if (const Value* twist = deform ? deform->find("twist") : nullptr) check_axis(*twist);
  }
  if (const Value* obstacles = document.find("obstacle"))
    for (const Value& obstacle : obstacles->array()) check_obstacle(obstacle);
}

}  // namespace

Table read_scene_document(const std::string& text, const std::string& source,
                          const std::vector<std::string>& overrides) {
  Table document = read_toml(text, source);
  for (const std::string& override_text : overrides) apply_override(document, override_text);
  complete_scene_document(document, source);
  return document;
}

void complete_scene_document(Table& document, const std::string& source) {
  check_and_complete(document, source);
  complete_scene(document);
}

}  // namespace aspic

#include "viewer/session_messages.h"

#include <algorithm>

#include "base/printable.h"
#include "viewer/fibre_lines.h"
#include "viewer/picture.h"
#include "viewer/scene_json.h"

namespace aspic::viewer {
namespace {

Json grab_json(const Side& side) {
  const Hand& hand = side.hand();
  if (!hand.is_grabbing()) return nullptr;
  return {{"point", json_of(hand.point(side.positions()))},
          {"target", json_of(hand.wanted())},
          {"force", json_of(hand.force(side.positions()))}};
}

}  // namespace

bool ShownSide::has_field(const std::string& field) const {
  const std::vector<Field> all = fields();
  return std::any_of(all.begin(), all.end(), [&](const Field& f) { return f.name == field; });
}

Message text(const Json& json) { return {false, json.dump(-1, ' ', false, Json::error_handler_t::replace)}; }

Message hello(const std::vector<Lesson>& lessons, Role role) {
  Json list = Json::array();
  for (const Lesson& lesson : lessons) {
    Json json = {{"id", lesson.id},       {"pages", lesson.pages},       {"title", lesson.title},
                 {"claim", lesson.claim}, {"exercise", lesson.exercise}, {"panel", lesson.panel}};
    if (!lesson.question.empty()) json["question"] = lesson.question, json["answer"] = lesson.answer;
    if (lesson.is_log) json["log"] = true;
    if (!lesson.function.empty()) json["function"] = Json::parse(lesson.function, nullptr, false);
    if (!lesson.missing.empty()) json["missing"] = lesson.missing;
    list.push_back(std::move(json));
  }
  return text({{"kind", "hello"},
               {"protocol", 1},
               {"version", ASPIC_VERSION},
               {"steers", role == Role::steers},
               {"live", true},
               {"lessons", std::move(list)}});
}

Message scene_message(const ShownSide& shown, const std::string& field) {
  const SteeredScene& steered = shown.side.steered();
  const Simulation& simulation = steered.scene.simulation;
  const Box start = box_of(std::span<const double>(shown.side.history().start().q));
  Json message = scene_json(steered.scene, steered.document, start, shown.fields());
  message.update({{"side", shown.name},
                  {"generation", shown.generation},
                  {"name", steered.scene.name},
                  {"label", shown.label},
                  {"path", steered.path.string()},
                  {"overrides", steered.overrides},
                  {"loaded_overrides", shown.loaded_overrides},
                  {"notes", steered.scene.notes},
                  {"surface", shown.surface.is_fine ? "skin" : "cage"},
                  {"solver", simulation.integrator().is_implicit ? simulation.solver_description() : ""},
                  {"potentials", simulation.potential_names()},
                  {"field", field},
                  {"stiffness", shown.side.hand().stiffness()}});
  return text(message);
}

Message geometry_message(const ShownSide& shown) {
  return {true, encode_geometry({shown.number(), shown.generation}, shown.surface, shown.side.model().numbering)};
}

Message obstacles_message(const ShownSide& shown) {
  return text({{"kind", "obstacles"},
               {"side", shown.name},
               {"generation", shown.generation},
               {"obstacles", obstacles_json(shown.side.model(), shown.side.simulation().obstacle_time())}});
}

Message steps_message(const ShownSide& shown, int from) {
  return text(
      {{"kind", "steps"}, {"side", shown.name}, {"from", from}, {"steps", shown.side.history().rows().after(from)}});
}

Message pins_message(const ShownSide& shown) {
  Json vertices = Json::array();
  for (int v = 0; v < shown.surface.vertex_count(); ++v)
    if (shown.side.pins().has(shown.surface.anchor(v))) vertices.push_back(v);
  return text({{"kind", "pins"}, {"side", shown.name}, {"vertices", std::move(vertices)}});
}

Message fibres_message(const ShownSide& shown) {
  return text({{"kind", "fibres"},
               {"side", shown.name},
               {"generation", shown.generation},
               {"lines", fibre_lines(shown.side.model(), shown.surface)}});
}

Json state_of(const ShownSide& shown) {
  const Side& side = shown.side;
  const StepRow* last = side.history().rows().last();
  Json state = {{"tool", side.tool().state(side.positions())},
                {"step", side.steps_taken()},
                {"time", side.time()},
                {"iteration", side.iteration()},
                {"timeline", {{"first", 0}, {"last", side.steps_taken()}}},
                {"status", last ? std::string(to_string(last->report.status)) : ""},
                {"words", last ? to_json(last->why) : Json()},
                {"grab", grab_json(side)}};
  if (side.iteration() >= 0)
    for (const IterationRow& row : side.iterations()) state["iterations"].push_back(to_json(row));
  return state;
}

Message refusal(const Json& id, const std::string& why, bool is_interrupted) {
  Json json = {{"kind", "refused"}, {"id", id}, {"why", printable_lines(why)}};
  if (is_interrupted) json["interrupted"] = true;
  return text(json);
}

}  // namespace aspic::viewer

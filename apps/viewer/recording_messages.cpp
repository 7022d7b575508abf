#include "viewer/recording_messages.h"

#include "scene/scene_document.h"
#include "viewer/scene_json.h"
#include "viewer/settings.h"

namespace aspic::viewer {
namespace {

Table document_of(const Scene& scene) { return read_scene_document(scene.resolved, "scene.toml"); }

// Names the scene after its bodies. The recording does not depend on the name of the directory.
std::string name_of(const Scene& scene) {
  std::string name;
  for (const BodyRange& body : scene.simulation.model().bodies) name += (name.empty() ? "" : ", ") + body.name;
  return shortened(name);
}

// The solver that the scene requests. The summary of the run names the choice of `auto`.
std::string solver_words(const Table& document) {
  const Value& solver = *document.find("solver");
  return solver["method"].text() + ", " + solver["linear"].text() + " for the linear systems";
}

}  // namespace

Json hello_message(const RecordedScene& recorded) {
  const Table document = document_of(recorded.scene);
  const Value* version = document.find("version");
  return {{"kind", "hello"}, {"protocol", 1}, {"version", version ? version->text() : ""},
          {"steers", true},  {"live", false}, {"lessons", Json::array()}};
}

Json scene_messages(const RecordedScene& recorded) {
  const Scene& scene = recorded.scene;
  const Model& model = scene.simulation.model();
  const Table document = document_of(scene);
  Json message = {{"kind", "scene"},
                  {"side", "a"},
                  {"name", name_of(scene)},
                  {"label", ""},
                  {"path", ""},
                  {"overrides", Json::array()},
                  {"loaded_overrides", Json::array()},
                  {"notes", Json::array()},
                  {"has_skin", has_fine_skin(scene)},
                  {"vertices", model.mesh.vertex_count()},
                  {"tets", model.mesh.tet_count()},
                  {"bodies", Json::array()},
                  {"body_tets", Json::array()},
                  {"lower", json_of(recorded.lower)},
                  {"upper", json_of(recorded.upper)},
                  {"up", json_of(up_of(document))},
                  {"h", scene.simulation.options().h},
                  {"implicit", scene.simulation.integrator().is_implicit},
                  {"solver", scene.simulation.integrator().is_implicit ? solver_words(document) : ""},
                  {"potentials", recorded.tables.potentials},
                  {"fields", fields_json(recorded.fields)},
                  {"field", ""},
                  {"settings", settings_json(document)},
                  {"stiffness", 0}};
  if (!recorded.note.empty()) message["notes"].push_back(recorded.note);
  for (const BodyRange& body : model.bodies) {
    message["bodies"].push_back(body.name);
    message["body_tets"].push_back(body.first_tet);
  }
  Json messages = Json::array();
  for (size_t i = 0; i < recorded.body.surfaces.size(); ++i) {
    message["generation"] = i + 1;
    message["surface"] = recorded.body.surfaces[i].name;
    messages.push_back(message);
  }
  return messages;
}

}  // namespace aspic::viewer

#include "viewer/scene_json.h"

#include "viewer/settings.h"

namespace aspic::viewer {

Json json_of(const Vec3d& x) { return {x[0], x[1], x[2]}; }

Json tip_json(const Tip& tip) {
  return {{"shape", tip.shape == TipShape::disc ? "disc" : "sphere"},
          {"contact", tip.contact == TipContact::sliding ? "sliding" : "bonded"},
          {"radius", tip.radius},
          {"stiffness", tip.stiffness}};
}

namespace {

Json fields_json(const std::vector<Field>& fields) {
  Json list = Json::array();
  for (const Field& field : fields)
    list.push_back({{"name", field.name},
                    {"label", field.label},
                    {"unit", field.unit},
                    {"diverging", field.is_diverging},
                    {"center", field.center},
                    {"log", field.is_log}});
  return list;
}

// Opposite to gravity; the y axis without gravity.
Vec3d up_of(const Table& document) {
  const Vec3d gravity = document.find("gravity")->vector();
  const double size = norm(gravity);
  return size > 0 ? (-1 / size) * gravity : Vec3d{{0, 1, 0}};
}

}  // namespace

Json scene_json(const Scene& scene, const Table& document, const Box& start, const std::vector<Field>& fields) {
  const Simulation& simulation = scene.simulation;
  const Model& model = simulation.model();
  Json message = {{"kind", "scene"},
                  {"has_skin", has_fine_skin(scene)},
                  {"vertices", model.mesh.vertex_count()},
                  {"tets", model.mesh.tet_count()},
                  {"bodies", Json::array()},
                  {"body_tets", Json::array()},
                  {"lower", json_of(start.lower)},
                  {"upper", json_of(start.upper)},
                  {"up", json_of(up_of(document))},
                  {"h", simulation.options().h},
                  {"implicit", simulation.integrator().is_implicit},
                  {"fields", fields_json(fields)},
                  {"settings", settings_json(document)}};
  for (const BodyRange& body : model.bodies) {
    message["bodies"].push_back(body.name);
    message["body_tets"].push_back(body.first_tet);
  }
  return message;
}

}  // namespace aspic::viewer

#include "viewer/scene_json.h"

#include "contact/barrier.h"
#include "contact/obstacle_surface.h"
#include "viewer/settings.h"

namespace aspic::viewer {

Json json_of(const Vec3d& x) { return {x[0], x[1], x[2]}; }

namespace {

// The box of the bodies and the obstacles below them, unless these are so large that the bodies would be tiny.
Box with_obstacles(const Box& bodies, const Model& model) {
  constexpr double kLargest = 4;  // relative to the bodies
  Box all = bodies;
  if (!model.contact) return all;
  const double limit = kLargest * norm(bodies.upper - bodies.lower);
  for (const ObstacleSurface& obstacle : obstacle_surfaces(model.contact->mesh(), model.contact->obstacle_points(0))) {
    Box both = all;
    if (obstacle.plane) {
      const Vec3d center = 0.5 * (bodies.lower + bodies.upper);
      both.add(center - dot(obstacle.plane->normal, center - obstacle.plane->origin) * obstacle.plane->normal);
    } else {
      for (const Vec3d& x : obstacle.surface.vertices) both.add(x);
    }
    if (norm(both.upper - both.lower) <= limit) all = both;
  }
  return all;
}

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

Json obstacles_json(const Model& model, double time) {
  Json list = Json::array();
  if (!model.contact) return list;
  for (const ObstacleSurface& obstacle :
       obstacle_surfaces(model.contact->mesh(), model.contact->obstacle_points(time))) {
    Json plane, points = Json::array(), triangles = Json::array();
    if (obstacle.plane)
      plane = {{"origin", json_of(obstacle.plane->origin)}, {"normal", json_of(obstacle.plane->normal)}};
    for (const Vec3d& x : obstacle.surface.vertices)
      for (int axis = 0; axis < 3; ++axis) points.push_back(x[axis]);
    for (const Triangle& t : obstacle.surface.triangles)
      for (const int v : t) triangles.push_back(v);
    list.push_back({{"name", obstacle.name}, {"plane", plane}, {"points", points}, {"triangles", triangles}});
  }
  return list;
}

Json scene_json(const Scene& scene, const Table& document, const Box& start, const std::vector<Field>& fields) {
  const Simulation& simulation = scene.simulation;
  const Model& model = simulation.model();
  const Box seen = with_obstacles(start, model);
  Json message = {{"kind", "scene"},
                  {"has_skin", has_fine_skin(scene)},
                  {"vertices", model.mesh.vertex_count()},
                  {"tets", model.mesh.tet_count()},
                  {"triangles", model.mesh.sheet.size()},
                  {"bodies", Json::array()},
                  {"body_tets", Json::array()},
                  {"thickness", Json::array()},
                  {"lower", json_of(seen.lower)},
                  {"upper", json_of(seen.upper)},
                  {"up", json_of(up_of(document))},
                  {"h", simulation.options().h},
                  {"implicit", simulation.integrator().is_implicit},
                  {"fields", fields_json(fields)},
                  {"settings", settings_json(document)}};
  for (const BodyRange& body : model.bodies) {
    message["bodies"].push_back(body.name);
    message["body_tets"].push_back(body.first_element(model.mesh));
    message["thickness"].push_back(body.is_sheet() ? model.mesh.thickness[body.first_triangle] : 0.0);
  }
  return message;
}

}  // namespace aspic::viewer

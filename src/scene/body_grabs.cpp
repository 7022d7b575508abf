#include "scene/body_grabs.h"

#include <algorithm>
#include <memory>

#include "energy/grab_paths.h"
#include "mesh/tet_nodes.h"
#include "mesh/topology.h"

namespace aspic {
namespace {

bool belong_to_one_tet(const TetMesh& mesh, const Tet& vertices) {
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const TetNodes nodes = nodes_of(mesh, t);
    const auto has = [&](int v) { return std::find(nodes.begin(), nodes.end(), v) != nodes.end(); };
    if (std::all_of(vertices.begin(), vertices.end(), has)) return true;
  }
  return false;
}

// Returns the four vertices in the numbering of the body. Throws InvalidInput unless they belong to one tet.
Tet corners_of(const Value& point, const PlacedBody& body) {
  Tet corners{};
  for (int i = 0; i < 4; ++i) {
    const Value& vertex = point.array()[i]["vertex"];
    const std::int64_t index = std::get<std::int64_t>(vertex.data);
    if (index >= body.mesh.vertex_count())
      throw error_at(vertex.place, "vertex = " + std::to_string(index) + " is beyond the last vertex of body '" +
                                       body.name() + "', " + std::to_string(body.mesh.vertex_count() - 1));
    corners[i] = static_cast<int>(index);
  }
  if (lists_vertex_twice(corners) || !belong_to_one_tet(body.mesh, corners))
    throw error_at(point.place, "point: no tet of body '" + body.name() + "' has the vertices " +
                                    std::to_string(corners[0]) + ", " + std::to_string(corners[1]) + ", " +
                                    std::to_string(corners[2]) + ", " + std::to_string(corners[3]) +
                                    "; a spring can hold a point of only one tet");
  return corners;
}

GrabPath grab_path(const Value& scene, const PlacedBody& body) {
  GrabPath made;
  const Value& point = scene["point"];
  const Tet corners = corners_of(point, body);
  for (int i = 0; i < 4; ++i) {
    made.grab.vertices[i] = body.model_vertex(corners[i]);
    made.grab.weights[i] = point.array()[i]["weight"].number();
  }
  made.grab.stiffness = scene["stiffness"].number();
  for (const Value& place : scene["path"].array())
    made.path.push_back({place["time"].number(), place["position"].vector()});
  return made;
}

}  // namespace

void add_grabs(const std::vector<PlacedBody>& bodies, Model& model) {
  std::vector<GrabPath> paths;
  for (const PlacedBody& body : bodies)
    if (const Value* list = body.scene.find("grab"))
      for (const Value& scene : list->array()) paths.push_back(grab_path(scene, body));
  if (!paths.empty()) model.loads.push_back(std::make_unique<GrabPaths>(std::move(paths)));
}

}  // namespace aspic

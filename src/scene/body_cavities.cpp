#include "scene/body_cavities.h"

#include <algorithm>

#include "base/error.h"
#include "base/formatted.h"
#include "dynamics/state.h"
#include "energy/cavity.h"
#include "energy/pressure_rim.h"
#include "mesh/box.h"
#include "mesh/components.h"
#include "mesh/surface.h"
#include "mesh/surface_orientation.h"
#include "mesh/topology.h"
#include "scene/placement.h"

namespace aspic {
namespace {

constexpr double kStiffLiquid = 1000;  // bulk modulus of a liquid over the stiffness of the body

std::vector<std::vector<Face>> components_of(const TetMesh& mesh, const std::vector<Face>& faces) {
  TriMesh surface{mesh.rest, {}};
  for (const Face& face : faces) surface.triangles.push_back(face.corners);
  std::vector<std::vector<Face>> components;
  for (const std::vector<int>& list : triangle_components(surface)) {
    std::vector<Face>& component = components.emplace_back();
    for (const int f : list) component.push_back(faces[f]);
  }
  return components;
}

// The only inner surface of a body.
std::vector<Face> inner_surface(const PlacedBody& body, const Value& scene, const std::vector<Face>& boundary) {
  std::vector<std::vector<Face>> inner = components_of(body.mesh, boundary);
  std::erase_if(inner, [&](const std::vector<Face>& patch) { return !(cavity_volume(body.mesh, patch) > 0); });
  if (inner.size() == 1) return inner[0];
  throw error_at(scene.place, "body '" + body.name() + "' has " + std::to_string(inner.size()) + " inner surfaces" +
                                  (inner.empty() ? "; a cavity needs one that no opening connects with the outside"
                                                 : "; select the faces of one by where"));
}

// Throws InvalidInput for edges of one or of more than two triangles.
void require_closed(const PlacedBody& body, const Value& scene, const TriMesh& surface) {
  for_each_edge(edge_uses(surface.triangles), [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first == 2) return;
    const auto [a, b] = first->edge;
    const bool is_open = last - first == 1;
    throw error_at(scene.place, "cavity: body '" + body.name() + "' is " + (is_open ? "open" : "branched") +
                                    " at its edge from vertex " + std::to_string(body.user_vertex(a)) + " at " +
                                    point_text(surface.vertices[a]) + " to vertex " +
                                    std::to_string(body.user_vertex(b)) + " at " + point_text(surface.vertices[b]) +
                                    "; a cavity needs a closed surface (" +
                                    (is_open ? "close it; aspic check MESH --repair merges coincident vertices"
                                             : "select its triangles by where") +
                                    ")");
  });
}

// Faces of the closed surface of a sheet, which point inward.
std::vector<Face> patch_of_sheet(const PlacedBody& body, Value& scene, const Vec3d& up) {
  TriMesh surface{body.start, body.mesh.sheet};
  if (Value* where = scene.table().find("where")) {
    surface.triangles.clear();
    for (const Face& face : select_faces(*where, selection_scope(body, *where, up), linear_faces(body.mesh.sheet)))
      surface.triangles.push_back(face.corners);
  }
  require_closed(body, scene, surface);
  if (const size_t parts = triangle_components(surface).size(); parts > 1)
    throw error_at(scene.place, "cavity: body '" + body.name() + "' has " + std::to_string(parts) +
                                    " closed surfaces; select the faces of one by where");
  orient(surface);  // outward
  for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
  return linear_faces(surface.triangles);
}

// Closed, in the body's numbering.
std::vector<Face> patch_of(const PlacedBody& body, Value& scene, const Vec3d& up) {
  if (!body.mesh.sheet.empty()) return patch_of_sheet(body, scene, up);
  const std::vector<Face> boundary = boundary_faces(body.mesh, 0, body.mesh.tet_count());
  Value* where = scene.table().find("where");
  if (!where) return inner_surface(body, scene, boundary);
  std::vector<Face> patch = select_faces(*where, selection_scope(body, *where, up), boundary);
  if (const size_t rim = rim_of(patch).size(); rim > 0)
    throw error_at(where->place, "the selected faces are open, with " + std::to_string(rim) +
                                     " edges at their rim; select all faces of an inner surface, or leave out where");
  if (!(cavity_volume(body.mesh, patch) > 0))
    throw error_at(where->place, "the selected faces enclose the body, not a cavity; select an inner surface");
  return patch;
}

// Returns the largest Young's modulus of a solid; that of a sheet times its thickness over its extent.
double stiffness_of(const PlacedBody& body, const BodyRange& range, const Model& model) {
  const auto first = model.tet_fields[0].second.begin() + range.first_element(model.mesh);
  const double largest = *std::max_element(first, first + range.element_count());
  if (body.mesh.sheet.empty()) return largest;
  return largest * body.mesh.thickness[0] / longest_side(bounding_box(body.mesh.rest));
}

CavityContent content_of(Value& scene, double stiffness) {
  const Value* liquid = scene.find("liquid");
  const Value& amount = liquid ? *liquid : scene["gas"];
  const auto of_time = function_of_time(amount, "the content of a cavity is uniform, so its formula may use only t");
  const auto positive = [of_time, place = amount.place](double time) {
    const double a = of_time(time);
    if (!(a >= 0))
      throw error_at(place, number_text(a) + " at t = " + number_text(time) + " s is negative; 1 is the start");
    return a;
  };
  positive(0);
  CavityContent content{liquid ? CavityContent::liquid : CavityContent::gas, 0, positive};
  if (!liquid)
    content.modulus = scene["pressure"].number();
  else if (const Value* bulk = scene.find("bulk_modulus"))
    content.modulus = bulk->number();
  else
    content.modulus = kStiffLiquid * stiffness;
  if (const Value* volume = scene.find("volume")) content.volume = volume->number();
  if (!(content.modulus > 0)) throw error_at(scene.place, "a liquid in a body without stiffness needs a bulk_modulus");
  return content;
}

}  // namespace

void add_cavities(std::vector<PlacedBody>& bodies, const Vec3d& up, std::vector<std::string>& notes, Model& model) {
  std::vector<double> start = at_rest(model.mesh).q;
  for (const PlacedBody& body : bodies)
    for (size_t v = 0; v < body.start.size(); ++v)
      for (int r = 0; r < 3; ++r) start[3 * body.model_vertex(static_cast<int>(v)) + r] = body.start[v][r];
  int number = 0;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const PlacedBody& body = bodies[b];
    Value* list = body.scene.table().find("cavity");
    if (!list) continue;
    for (Value& scene : list->array()) {
      std::vector<Face> patch = patch_of(body, scene, up);
      for (Face& face : patch) {
        for (int& v : face.corners) v = body.model_vertex(v);
        for (int& v : face.mids) v = v < 0 ? v : body.model_vertex(v);
      }
      const std::string name = ++number == 1 ? "cavity" : "cavity_" + std::to_string(number);
      auto cavity =
          make_cavity(name, model.mesh, patch, content_of(scene, stiffness_of(body, model.bodies[b], model)), start);
      const CavityState at_start = cavity->state(start, 0);
      notes.push_back(name + " of body '" + body.name() + "': " + three_digits(1e6 * at_start.volume) +
                      " ml at the start, with " + three_digits(at_start.pressure) + " Pa");
      model.loads.push_back(std::move(cavity));
    }
  }
}

}  // namespace aspic

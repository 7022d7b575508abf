#include "scene/body_rod.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.h"
#include "base/formatted.h"
#include "io/mesh_file.h"
#include "mesh/box.h"
#include "mesh/rod_shapes.h"
#include "scene/placement.h"
#include "scene/thin_body.h"

namespace aspic {
namespace {

constexpr double kFolded = 1e-12;  // 1 + cosine of the turn at a vertex, below which bending overflows
constexpr double kThickRod = 0.1;  // radius relative to the length, above which a body is no rod

TetMesh rod_from_shape(const Value& shape, const MeshLoader& loader) {
  const auto number = [](const Value& table, const char* key) { return table[key].number(); };
  const auto check_count = [&](double segments, const Value& place) {
    if (const std::string why = loader.why_not(segments); !why.empty())
      throw error_at(place.place, why + " (choose a larger size)");
  };
  if (const Value* s = shape.find("line")) {
    const Vec3d from = (*s)["from"].vector(), to = (*s)["to"].vector();
    if (!(norm(to - from) > 0)) throw error_at((*s)["to"].place, "to = from; the line has no length");
    check_count(segments_in_line(norm(to - from), number(*s, "size")), *s);
    return make_line(from, to, number(*s, "size"));
  }
  if (const Value* s = shape.find("ring")) {
    check_count(segments_in_ring(number(*s, "radius"), number(*s, "size")), *s);
    return make_ring(number(*s, "radius"), number(*s, "size"));
  }
  if (const Value* s = shape.find("coil")) {
    const double r = number(*s, "radius"), pitch = number(*s, "pitch"), turns = number(*s, "turns");
    check_count(segments_in_line(turns * std::hypot(2 * std::numbers::pi * r, pitch), number(*s, "size")), *s);
    return make_helix(r, pitch, turns, number(*s, "size"));
  }
  throw error_at(shape.place, "a rod has the shape line, ring or coil");
}

double rod_length(const TetMesh& mesh) {
  double length = 0;
  for (const auto& [a, b] : mesh.rods) length += norm(mesh.rest[b] - mesh.rest[a]);
  return length;
}

// Throws InvalidInput for segments without length, for vertices of no segment, and where a rod folds back.
void check_rod(const TetMesh& mesh, const Value& body, const Place& place) {
  const std::string which = "body '" + body["name"].text() + "': ";
  std::vector<char> is_used(mesh.rest.size(), 0);
  const double length = rod_length(mesh);
  for (const auto& [a, b] : mesh.rods) {
    if (!(norm(mesh.rest[b] - mesh.rest[a]) > 1e-12 * length))
      throw error_at(place, which + "the segment from vertex " + std::to_string(a) + " to " + std::to_string(b) +
                                " has no length; merge both vertices");
    is_used[a] = is_used[b] = 1;
  }
  if (const auto unused = std::count(is_used.begin(), is_used.end(), 0); unused > 0)
    throw error_at(place, which + std::to_string(unused) + " vertices belong to no segment; remove them");
  std::vector<Vec3d> tangent_to(mesh.rest.size());
  for (const auto& [a, b] : mesh.rods)
    tangent_to[b] = 1 / norm(mesh.rest[b] - mesh.rest[a]) * (mesh.rest[b] - mesh.rest[a]);
  for (const auto& [a, b] : mesh.rods)
    if (1 + dot(tangent_to[a], tangent_to[b]) < kFolded)
      throw error_at(place, which + "it folds back on itself at vertex " + std::to_string(a) +
                                ", where its curvature is infinite; move the vertex or its neighbors");
}

// The ends of the chains of a body, as indices of its segments.
struct Ends {
  std::vector<int> first, last;
};
Ends ends_of(const TetMesh& mesh, int first, int count) {
  Ends ends;
  for (int s = 0; s < count; ++s) {
    const Segment& own = mesh.rods[first + s];
    bool has_before = false, has_after = false;
    for (int t = 0; t < count; ++t) {
      has_before |= mesh.rods[first + t][1] == own[0];
      has_after |= mesh.rods[first + t][0] == own[1];
    }
    if (!has_before) ends.first.push_back(s);
    if (!has_after) ends.last.push_back(s);
  }
  return ends;
}

// Prescribes the angles of segments whose vertices are all pinned, and of the first and last ones with a formula.
class TwistPins {
 public:
  TwistPins(const PlacedBody& body, Model& model) : body_(body), model_(model) {}

  void add(const RodSegment& segment, const char* key, const Value* formula) {
    std::function<double(double)> angle;
    if (formula) angle = function_of_time(*formula, std::string(key) + ": the formula may use only t");
    Pin pin{body_.name() + "." + (formula ? key : "twist"), {segment.row}, {}, {{}}};
    pin.directions[0][segment.entry] = 1;
    if (angle)
      pin.motion = [angle, direction = pin.directions[0], length = segment.length](const Vec3d& start, double time) {
        return start + (length * angle(time)) * direction;
      };
    model_.pins.push_back(std::move(pin));
  }

 private:
  const PlacedBody& body_;
  Model& model_;
};

void add_twist_pins(const PlacedBody& body, std::span<const RodSegment> segments, Model& model) {
  const Value& rod = body.scene["rod"];
  const Ends ends = ends_of(model.mesh, body.first_segment, static_cast<int>(segments.size()));
  std::vector<const char*> keys(segments.size(), nullptr);
  for (const auto& [key, places] : {std::pair{"twist_first", &ends.first}, std::pair{"twist_last", &ends.last}}) {
    const Value* formula = rod.find(key);
    if (!formula) continue;
    if (places->empty()) throw error_at(formula->place, std::string(key) + ": body '" + body.name() + "' has no ends");
    for (const int s : *places) {
      if (keys[s])
        throw error_at(formula->place,
                       std::string(key) + ": body '" + body.name() + "' has one segment, and twist_first turns it");
      keys[s] = key;
    }
  }
  TwistPins pins(body, model);
  for (size_t s = 0; s < segments.size(); ++s)
    if (keys[s] || segments[s].is_held) pins.add(segments[s], keys[s], keys[s] ? rod.find(keys[s]) : nullptr);
}

}  // namespace

BodyMesh make_rod_mesh(Value& body, MeshLoader& loader) {
  refuse_keys_of_solids(body, {"rod",
                               "a rod is linear in its strains (remove it)",
                               {"traction", "pressure", "cavity"},
                               {"viscosity", "stiffness"}});
  if (const Value& elastic = body["elastic"]; !elastic.boolean())
    throw error_at(elastic.place,
                   "elastic = false: body '" + body["name"].text() + "' has `rod`, and needs its elasticity");
  const Value* shape = body.find("shape");
  const Place place = (shape ? *shape : body["mesh"]).place;
  TetMesh mesh = shape ? rod_from_shape(*shape, loader) : thin_mesh_from_file(body, loader, read_line_mesh);
  try {
    mesh.rods = chained(mesh.vertex_count(), mesh.rods);
  } catch (const InvalidInput& e) {
    throw error_at(place, "body '" + body["name"].text() + "': " + e.what());
  }
  aspic::place(placement_of(body), mesh.rest);
  check_rod(mesh, body, place);
  const auto count = static_cast<double>(mesh.rods.size());
  if (const std::string why = loader.why_not(count); !why.empty())
    throw error_at(body.place, why + " (choose a coarser polyline)");
  loader.tets += count;
  const double radius = body["rod"]["radius"].number(), length = rod_length(mesh);
  require_proportion(body["rod"], "radius", length);
  mesh.radius.assign(mesh.rods.size(), radius);
  if (radius > kThickRod * length)
    loader.notes.push_back("body '" + body["name"].text() + "': its radius of " + number_text(radius) +
                           " m is much for a rod of " + three_digits(length) +
                           " m: rods are longer than ten radii (model it by tets)");
  check_fingerprint(body.table(), "mesh_hash", fingerprint_of(mesh), "the mesh of body '" + body["name"].text() + "'");
  BodyMesh result;
  for (int v = 0; v < mesh.vertex_count(); ++v) result.embedding.carriers.push_back(Carrier::of_vertex(v));
  result.skin.vertices = mesh.rest;
  result.tets = std::move(mesh);
  return result;
}

std::unique_ptr<TetElasticity> rod_elasticity(const PlacedBody& body, const BodyMaterial& material,
                                              const std::vector<char>& held, Model& model,
                                              std::vector<RodSegment>& segments) {
  const Value& rod = body.scene["rod"];
  const double radius = rod["radius"].number(), I = std::numbers::pi * std::pow(radius, 4) / 4;
  std::vector<double> young;
  const int first_row = model.rows();
  std::vector<RodSegment> own;
  for (size_t s = 0; s < material.parameters.size(); ++s) {
    const Segment& ends = model.mesh.rods[body.first_segment + s];
    young.push_back(young_modulus(material.parameters[s].lame));
    RodSegment segment{ends, young.back() * I, 2 * I * material.parameters[s].lame.mu};
    segment.natural_twist = rod["natural_twist"].number();
    segment.is_straight = rod["rest"].text() == "straight";
    segment.is_held = held[ends[0]] && held[ends[1]];
    segment.row = first_row + static_cast<int>(s / 3);
    segment.entry = static_cast<int>(s % 3);
    segment.length = radius;
    own.push_back(segment);
  }
  for (const AngleRow& row : make_rod_rows(model.mesh, body.first_segment, material.density, radius))
    model.angle_rows.push_back(row);
  add_twist_pins(body, own, model);
  segments.insert(segments.end(), own.begin(), own.end());
  return make_rod_stretch(model.mesh, body.first_segment, young);
}

}  // namespace aspic

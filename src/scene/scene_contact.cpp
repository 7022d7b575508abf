#include "scene/scene_contact.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "base/error.h"
#include "contact/contact_mesh.h"
#include "contact/contact_reach.h"
#include "contact/overlaps.h"
#include "dynamics/contact.h"
#include "dynamics/integrator.h"
#include "io/mesh_file.h"
#include "math/vectors.h"
#include "mesh/surface.h"
#include "scene/motion.h"
#include "scene/placement.h"
#include "scene/recording.h"
#include "scene/schema.h"
#include "scene/value.h"

namespace aspic {
namespace {

// The vertices that ContactMesh::add() keeps.
std::vector<int> used_vertices(const TriMesh& surface) {
  std::vector<char> is_used(surface.vertices.size());
  for (const Triangle& t : surface.triangles)
    for (const int v : t) is_used[v] = 1;
  std::vector<int> kept;
  for (size_t v = 0; v < is_used.size(); ++v)
    if (is_used[v]) kept.push_back(static_cast<int>(v));
  return kept;
}

// Reads the `recording` of an obstacle, whose vertices it moves to their places at time 0. Throws InvalidInput.
ObstacleMotion recorded_motion(Value& obstacle, const AffineMap& place, SceneFiles& files, TriMesh& surface) {
  const auto recording = read_recording(obstacle.table().find("recording")->table(), place, surface.vertices.size(),
                                        files, obstacle["name"].text());
  std::vector<int> all(surface.vertices.size());
  for (size_t v = 0; v < all.size(); ++v) all[v] = static_cast<int>(v);
  recording->interpolate(all, 0, surface.vertices);
  return [recording, kept = used_vertices(surface)](double time, std::span<const Vec3d>, std::span<Vec3d> x) {
    recording->interpolate(kept, time, x);
  };
}

// Smallest Young's modulus of the elastic elements of a body; 0 without any.
double smallest_young(const Model& model, const BodyRange& body) {
  double smallest = 0;
  const int first = body.first_element(model.mesh);
  for (int e = first; e < first + body.element_count(); ++e) {
    const double E = model.tet_fields[0].second[e];
    if (E > 0 && (smallest == 0 || E < smallest)) smallest = E;
  }
  return smallest;
}

// Adds a rod, which resists pressure by bending: its stiffness is E times diameter over length of a segment.
void add_rod(ContactPart part, const Model& model, const BodyRange& body, const std::vector<int>& rows,
             ContactMesh& contact) {
  const double diameter = 2 * model.mesh.radius[body.first_segment];
  part.offset = diameter / 2;
  contact.add_rod(part, model.mesh.rest, std::span(model.mesh.rods).subspan(body.first_segment, body.segment_count),
                  rows);
  ContactPart& own = contact.parts.back();
  own.young *= std::min(1.0, diameter / own.mean_edge);
  own.self_offset = allowed_self_offset(contact, static_cast<int>(contact.parts.size()) - 1, diameter);
}

// Adds the surface of a body. A sheet resists pressure by bending and stretching: its stiffness is E t / edge, and its
// surface lies half the thickness from its triangles.
void add_body(ContactPart part, const Model& model, const BodyRange& body, ContactMesh& contact) {
  std::vector<int> rows(model.mesh.rest.size());
  std::iota(rows.begin(), rows.end(), 0);
  if (body.is_rod()) return add_rod(part, model, body, rows, contact);
  if (!body.is_sheet())
    return contact.add(part, model.mesh.rest, boundary_triangles(model.mesh, body.first_tet, body.tet_count), rows);
  const double thickness = model.mesh.thickness[body.first_triangle];
  part.offset = thickness / 2;
  part.is_hollow = true;
  contact.add(part, model.mesh.rest, std::span(model.mesh.sheet).subspan(body.first_triangle, body.triangle_count),
              rows);
  ContactPart& own = contact.parts.back();
  own.young *= thickness / own.mean_edge;
  own.self_offset = allowed_self_offset(contact, static_cast<int>(contact.parts.size()) - 1, thickness);
}

double friction_of(const Value& table, double fallback) {
  const Value* own = table.find("friction");
  return own ? own->number() : fallback;
}

TriMesh surface_of(Value& obstacle, MeshLoader& loader) {
  if (const Value* shape = obstacle.find("shape")) return shape_surface(*shape, loader);
  const Value mesh = obstacle["mesh"];
  const std::filesystem::path path = loader.files.find(mesh);
  try {
    TriMesh surface = read_tri_mesh(path);
    check_fingerprint(obstacle.table(), "hash", fingerprint_of_file(path), path.string());
    obstacle.table().set("mesh", {loader.files.keep(path, obstacle["name"].text()), {}});
    return surface;
  } catch (const InvalidInput& e) {
    throw error_at(mesh.place, std::string("mesh = ") + toml_string(mesh.text()) + ": " + e.what());
  }
}

ObstacleMotion motion_of(const Value& obstacle, const std::vector<Vec3d>& starts) {
  const Motion motion = make_motion(obstacle["motion"], starts);
  if (!motion) return nullptr;
  return [motion](double time, std::span<const Vec3d> start, std::span<Vec3d> x) {
    for (size_t i = 0; i < x.size(); ++i) x[i] = motion(start[i], time);
  };
}

// Planes, spheres and capsules move without rotation.
void refuse_rotation(const Value& obstacle) {
  const Value& motion = obstacle["motion"];
  if (!motion.is_text() && motion.find("rotate"))
    throw error_at(motion.place, "planes, spheres and capsules do not rotate; use a mesh or a shape");
}

void add_round_obstacle(const Value& obstacle, const Value& table, ContactPart part, ContactMesh& contact) {
  refuse_rotation(obstacle);
  const Vec3d from = table[table.find("center") ? "center" : "from"].vector();
  const Vec3d to = table.find("center") ? from : table["to"].vector();
  part.offset = table["radius"].number();
  part.motion = motion_of(obstacle, {from, to});
  contact.add_capsule(part, {from, to});
}

void add_obstacle(Value& obstacle, double friction, MeshLoader& loader, ContactMesh& contact) {
  const std::string name = obstacle["name"].text();
  for (const char* kind : {"sphere", "capsule"})
    if (const Value* table = obstacle.find(kind))
      return add_round_obstacle(obstacle, *table, {.name = name, .friction = friction}, contact);
  if (const Value* plane = obstacle.find("plane")) {
    refuse_rotation(obstacle);
    const Value& normal = (*plane)["normal"];
    if (!(norm(normal.vector()) > 0)) throw error_at(normal.place, "normal has length 0; try [0, 1, 0]");
    const Vec3d origin = (*plane)["origin"].vector();
    return contact.add_plane({.name = name, .friction = friction, .motion = motion_of(obstacle, {origin})}, origin,
                             normal.vector());
  }
  TriMesh surface = surface_of(obstacle, loader);
  const AffineMap place = placement_of(obstacle);
  for (Vec3d& X : surface.vertices) {
    X = place(X);
    if (!std::isfinite(X[0] + X[1] + X[2])) throw error_at(obstacle.place, "obstacle '" + name + "' is not finite");
  }
  if (surface.triangles.empty()) throw error_at(obstacle.place, "obstacle '" + name + "' has no triangles");
  ContactPart part{.name = name, .is_obstacle = true, .friction = friction};
  part.motion = obstacle.find("recording") ? recorded_motion(obstacle, place, loader.files, surface)
                                           : motion_of(obstacle, surface.vertices);
  contact.add(part, surface.vertices, surface.triangles, {});
}

// Bodies, then obstacles.
void complete_names(std::vector<Value>& obstacles, const Model& model) {
  std::set<std::string> names;
  for (const BodyRange& body : model.bodies) names.insert(body.name);
  for (size_t i = 0; i < obstacles.size(); ++i) {
    if (!obstacles[i].find("name")) obstacles[i].table().set("name", {"obstacle" + std::to_string(i + 1), {}});
    const Value& name = obstacles[i]["name"];
    if (!names.insert(name.text()).second)
      throw error_at(name.place, "two bodies or obstacles are called '" + name.text() + "'; names must differ");
  }
}

int part_number(const Value& name, const ContactMesh& contact) {
  std::vector<std::string> names;
  for (const ContactPart& part : contact.parts) {
    if (part.name == name.text()) return static_cast<int>(names.size());
    names.push_back(part.name);
  }
  throw error_at(name.place, "no body or obstacle is called '" + name.text() + "'" + suggestion(name.text(), names));
}

std::vector<PairFriction> pairs_of(const Value& options, const ContactMesh& contact) {
  std::vector<PairFriction> pairs;
  std::set<std::array<int, 2>> known;
  const Value* tables = options.find("pair");
  for (const Value& table : tables ? tables->array() : Array{}) {
    const Value& between = table["between"];
    if (between.array().size() != 2) throw error_at(between.place, "between needs two names of bodies or obstacles");
    std::array<int, 2> parts = {part_number(between.array()[0], contact), part_number(between.array()[1], contact)};
    std::sort(parts.begin(), parts.end());
    if (contact.parts[parts[0]].is_obstacle)
      throw error_at(between.place, "obstacles do not touch each other; name a body");
    if (!known.insert(parts).second) throw error_at(between.place, "an earlier pair has the same names");
    pairs.push_back({parts, table["friction"].number()});
  }
  return pairs;
}

// Returns the pairs of parts that intersect at the initial positions, or are behind a plane.
std::set<std::array<int, 2>> overlapping_parts(const ContactMesh& contact, const std::vector<double>& q) {
  std::vector<Vec3d> x = contact.rest;
  for (int p = 0; p < contact.point_count(); ++p)
    if (contact.row[p] >= 0) x[p] = point(q, contact.row[p]);
  std::set<std::array<int, 2>> pairs;
  for (const Overlaps::Pair& pair : overlaps(contact, x).pairs) pairs.insert(pair.parts);
  for (const ContactPlane& plane : contact.planes)
    for (int p = 0; p < contact.point_count(); ++p)
      if (contact.row[p] >= 0 && dot(plane.normal, x[p] - x[plane.point]) < 0)
        pairs.insert({contact.part[p], plane.part});
  return pairs;
}

constexpr size_t kMaxListed = 4;

// Adds notes on the reach of the pairs: that of most, then the smallest ones with their reasons.
void note_reaches(const Barrier& contact, MeshLoader& loader) {
  constexpr double kSlow = 1.0 / 1000;  // reach relative to the edges below which sliding takes many iterations
  struct Bounded {
    std::array<int, 2> parts;
    const ContactLaw* law;
  };
  std::vector<Bounded> bounded;
  const ContactLaw* widest = nullptr;  // among those that only the edges bound
  const int parts = static_cast<int>(contact.mesh().parts.size());
  for (int a = 0; a < parts; ++a)
    for (int b = a; b < parts; ++b) {
      const ContactLaw& law = contact.laws()(a, b);
      if (law.reach == 0) continue;
      const bool is_usual = law.basis == ReachBasis::edge || law.basis == ReachBasis::given;
      if (is_usual && (!widest || law.reach > widest->reach)) widest = &law;
      if (!is_usual) bounded.push_back({{a, b}, &law});
    }
  std::stable_sort(bounded.begin(), bounded.end(),
                   [](const Bounded& a, const Bounded& b) { return a.law->reach < b.law->reach; });
  if (widest) loader.notes.push_back("contact begins at " + three_digits(widest->reach) + " m: " + reason_of(*widest));
  for (size_t i = 0; i < std::min(bounded.size(), kMaxListed); ++i) {
    const ContactLaw& law = *bounded[i].law;
    loader.notes.push_back("contact of " + contact.mesh().pair_name(bounded[i].parts) + " begins at " +
                           three_digits(law.reach) + " m: " + reason_of(law) +
                           (law.reach < kSlow * law.edge
                                ? "; where they slide, steps take fewer iterations with a larger contact.reach"
                                : ""));
  }
  if (bounded.size() > kMaxListed)
    loader.notes.push_back("contact of " + std::to_string(bounded.size() - kMaxListed) + " other pairs begins at " +
                           three_digits(bounded[kMaxListed].law->reach) + " to " +
                           three_digits(bounded.back().law->reach) + " m, for such reasons");
}

// Adds a note if thin bodies, which users expect to lie on others, pass through them.
void note_no_contact(const Model& model, std::vector<std::string>& notes) {
  const auto thin = std::find_if(model.bodies.begin(), model.bodies.end(),
                                 [](const BodyRange& body) { return body.is_sheet() || body.is_rod(); });
  if (thin == model.bodies.end() || model.bodies.size() < 2) return;
  notes.push_back("contact is off: body '" + thin->name +
                  "' passes through the other bodies; a line [contact] in the scene switches it on");
}

bool is_static(const Table& document) {
  return make_integrator((*document.find("time"))["integrator"].text())->facts().is_static();
}

}  // namespace

void add_scene_contact(Table& document, MeshLoader& loader, const std::vector<double>& q, Model& model) {
  Value* obstacles = document.find("obstacle");
  if (!document.find("contact") && !obstacles) return note_no_contact(model, loader.notes);
  if (!document.find("contact")) {
    Table defaults;
    defaults.set("friction", {0.0, {}});
    defaults.set("start", {std::string("apart"), {}});
    document.set("contact", {defaults, {}});
  }
  const Value& options = *document.find("contact");
  const double friction = options["friction"].number();
  const auto number = [&options](const char* key) {
    const Value* value = options.find(key);
    return value ? value->number() : 0.0;
  };
  ContactMesh contact;
  const std::vector<Value>& bodies = document.find("body")->array();
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const BodyRange& body = model.bodies[b];
    add_body({.name = body.name, .young = smallest_young(model, body), .friction = friction_of(bodies[b], friction)},
             model, body, contact);
  }
  if (obstacles) {
    complete_names(obstacles->array(), model);
    for (Value& obstacle : obstacles->array()) add_obstacle(obstacle, friction_of(obstacle, friction), loader, contact);
  }
  ContactOptions given{.reach = number("reach"),
                       .stiffness = number("stiffness"),
                       .pairs = pairs_of(options, contact),
                       .start = q,
                       .reach_per_edge = is_static(document) ? kStaticReachPerEdge : kReachPerEdge};
  if (options["start"].text() == "inflate") given.overlapping = overlapping_parts(contact, q);
  for (const ContactPart& part : contact.parts)
    if (!part.is_obstacle && given.reach > part.mean_edge)
      throw error_at(options["reach"].place, "reach = " + number_text(given.reach) + "; body '" + part.name +
                                                 "' has edges of " + number_text(part.mean_edge) +
                                                 " m, and contact must begin closer than that (try " +
                                                 number_text(kReachPerEdge * part.mean_edge) + ")");
  if (given.stiffness == 0)
    for (const ContactPart& part : contact.parts)
      if (!part.is_obstacle && part.young == 0)
        throw error_at(options.place, "body '" + part.name +
                                          "' is not elastic, so contact has no default stiffness; "
                                          "set contact.stiffness [Pa]");
  const double weight = norm(document.find("gravity")->vector());
  const double creep = options.find("creep") || weight == 0 ? number("creep") : default_creep(weight, model);
  add_contact(std::move(contact), given, creep, model);
  note_reaches(*model.contact, loader);
  for (const ContactPart& part : model.contact->mesh().parts)
    if (part.is_hollow && part.self_offset < 0.99 * 2 * part.offset)
      loader.notes.push_back(
          "body '" + part.name + "' keeps " + three_digits(part.self_offset) +
          " m from itself instead of its thickness, because that is .4 of the distance of its parts at rest");
  const ContactMesh& mesh = model.contact->mesh();
  for (const auto& [inner, outer, place] : enclosed_parts(mesh, model.contact->points(q, 0)))
    if (mesh.parts[outer].is_obstacle)
      loader.notes.push_back("body '" + mesh.parts[inner].name + "' starts inside of obstacle '" +
                             mesh.parts[outer].name + "', which contains it");
}

std::string start_warning(const Simulation& simulation) {
  constexpr double kWeak = 1e-3;  // pressure relative to the stiffness of contact; surfaces are at 98 % of the reach
  const Barrier* contact = simulation.model().contact;
  if (!contact) return "";
  const std::vector<double>& q = simulation.state().q;
  const ContactEnergy energy = contact->energy(q, simulation.obstacle_time());
  if (energy.parts[0] < 0) return "";
  const ContactLaw& law = contact->laws()(energy.parts[0], energy.parts[1]);
  if (law.basis != ReachBasis::given) return "";  // separated at the start, and at rest
  if (contact->summary(q, simulation.obstacle_time()).max_pressure < kWeak * law.stiffness) return "";
  return "contact stores " + three_digits(energy.total) + " J at the start and pushes bodies apart, most " +
         contact->mesh().pair_name(energy.parts) + ", whose gap of " + three_digits(energy.gap) +
         " m is smaller than the distance at which contact begins, " + three_digits(law.reach) +
         " m; choose a smaller contact.reach, or move them apart";
}

void note_touching(const std::set<std::array<int, 2>>& pairs, const Model& model, MeshLoader& loader) {
  if (pairs.empty()) return;
  std::string names;
  size_t listed = 0;
  for (const auto& pair : pairs)
    if (listed++ < kMaxListed) names += (names.empty() ? "" : "; ") + model.contact->mesh().pair_name(pair);
  if (pairs.size() > kMaxListed) names += "; and " + std::to_string(pairs.size() - kMaxListed) + " other pairs";
  loader.notes.push_back(
      "surfaces touch at the start: " + names +
      "; the touching vertices are moved into their solids, or off with their sheet, to where contact begins");
}

}  // namespace aspic

#include "scene/body_actions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "dynamics/model_builder.h"
#include "dynamics/pins.h"
#include "dynamics/pressure_load.h"
#include "energy/linear_load.h"
#include "energy/load_points.h"
#include "energy/rayleigh_damping.h"
#include "energy/springs.h"
#include "mesh/surface.h"
#include "scene/body_branches.h"
#include "scene/body_cavities.h"
#include "scene/body_fibres.h"
#include "scene/body_grabs.h"
#include "scene/expression.h"
#include "scene/motion.h"
#include "scene/placement.h"
#include "scene/selection.h"
#include "scene/surface_motion.h"
#include "scene/tables.h"

namespace aspic {
namespace {

struct Builder {
  std::vector<PlacedBody>& bodies;
  Vec3d up;
  Model& model;
  SceneFiles& files;
  std::vector<std::string>& notes;
  std::vector<PointSpring> point_springs;
  std::vector<Spring> springs;
  double duration = 0;  // of the run [s]
  int pressures = 0;    // number of added pressures

  // For the selection `where` of an action.
  SelectionScope scope(const PlacedBody& body, Value& action) const {
    return selection_scope(body, *action.table().find("where"), up);
  }
};

Array& list_of(const PlacedBody& body, const char* key) {
  static Array none;
  Value* list = body.scene.table().find(key);
  return list ? list->array() : none;
}

std::vector<Vec3d> chosen(const std::vector<Vec3d>& points, const std::vector<int>& vertices) {
  std::vector<Vec3d> result;
  for (const int v : vertices) result.push_back(points[v]);
  return result;
}

// Points that an action moves, by their positions at rest and at time 0; `name`: the action.
struct MovedPoints {
  const std::vector<Vec3d>&rest, &starts;
  std::string name;
};

Motion motion_of(const PlacedBody& body, Value& action, const MovedPoints& points, SceneFiles& files) {
  Value& motion = *action.table().find("motion");
  Value* recording = motion.is_table() ? motion.table().find("recording") : nullptr;
  if (!recording) return make_motion(motion, points.starts);
  return make_surface_motion(
      recording->table(),
      {points.rest, points.starts, placement_of(body.scene), body.name(), body.name() + "." + points.name}, files);
}

std::vector<Vec3d> directions_of(const Value& pin) {  // empty: all
  if (const Value* given = pin.find("direction")) {
    const Vec3d d = given->vector();
    const double largest = std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
    const Vec3d n = (1 / largest) * d;
    return {(1 / norm(n)) * n};
  }
  std::vector<Vec3d> axes;
  for (const char axis : pin["axes"].text())
    axes.push_back({{axis == 'x' ? 1. : 0., axis == 'y' ? 1. : 0., axis == 'z' ? 1. : 0.}});
  return axes.size() == 3 ? std::vector<Vec3d>{} : axes;
}

constexpr double kRecordedRoundOff = 1e-6;  // of positions in point caches, relative to the coordinates

// A motion that does not start at the vertices moves them abruptly in the first step.
void note_jump(const Pin& pin, const std::vector<Vec3d>& starts, std::vector<std::string>& notes) {
  if (!pin.motion) return;
  double jump = 0, size = 0;
  for (const Vec3d& x : starts) {
    size = std::max(size, norm(x));
    const Vec3d d = pin.motion(x, 0) - x;
    double squared = pin.directions.empty() ? dot(d, d) : 0;
    for (const Vec3d& n : pin.directions) squared += dot(n, d) * dot(n, d);
    jump = std::max(jump, std::sqrt(squared));
  }
  if (jump > kRecordedRoundOff * size)
    notes.push_back("pin " + pin.name + " jumps by " + number_text(jump) +
                    " m at time 0: its motion does not start at 0");
}

// Suggests a selection of the second pin without the vertices of the first.
std::string omit_one(const Value& first, const Value& second, bool leaves_any) {
  const Value &a = first["where"], &b = second["where"];
  if (!leaves_any) return "remove pin '" + second["name"].text() + "': all of its vertices are in other pins";
  if (!a.is_text() || !b.is_text()) return "exclude it from one of them";
  return "try where = \"(" + b.text() + ") && !(" + a.text() + ")\" in pin '" + second["name"].text() + "'";
}

// Returns a time of the run at which the motions of the pins of a vertex contradict each other, if there is one.
std::optional<double> time_of_conflict(std::span<const Pin* const> pins, const Vec3d& start, double duration) {
  constexpr int kSamples = 16;
  constexpr double kRoundOff = 1e-9;  // of positions
  for (int i = 0; i <= kSamples; ++i) {
    const double time = duration * i / kSamples;
    double size = norm(start);
    for (const Pin* pin : pins) size = std::max(size, pin->motion ? norm(pin->motion(start, time)) : 0);
    if (!(disagreement(pins, start, time) <= kRoundOff * size)) return time;
  }
  return {};
}

void add_pins(Builder& builder, const PlacedBody& body) {
  std::vector<std::vector<int>> holders(body.mesh.rest.size());  // indices of the pins of each vertex
  Array& scenes = list_of(body, "pin");
  const size_t first = builder.model.pins.size();
  builder.model.pins.reserve(first + scenes.size());
  for (Value& scene : scenes) {
    const std::string name = scene["name"].text();
    const std::vector<int> vertices = select_vertices(scene["where"], builder.scope(body, scene));
    const std::vector<Vec3d> rest = chosen(body.mesh.rest, vertices), starts = chosen(body.start, vertices);
    Pin& pin = builder.model.pins.emplace_back(Pin{body.name() + "." + name,
                                                   {},
                                                   motion_of(body, scene, {rest, starts, name}, builder.files),
                                                   directions_of(scene)});
    note_jump(pin, starts, builder.notes);
    const bool leaves_any = std::any_of(vertices.begin(), vertices.end(), [&](int v) { return holders[v].empty(); });
    for (const int v : vertices) {
      holders[v].push_back(static_cast<int>(builder.model.pins.size() - 1 - first));
      pin.vertices.push_back(body.model_vertex(v));
      if (holders[v].size() == 1) continue;
      std::vector<const Pin*> pins;
      for (const int p : holders[v]) pins.push_back(&builder.model.pins[first + p]);
      const auto time = time_of_conflict(pins, body.start[v], builder.duration);
      const Value& other = scenes[holders[v][holders[v].size() - 2]];
      if (time)
        throw error_at(scene["where"].place,
                       "vertex " + std::to_string(body.user_vertex(v)) + " of body '" + body.name() + "' at " +
                           point_text(body.mesh.rest[v]) + " is in pin '" + other["name"].text() + "' and in pin '" +
                           name + "', which prescribe different positions in the same direction at t = " +
                           number_text(*time) + "; " + omit_one(other, scene, leaves_any));
    }
  }
}

// The stiffness of a spring at each of the vertices [N/m]: that of the scene times the painted value, if any.
std::vector<double> stiffness_at(const std::vector<int>& vertices, const Value& spring, const SelectionScope& scope) {
  std::vector<double> result;
  for (const int v : vertices) {
    result.push_back(spring["stiffness"].number() * (scope.painted ? (*scope.painted)[v] : 1));
    if (!(result.back() > 0))
      throw error_at(spring["where"].place,
                     "vertex " + std::to_string(v) + " of body '" + scope.body + "' has the painted value " +
                         number_text((*scope.painted)[v]) +
                         ", by which the stiffness of its spring is multiplied: set above = 0 or larger");
  }
  return result;
}

void add_point_springs(Builder& builder, const PlacedBody& body, Value& scene, const std::string& name) {
  const SelectionScope scope = builder.scope(body, scene);
  const std::vector<int> vertices = select_vertices(scene["where"], scope);
  const std::vector<double> stiffness = stiffness_at(vertices, scene, scope);
  std::vector<Vec3d> rest = chosen(body.mesh.rest, vertices), targets = chosen(body.start, vertices);
  if (const Value* target = scene.find("target")) {
    targets.assign(vertices.size(), target->vector());
    rest = targets;
  }
  const Motion motion = motion_of(body, scene, {rest, targets, name}, builder.files);
  for (size_t i = 0; i < vertices.size(); ++i) {
    const Vec3d start = targets[i];
    if (motion) motion(start, 0);  // evaluates the formula early
    builder.point_springs.push_back({body.model_vertex(vertices[i]), stiffness[i],
                                     [start, motion](double time) { return motion ? motion(start, time) : start; }});
  }
}

int vertex_of(const Value& index, const PlacedBody& body) {
  const std::int64_t i = std::get<std::int64_t>(index.data);
  if (i >= body.mesh.vertex_count())
    throw error_at(index.place, "between: " + std::to_string(i) + " is beyond the last vertex of body '" + body.name() +
                                    "', " + std::to_string(body.mesh.vertex_count() - 1));
  return static_cast<int>(i);
}

void add_springs_between(Builder& builder, const PlacedBody& body, const Value& scene) {
  const Value* other_name = scene.find("to_body");
  const PlacedBody* other = &body;
  for (const PlacedBody& b : builder.bodies)
    if (other_name && b.name() == other_name->text()) other = &b;
  for (const Value& pair : scene["between"].array()) {
    const int a = vertex_of(pair.array()[0], body), b = vertex_of(pair.array()[1], *other);
    if (a == b && other == &body)
      throw error_at(pair.place, "between: a spring from vertex " + std::to_string(a) + " to itself");
    const Vec3d d = body.mesh.rest[a] - other->mesh.rest[b];
    const Value* length = scene.find("rest_length");
    builder.springs.push_back({body.model_vertex(a), other->model_vertex(b), length ? length->number() : norm(d),
                               scene["stiffness"].number()});
  }
}

void add_springs(Builder& builder, const PlacedBody& body) {
  int number = 0;
  for (Value& scene : list_of(body, "spring")) {
    ++number;
    if (scene.find("where")) {
      add_point_springs(builder, body, scene, "spring" + std::to_string(number));
    } else if (scene.find("between")) {
      add_springs_between(builder, body, scene);
    } else {
      if (!body.mesh.mids.empty())
        throw error_at(scene["edges"].place, "edges: springs along the edges need linear tets; body '" + body.name() +
                                                 "' has order = 2 (remove it)");
      const std::vector<Spring> edges =
          edge_springs(builder.model.mesh, body.first_tet, body.mesh.tet_count(), scene["stiffness"].number());
      builder.springs.insert(builder.springs.end(), edges.begin(), edges.end());
    }
  }
}

// Density of a load at a point with the outward normal n of any length: a vector, or a pressure.
class LoadDensity {
 public:
  explicit LoadDensity(const Value& scene) {
    if (const Value* value = scene.find("value")) {
      vector_.emplace(*value, ExpressionVariables::position_and_time);
      place_ = value->place;
    } else {
      const Value& p = scene["dead_pressure"];
      pressure_.emplace(p.is_text() ? p.text() : number_text(p.number()), ExpressionVariables::position_and_time);
      place_ = p.place;
    }
  }
  bool depends_on_time() const { return vector_ ? vector_->depends_on_time() : pressure_->depends_on_time(); }
  Vec3d at(const Vec3d& X, const Vec3d& n, double time) const {
    try {
      return vector_ ? vector_->at(X, time) : (-pressure_->at(X, time) / norm(n)) * n;
    } catch (const InvalidInput& e) {  // possibly long after the scene was read
      throw error_at(place_, e.what());
    }
  }

 private:
  std::optional<VectorField> vector_;
  std::optional<Expression> pressure_;
  Place place_;
};

struct LoadGroup {
  LoadDensity density;
  std::vector<LoadElement> elements;  // nodes in the model

  void add(const PlacedBody& body, LoadElement element) {
    for (int n = 0; n < element.node_count; ++n) element.node[n] = body.model_vertex(element.node[n]);
    elements.push_back(element);
  }
  void add_to(std::span<double> force, double time) const {
    for (const LoadElement& element : elements)
      add_load(
          element, [&](const Vec3d& X) { return density.at(X, element.normal, time); }, force);
  }
};

void add_tractions(const Builder& builder, const PlacedBody& body, std::vector<LoadGroup>& groups) {
  Array& tractions = list_of(body, "traction");
  if (tractions.empty()) return;
  const std::vector<Face> boundary = surface_faces(body.mesh);
  for (Value& scene : tractions) {
    LoadGroup group{LoadDensity(scene), {}};
    for (const Face& face : select_faces(scene["where"], builder.scope(body, scene), boundary))
      group.add(body, load_element(body.mesh.rest, face));
    groups.push_back(std::move(group));
  }
}

bool starts_at_rest(const PlacedBody& body) {
  return std::equal(body.start.begin(), body.start.end(), body.mesh.rest.begin(),
                    [](const Vec3d& x, const Vec3d& X) { return std::equal(x.a, x.a + 3, X.a); });
}

// Each is a separate term: pressure, pressure_2, ...
void add_pressures(Builder& builder, const PlacedBody& body) {
  Array& pressures = list_of(body, "pressure");
  if (pressures.empty()) return;
  const std::vector<Face> boundary = surface_faces(body.mesh);
  for (Value& scene : pressures) {
    const Value& value = scene["value"];
    const auto of_time = function_of_time(value,
                                          "value: a follower pressure is uniform, so its formula "
                                          "may use only t (for a load of X, Y, Z with fixed direction: dead_pressure "
                                          "of a [[body.traction]])");
    std::vector<Face> patch = select_faces(scene["where"], builder.scope(body, scene), boundary);
    for (Face& face : patch) {
      for (int& v : face.corners) v = body.model_vertex(v);
      for (int& v : face.mids) v = v < 0 ? v : body.model_vertex(v);
    }
    const int number = ++builder.pressures;
    of_time(0);
    const std::string name = number == 1 ? "pressure" : "pressure_" + std::to_string(number);
    const PressureForm form = add_pressure({name, patch, of_time, starts_at_rest(body)}, builder.model);
    builder.notes.push_back(name + " on body '" + body.name() + "': " + std::string(to_string(form)));
  }
}

void add_body_forces(const Builder& builder, const PlacedBody& body, std::vector<LoadGroup>& groups) {
  for (Value& scene : list_of(body, "force")) {
    LoadGroup group{LoadDensity(scene), {}};
    for (const int t : select_tets(scene["where"], builder.scope(body, scene)))
      group.add(body, load_element(body.mesh, t));
    groups.push_back(std::move(group));
  }
}

void add_linear_load(Model& model, const char* name, std::vector<double> force) {
  if (std::any_of(force.begin(), force.end(), [](double f) { return f != 0; }))
    model.loads.push_back(make_linear_load(name, std::move(force)));
}

void add_linear_load(Model& model, const char* name, std::vector<LoadGroup> groups) {
  std::vector<double> constant(3 * model.mesh.rest.size(), 0.0);
  std::vector<LoadGroup> varying;
  for (LoadGroup& group : groups) {
    if (group.density.depends_on_time())
      varying.push_back(std::move(group));
    else
      group.add_to(constant, 0);
  }
  if (varying.empty()) return add_linear_load(model, name, std::move(constant));
  const auto add = [varying = std::move(varying)](double time, std::span<double> force) {
    for (const LoadGroup& group : varying) group.add_to(force, time);
  };
  model.loads.push_back(make_linear_load(name, std::move(constant), add));  // evaluates the formulas at time 0
}

void add_loads(Builder& builder, const Vec3d& gravity) {
  add_linear_load(builder.model, "gravity", weights(*builder.model.mass, gravity));
  std::vector<LoadGroup> per_volume, per_area;
  for (const PlacedBody& body : builder.bodies) {
    add_body_forces(builder, body, per_volume);
    add_tractions(builder, body, per_area);
    add_springs(builder, body);
    add_pressures(builder, body);
  }
  add_cavities(builder.bodies, builder.up, builder.notes, builder.model);
  add_fibres(builder.bodies, {builder.up, builder.files}, builder.model);
  Model& model = builder.model;
  add_linear_load(model, "body_force", std::move(per_volume));
  add_linear_load(model, "traction", std::move(per_area));
  if (!builder.point_springs.empty())
    model.loads.push_back(make_point_springs("point_springs", std::move(builder.point_springs)));
  if (!builder.springs.empty()) model.loads.push_back(make_springs("springs", std::move(builder.springs)));
}

void add_damping(PlacedBody& body, size_t index, MassKind kind, SceneFiles& files, Model& model) {
  Value& damping = *body.scene.table().find("damping");
  const double a = damping["mass"].number(), b = damping["stiffness"].number();
  if (a > 0 || b > 0) {
    std::vector<double> density(model.density.size(), 0.0);  // densities of this body, zero elsewhere
    const std::ptrdiff_t first = model.bodies[index].first_element(model.mesh);
    std::copy_n(model.density.begin() + first, body.mesh.element_count(), density.begin() + first);
    model.damping.push_back(
        make_rayleigh_damping(MassMatrix(model.mesh, density, kind, angle_masses(model, &model.bodies[index])), a,
                              model.elasticity[index].get(), b));
  }
  if (body.mesh.tets.empty()) return;
  const std::vector<double> viscosity =
      element_values(damping.table(), scene_schema().key("damping", "viscosity"),
                     {body.mesh, files, body.name(), *body.painted, nullptr, &body.groups});
  if (std::any_of(viscosity.begin(), viscosity.end(), [](double eta) { return eta > 0; }))
    model.damping.push_back(
        make_strain_rate_damping(model.mesh, body.first_tet, body.numbering.tet.from_user(viscosity)));
}

Builder builder_of(const SceneActions& actions, Model& model) {
  const double g = norm(actions.gravity);
  const Vec3d up = g > 0 ? (-1 / g) * actions.gravity : Vec3d{{0, 1, 0}};
  return {actions.bodies, up, model, actions.files, actions.notes, {}, {}, actions.duration};
}

}  // namespace

SelectionScope selection_scope(const PlacedBody& body, Value& where, const Vec3d& up) {
  const bool is_painted = where.is_table() && where.find("file");
  return {body.mesh,   up,
          body.name(), is_painted ? &body.painted->at_vertices(where.table(), body.mesh) : nullptr,
          body.whole,  &body.groups};
}

void add_pins(const SceneActions& actions, Model& model) {
  Builder builder = builder_of(actions, model);
  for (const PlacedBody& body : actions.bodies) add_pins(builder, body);
}

void add_loads_and_damping(const SceneActions& actions, Model& model) {
  Builder builder = builder_of(actions, model);
  add_loads(builder, actions.gravity);
  add_grabs(actions.bodies, model);
  for (size_t i = 0; i < actions.bodies.size(); ++i)
    add_damping(actions.bodies[i], i, actions.mass, actions.files, model);
  add_branches(actions.bodies, {actions.files, actions.memory}, model);
}

}  // namespace aspic

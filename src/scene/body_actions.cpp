#include "scene/body_actions.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "energy/linear_load.h"
#include "energy/rayleigh_damping.h"
#include "energy/springs.h"
#include "mesh/surface.h"
#include "mesh/tet_shape.h"
#include "scene/body_grabs.h"
#include "scene/expression.h"
#include "scene/motion.h"
#include "scene/placement.h"
#include "scene/selection.h"
#include "scene/tables.h"

namespace aspic {
namespace {

struct Builder {
  std::vector<PlacedBody>& bodies;
  Vec3d up;
  Model& model;
  std::vector<std::string>& notes;
  std::vector<PointSpring> point_springs;
  std::vector<Spring> springs;

  SelectionScope scope(const PlacedBody& body) const { return {body.mesh, up, body.name()}; }
};

const Array& list_of(const PlacedBody& body, const char* key) {
  static const Array none;
  const Value* list = body.scene.find(key);
  return list ? list->array() : none;
}

// Formulas fail at a point; the message gets the place in the scene.
template <class F>
auto at_place(const Value& value, const F& evaluate) {
  try {
    return evaluate();
  } catch (const InvalidInput& e) {
    throw error_at(value.place, e.what());
  }
}

std::vector<Vec3d> starts_of(const PlacedBody& body, const std::vector<int>& vertices) {
  std::vector<Vec3d> starts;
  for (const int v : vertices) starts.push_back(body.start[v]);
  return starts;
}

// A motion that does not begin where the vertices are would throw them in the first step.
void note_jump(const Motion& motion, const std::vector<Vec3d>& starts, const std::string& what,
               std::vector<std::string>& notes) {
  if (!motion) return;
  double jump = 0;
  for (const Vec3d& x : starts) {
    const Vec3d d = motion(x, 0) - x;
    jump = std::max(jump, std::sqrt(dot(d, d)));
  }
  if (jump > 0)
    notes.push_back(what + " jumps by " + number_text(jump) + " m at time 0: its motion does not start at 0");
}

// What the second of two pins could select, so that none of the first's vertices is in it.
std::string leave_out(const Value& first, const Value& second, bool leaves_any) {
  const Value &a = first["where"], &b = second["where"];
  if (!leaves_any) return "remove pin '" + second["name"].text() + "': all of its vertices are in other pins";
  if (!a.is_text() || !b.is_text()) return "let one of them leave it out";
  return "try where = \"(" + b.text() + ") && !(" + a.text() + ")\" in pin '" + second["name"].text() + "'";
}

void add_pins(Builder& builder, const PlacedBody& body) {
  std::vector<const Value*> holder(body.mesh.rest.size(), nullptr);
  for (const Value& scene : list_of(body, "pin")) {
    const std::vector<int> vertices = select_vertices(scene["where"], builder.scope(body));
    const std::vector<Vec3d> starts = starts_of(body, vertices);
    const std::string name = body.name() + "." + scene["name"].text();
    Pin pin{name, {}, make_motion(scene["motion"], starts)};
    note_jump(pin.motion, starts, "pin " + name, builder.notes);
    const bool leaves_any = std::any_of(vertices.begin(), vertices.end(), [&](int v) { return !holder[v]; });
    for (const int v : vertices) {
      if (holder[v])
        throw error_at(scene["where"].place, "vertex " + std::to_string(v) + " of body '" + body.name() + "' at " +
                                                 point_text(body.mesh.rest[v]) + " is in pin '" +
                                                 (*holder[v])["name"].text() + "' and in pin '" + scene["name"].text() +
                                                 "'; " + leave_out(*holder[v], scene, leaves_any));
      holder[v] = &scene;
      pin.vertices.push_back(body.model_vertex(v));
    }
    builder.model.pins.push_back(std::move(pin));
  }
}

void add_point_springs(Builder& builder, const PlacedBody& body, const Value& scene) {
  const std::vector<int> vertices = select_vertices(scene["where"], builder.scope(body));
  std::vector<Vec3d> targets = starts_of(body, vertices);
  if (const Value* target = scene.find("target")) targets.assign(vertices.size(), target->vector());
  const Motion motion = make_motion(scene["motion"], targets);
  for (size_t i = 0; i < vertices.size(); ++i) {
    const Vec3d start = targets[i];
    if (motion) motion(start, 0);  // a formula that fails, fails here
    builder.point_springs.push_back({body.model_vertex(vertices[i]), scene["stiffness"].number(),
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
    builder.springs.push_back({body.model_vertex(a), other->model_vertex(b),
                               length ? length->number() : std::sqrt(dot(d, d)), scene["stiffness"].number()});
  }
}

void add_springs(Builder& builder, const PlacedBody& body) {
  for (const Value& scene : list_of(body, "spring")) {
    if (scene.find("where")) {
      add_point_springs(builder, body, scene);
    } else if (scene.find("between")) {
      add_springs_between(builder, body, scene);
    } else {
      const std::vector<Spring> edges =
          edge_springs(builder.model.mesh, body.first_tet, body.mesh.tet_count(), scene["stiffness"].number());
      builder.springs.insert(builder.springs.end(), edges.begin(), edges.end());
    }
  }
}

Vec3d traction_on(const Value& scene, const std::vector<Vec3d>& X, const Triangle& t) {
  const Vec3d center = (1.0 / 3) * (X[t[0]] + X[t[1]] + X[t[2]]);
  if (const Value* value = scene.find("value")) return at_place(*value, [&] { return VectorField(*value).at(center); });
  const Value& pressure = scene["pressure"];
  const double p = pressure.is_text() ? at_place(pressure, [&] { return Expression(pressure.text()).at(center); })
                                      : pressure.number();
  const Vec3d n = cross(X[t[1]] - X[t[0]], X[t[2]] - X[t[0]]);
  return (-p / std::sqrt(dot(n, n))) * n;
}

void add_tractions(const Builder& builder, const PlacedBody& body, std::vector<double>& force) {
  const Array& tractions = list_of(body, "traction");
  if (tractions.empty()) return;
  const std::vector<Triangle> boundary = boundary_triangles(body.mesh, 0, body.mesh.tet_count());
  const std::span<double> mine(force.data() + 3 * body.first_vertex, 3 * body.mesh.rest.size());
  for (const Value& scene : tractions)
    for (const Triangle& t : select_triangles(scene["where"], builder.scope(body), boundary))
      add_traction(body.mesh.rest, t, traction_on(scene, body.mesh.rest, t), mine);
}

void add_body_forces(const Builder& builder, const PlacedBody& body, std::vector<double>& force) {
  const std::span<double> mine(force.data() + 3 * body.first_vertex, 3 * body.mesh.rest.size());
  for (const Value& scene : list_of(body, "force")) {
    const VectorField density(scene["value"]);
    for (const int t : select_tets(scene["where"], builder.scope(body)))
      add_body_force(body.mesh, t, at_place(scene["value"], [&] { return density.at(centroid(body.mesh, t)); }), mine);
  }
}

void add_linear_load(Model& model, const char* name, std::vector<double> force) {
  if (std::any_of(force.begin(), force.end(), [](double f) { return f != 0; }))
    model.loads.push_back(make_linear_load(name, std::move(force)));
}

void add_gravity(Model& model, const Vec3d& gravity) {
  std::vector<double> force;
  for (const double mass : model.mass->vertex_mass())
    for (int r = 0; r < 3; ++r) force.push_back(mass * gravity[r]);
  add_linear_load(model, "gravity", std::move(force));
}

void add_loads(Builder& builder, const Vec3d& gravity) {
  add_gravity(builder.model, gravity);
  std::vector<double> per_volume(3 * builder.model.mesh.rest.size(), 0.0), per_area = per_volume;  // by user's numbers
  for (const PlacedBody& body : builder.bodies) {
    add_body_forces(builder, body, per_volume);
    add_tractions(builder, body, per_area);
    add_springs(builder, body);
  }
  Model& model = builder.model;
  add_linear_load(model, "body_force", model.numbering.vertex.from_user(per_volume, 3));
  add_linear_load(model, "traction", model.numbering.vertex.from_user(per_area, 3));
  if (!builder.point_springs.empty())
    model.loads.push_back(make_point_springs("point_springs", std::move(builder.point_springs)));
  if (!builder.springs.empty()) model.loads.push_back(make_springs("springs", std::move(builder.springs)));
}

void add_damping(PlacedBody& body, size_t index, MassKind kind, SceneFiles& files, Model& model) {
  Value& damping = *body.scene.table().find("damping");
  const double a = damping["mass"].number(), b = damping["stiffness"].number();
  if (a > 0 || b > 0) {
    std::vector<double> density(model.density.size(), 0.0);  // of this body alone
    const auto first = model.density.begin() + body.first_tet;
    std::copy(first, first + body.mesh.tet_count(), density.begin() + body.first_tet);
    model.damping.push_back(
        make_rayleigh_damping(MassMatrix(model.mesh, density, kind), a, model.elasticity[index].get(), b));
  }
  const std::vector<double> viscosity =
      tet_values(damping.table(), scene_schema().key("damping", "viscosity"), body.mesh, files, body.name());
  if (std::any_of(viscosity.begin(), viscosity.end(), [](double eta) { return eta > 0; }))
    model.damping.push_back(
        make_strain_rate_damping(model.mesh, body.first_tet, body.numbering.tet.from_user(viscosity)));
}

}  // namespace

void add_actions(std::vector<PlacedBody>& bodies, const Vec3d& gravity, MassKind mass, SceneFiles& files, Model& model,
                 std::vector<std::string>& notes) {
  const double g = std::sqrt(dot(gravity, gravity));
  Builder builder{bodies, g > 0 ? (-1 / g) * gravity : Vec3d{{0, 1, 0}}, model, notes, {}, {}};
  for (const PlacedBody& body : bodies) add_pins(builder, body);
  add_loads(builder, gravity);
  add_grabs(bodies, model);
  for (size_t i = 0; i < bodies.size(); ++i) add_damping(bodies[i], i, mass, files, model);
}

}  // namespace aspic

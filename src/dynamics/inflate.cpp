#include "dynamics/inflate.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/error.h"
#include "contact/barrier.h"
#include "dynamics/incremental_potential.h"
#include "dynamics/integrator.h"
#include "dynamics/simulation_checks.h"
#include "energy/tet_elasticity.h"
#include "math/vectors.h"
#include "mesh/box.h"
#include "mesh/tet_nodes.h"
#include "optimize/minimize.h"
#include "optimize/solver.h"

namespace aspic {
namespace {

constexpr double kSmallest = 1.0 / 64;  // minimum scale of bodies
constexpr double kShrink = 0.85;        // ratio of two successive scales
constexpr double kGrow = 1.1;           // the same while bodies grow
constexpr double kVolume = 0.9;         // minimum fraction of its volume that a body must regain
constexpr int kMaxSteps = 200;
constexpr double kAtRest = 1e-3;  // maximum displacement in a step at rest, relative to the radius of the model

// Returns why the surfaces overlap; nothing if they do not.
std::optional<std::string> overlap(const Model& model, const std::vector<double>& q) {
  try {
    State state;
    state.q = q;
    require_apart(model, state, make_integrator("backward_euler")->facts());
    return {};
  } catch (const InvalidInput& e) {
    return e.what();
  }
}

std::set<int> pinned_vertices(const Model& model) {
  std::set<int> pinned;
  for (const Pin& pin : model.pins) pinned.insert(pin.vertices.begin(), pin.vertices.end());
  return pinned;
}

std::vector<double> shrunk(const Model& model, const std::vector<double>& q, double scale) {
  const std::set<int> pinned = pinned_vertices(model);
  std::vector<double> x = q;
  for (const BodyRange& body : model.bodies) {
    const int end = body.first_vertex + body.vertex_count;
    if (const auto first = pinned.lower_bound(body.first_vertex); first != pinned.end() && *first < end) continue;
    Box box;
    for (int v = body.first_vertex; v < end; ++v) box.add(point(q, v));
    const Vec3d center = 0.5 * (box.lower + box.upper);
    for (int v = body.first_vertex; v < end; ++v)
      for (int r = 0; r < 3; ++r) x[3 * v + r] = center[r] + scale * (q[3 * v + r] - center[r]);
  }
  return x;
}

double signed_volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return dot(cross(b - a, c - a), d - a) / 6;
}

// Calls visit(tet) for the linear tets of a body.
template <class Visit>
void for_linear_tets(const LinearParts& parts, const BodyRange& body, const Visit& visit) {
  for (int p = 0; p < parts.mesh.tet_count(); ++p)
    if (parts.tet[p] >= body.first_tet && parts.tet[p] < body.first_tet + body.tet_count) visit(parts.mesh.tets[p]);
}

double volume_of(const LinearParts& parts, const BodyRange& body, const std::vector<double>& q) {
  double sum = 0;
  for_linear_tets(parts, body, [&](const Tet& tet) {
    sum += signed_volume(point(q, tet[0]), point(q, tet[1]), point(q, tet[2]), point(q, tet[3]));
  });
  return sum;
}

bool encloses(const LinearParts& parts, const BodyRange& body, const std::vector<double>& q, const Vec3d& x) {
  bool is_inside = false;
  for_linear_tets(parts, body, [&](const Tet& tet) {
    const Vec3d a = point(q, tet[0]), b = point(q, tet[1]), c = point(q, tet[2]), d = point(q, tet[3]);
    is_inside |= signed_volume(x, b, c, d) >= 0 && signed_volume(a, x, c, d) >= 0 && signed_volume(a, b, x, d) >= 0 &&
                 signed_volume(a, b, c, x) >= 0;
  });
  return is_inside;
}

// Rejects bodies inside of other bodies, whose surfaces do not intersect.
void require_outside(const Model& model, const std::vector<double>& q) {
  const LinearParts parts = linear_parts(model.mesh);
  for (const BodyRange& inner : model.bodies)
    for (const BodyRange& outer : model.bodies)
      if (&inner != &outer && encloses(parts, outer, q, point(q, inner.first_vertex)))
        throw InvalidInput("body '" + outer.name + "' encloses the center of body '" + inner.name +
                           "'; move one of them");
}

// Repeatedly minimizes 1/2 (x - q)' M (x - q) + h^2 V(x), where V is elasticity and contact, until x is at rest.
void settle(const Model& model, const std::vector<double>& start, std::vector<double>& q) {
  const Pins pins(model.pins, start);
  IncrementalPotential E(model, pins);
  const double radius = E.scales().x;
  double mass = 0;
  for (const double m : model.mass->vertex_mass()) mass += m;
  const double h2 = mass * radius * radius / E.growth_stiffness();  // square of a vibration period
  const std::unique_ptr<SearchDirection> direction = make_search_direction({});
  for (int step = 0; step < kMaxSteps; ++step) {
    const std::vector<double> before = q;
    E.set_potential_step({.start = before, .h = std::sqrt(h2), .time = 0, .obstacle_time = 0});
    E.begin_step(before, 1, h2);
    const MinimizeReport report = Minimizer().minimize(E, *direction, {q}, {.max_iterations = 100, .tolerance = 1e-3});
    if (!is_success(report.status)) return;
    double moved = 0;
    for (size_t i = 0; i < q.size(); ++i) moved = std::max(moved, std::abs(q[i] - before[i]));
    if (moved < kAtRest * radius) return;
  }
}

// Returns the model with bodies without pins at `scale` times their size, of a material that resists inversion. Mass
// and loads are left out.
Model at_scale(const Model& model, double scale) {
  Model scaled;
  scaled.mesh = model.mesh;
  const std::vector<double> rest = shrunk(model, at_rest(model.mesh).q, scale);
  for (int v = 0; v < model.mesh.vertex_count(); ++v) scaled.mesh.rest[v] = point(rest, v);
  scaled.bodies = model.bodies;
  scaled.pins = model.pins;
  scaled.contact = model.contact;
  for (size_t body = 0; body < model.elasticity.size(); ++body) {
    std::vector<MaterialParameters> parameters;
    for (const MaterialParameters& own : model.elasticity[body]->parameters()) parameters.push_back({own.lame});
    scaled.elasticity.push_back(
        make_tet_elasticity("neo_hookean_log", scaled.mesh, model.bodies[body].first_tet, parameters));
  }
  return scaled;
}

// Growth in small steps compresses bodies little: large compression would invert tets.
void grow(Model& model, double scale, const std::vector<double>& start, std::vector<double>& q) {
  while (scale < 1) {
    scale = std::min(1.0, kGrow * scale);
    Model scaled = at_scale(model, scale);
    const auto exchange = [&] {
      std::swap(scaled.mass, model.mass);
      std::swap(scaled.loads, model.loads);
    };
    exchange();
    settle(scaled, start, q);
    exchange();
  }
  settle(model, start, q);
}

}  // namespace

void inflate(Model& model, std::vector<double>& q) {
  std::optional<std::string> why = overlap(model, q);
  if (!model.contact || !why) return;
  const std::vector<double> start = q;
  double scale = 1;
  while (why && scale > kSmallest) {
    scale *= kShrink;
    why = overlap(model, q = shrunk(model, start, scale));
  }
  if (why) throw InvalidInput("shrinking does not separate the bodies: " + *why);
  require_outside(model, q);
  const auto other = std::stable_partition(model.loads.begin(), model.loads.end(),
                                           [&](const auto& load) { return load.get() == model.contact; });
  std::vector<std::unique_ptr<Energy>> loads(std::make_move_iterator(other),
                                             std::make_move_iterator(model.loads.end()));
  model.loads.erase(other, model.loads.end());
  std::vector<std::unique_ptr<Energy>> damping = std::exchange(model.damping, {});
  grow(model, scale, start, q);
  model.damping = std::move(damping);
  model.loads.insert(model.loads.begin(), std::make_move_iterator(loads.begin()), std::make_move_iterator(loads.end()));
  const LinearParts parts = linear_parts(model.mesh);
  for (const BodyRange& body : model.bodies) {
    const double share = volume_of(parts, body, q) / volume_of(parts, body, start);
    if (!(share > kVolume))
      throw InvalidInput("body '" + body.name + "' regains only " + std::to_string(int(100 * share)) +
                         " % of its volume: it is enclosed by other surfaces or collapsed; move it further away");
  }
  if ((why = overlap(model, q))) throw InvalidInput("bodies still overlap: " + *why);
}

}  // namespace aspic

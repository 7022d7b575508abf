#include "dynamics/inflate.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/error.h"
#include "contact/barrier.h"
#include "dynamics/settle.h"
#include "dynamics/state.h"
#include "energy/tet_elasticity.h"
#include "math/vectors.h"
#include "mesh/box.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

constexpr double kSmallest = 1.0 / 64;  // minimum scale of bodies
constexpr double kShrink = 0.85;        // ratio of two successive scales
constexpr double kGrow = 1.1;           // the same while bodies grow
constexpr double kVolume = 0.9;         // minimum fraction of its volume that a body must regain

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
  scaled.angle_rows = model.angle_rows;
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
  if (!model.mesh.sheet.empty()) throw InvalidInput(*why + " (sheets have no volume that could shrink)");
  const std::vector<double> start = q;
  double scale = 1;
  while (why && scale > kSmallest) {
    scale *= kShrink;
    why = overlap(model, q = shrunk(model, start, scale));
  }
  if (why) throw InvalidInput("shrinking does not separate the bodies: " + *why);
  without_other_terms(model, [&] { grow(model, scale, start, q); });
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

#include "fidelity.h"

#include <algorithm>
#include <cmath>

#include "base/formatted.h"
#include "bodies.h"
#include "mesh/components.h"
#include "mesh/surface.h"
#include "mesh/surface_orientation.h"
#include "mesh/tet_shape.h"
#include "triangle_tree.h"

namespace aspic {
namespace {

constexpr double kVolume = 0.1;    // largest relative error
constexpr double kMissed = 0.005;  // largest fraction of the surface

constexpr double kSearched = 8;  // times the allowed distance

// Visits a few thousand points of the surface with the areas that they represent.
template <class Visit>
void sample(const TriMesh& mesh, Visit visit) {
  constexpr double kPoints = 4000;
  double whole = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t) whole += area(mesh, t);
  double due = 0.5;  // samples still to be placed on the triangles so far
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const double part = area(mesh, t);
    const auto& [a, b, c] = mesh.triangles[t];
    due += kPoints * part / whole;
    const int count = static_cast<int>(due);
    due -= count;
    for (int i = 0; i < count; ++i) {  // a low-discrepancy sequence in the triangle [Roberts 2018]
      double u = std::fmod(0.5 + 0.7548776662466927 * (i + 1), 1.0),
             v = std::fmod(0.5 + 0.5698402909980532 * (i + 1), 1.0);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      visit((1 - u - v) * mesh.vertices[a] + u * mesh.vertices[b] + v * mesh.vertices[c], whole / kPoints);
    }
  }
}

}  // namespace

Fidelity fidelity(const TriMesh& body, const TetMesh& tets, double allowed) {
  Fidelity result{.volume = std::abs(enclosed_volume(body)), .filled = total_volume(tets)};
  result.parts = edge_connected_parts(body.triangles);
  result.filled_parts = static_cast<int>(tet_components(tets).size());
  const TriMesh boundary = boundary_surface(tets).surface;
  const TriangleTree to_boundary(boundary), to_body(body);
  const double reach = kSearched * allowed;
  double all = 0, far = 0;
  const auto add = [&](double distance) { result.distance = std::max(result.distance, std::min(distance, reach)); };
  sample(body, [&](const Vec3d& x, double part) {
    const double distance = to_boundary.distance(x, reach);
    add(distance);
    all += part;
    if (distance > allowed) far += part;
  });
  result.missed = all > 0 ? far / all : 0;
  const int stride = 1 + boundary.vertex_count() / 4000;
  for (int v = 0; v < boundary.vertex_count(); v += stride) add(to_body.distance(boundary.vertices[v], reach));
  return result;
}

std::string mismatch(const Fidelity& f, double allowed, double unit) {
  if (!(std::abs(f.filled - f.volume) <= kVolume * f.volume))
    return formatted("the tets fill %.3g %% of the volume inside the surface", 100 * f.filled / f.volume);
  if (f.filled_parts > f.parts)
    return formatted("the tets form %d parts but the surface has %d", f.filled_parts, f.parts);
  if (f.missed > kMissed)
    return formatted("%.2g %% of the surface is farther than %.3g from the tets", 100 * f.missed, allowed * unit);
  if (f.distance >= kSearched * allowed)
    return formatted("a point of the surface is %.3g or farther from the tets", f.distance * unit);
  return "";
}

}  // namespace aspic

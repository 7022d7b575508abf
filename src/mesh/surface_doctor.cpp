// Examination and repair of triangle meshes.
#include <algorithm>

#include "mesh/doctor.h"
#include "mesh/findings.h"
#include "mesh/self_intersection.h"
#include "mesh/surface_orientation.h"
#include "mesh/topology.h"
#include "mesh/triangle_shape.h"

namespace aspic {
namespace {

void examine_triangles(const TriMesh& mesh, Findings& findings) {
  std::vector<int> twice, thin;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    if (lists_vertex_twice(mesh.triangles[t]))
      twice.push_back(t);
    else if (is_degenerate({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}))
      thin.push_back(t);
  }
  const std::vector<int> repeated = repeated_elements(mesh.triangles);
  const size_t total = mesh.triangles.size();
  findings.add({Severity::error, "repeated_vertex_in_triangle",
                count_of(twice.size(), total, "triangles", "list a vertex twice"), "remove them with --repair", twice});
  findings.add({Severity::warning, "degenerate_triangles",
                count_of(thin.size(), total, "triangles", "have no area: their corners lie on a line"),
                "flip or collapse their edges in the source model", thin});
  findings.add({Severity::error, "repeated_triangles",
                count_of(repeated.size(), total, "triangles", "have the same vertices as an earlier one"),
                "remove them with --repair", repeated});
}

// Returns whether the sheets can be oriented; a Moebius strip cannot.
bool can_be_oriented(TriMesh mesh) {
  orient(mesh);
  return topology(mesh.triangles, mesh.vertex_count()).disagreeing.empty();
}

void examine_edges(const TriMesh& mesh, const SurfaceTopology& surface, Findings& findings) {
  const size_t total = mesh.triangles.size();
  findings.add(
      {Severity::error, "open_surface",
       "the surface is open: " + std::to_string(surface.open_edges) + " edges around " + std::to_string(surface.holes) +
           (surface.holes == 1 ? " hole" : " holes") + " belong to only one triangle (these triangles are listed)",
       "close the holes in the source model; aspic mesh --fill-holes closes small ones, aspic mesh --rebuild wraps "
       "the surface in a closed one",
       surface.open});
  findings.add(
      {Severity::error, "non_manifold_edges",
       std::to_string(surface.non_manifold_edges) +
           " edges are shared by more than two triangles (the triangles are listed)",
       "remove inner walls and extra triangles in the source model, or wrap the surface in a new one with aspic mesh "
       "--rebuild",
       surface.non_manifold});
  findings.add({Severity::warning, "non_manifold_vertices",
                count_of(surface.non_manifold_vertices.size(), mesh.vertices.size(), "vertices",
                         "connect sheets only at a point"),
                "separate or join the sheets in the source model", surface.non_manifold_vertices});
  const bool is_repairable = !surface.disagreeing.empty() && can_be_oriented(mesh);
  findings.add({Severity::error, "inconsistent_orientation",
                count_of(surface.disagreeing.size(), total, "triangles", "are oriented opposite to a neighbor"),
                is_repairable ? "flip them with --repair"
                              : "the sheet is one-sided, so --repair cannot orient it; cut it in the source model",
                surface.disagreeing});
}

void examine_intersections(const TriMesh& mesh, Findings& findings) {
  const auto [pairs, is_complete] = self_intersections(mesh);
  if (!is_complete)
    findings.add_general({Severity::warning, "crowded_triangles",
                          "too many triangles overlap in one place; not all pairs of them were compared",
                          "remove overlapping parts in the source model"});
  if (pairs.empty()) return;
  std::vector<int> triangles;
  for (const auto& pair : pairs) triangles.insert(triangles.end(), pair.begin(), pair.end());
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  findings.add({Severity::error, "self_intersections",
                "the surface intersects itself: " + std::to_string(pairs.size()) + " pairs of triangles, the first " +
                    std::to_string(pairs[0][0]) + " and " + std::to_string(pairs[0][1]),
                "separate the parts, or unite them in the source model or with aspic mesh --rebuild", triangles});
}

}  // namespace

std::vector<Finding> diagnose(const TriMesh& mesh) {
  Findings findings;
  if (!examine_vertices(mesh.vertices, mesh.triangles, "triangles", findings)) return findings.take();
  examine_triangles(mesh, findings);
  const SurfaceTopology surface = topology(mesh.triangles, mesh.vertex_count());
  examine_edges(mesh, surface, findings);
  const bool is_closed = surface.open.empty() && surface.non_manifold.empty() && surface.disagreeing.empty();
  if (is_closed && enclosed_volume(mesh) < 0)
    findings.add_general({Severity::warning, "inward_surface",
                          "the triangles face inward: the enclosed volume is negative", "flip them with --repair"});
  examine_intersections(mesh, findings);
  examine_components(mesh, findings);
  examine_units(mesh.vertices, findings);
  return findings.take();
}

}  // namespace aspic

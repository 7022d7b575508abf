// Examination and repair of triangle meshes.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/formatted.h"
#include "mesh/close_corners.h"
#include "mesh/disjoint_sets.h"
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

double area_of(const TriMesh& mesh, const Triangle& t) {
  const Vec3d& a = mesh.vertices[t[0]];
  return 0.5 * norm(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
}

// Whether all corners lie in the plane of the largest triangle, up to rounding.
bool is_planar(const TriMesh& mesh) {
  const Triangle& largest =
      *std::max_element(mesh.triangles.begin(), mesh.triangles.end(),
                        [&](const Triangle& a, const Triangle& b) { return area_of(mesh, a) < area_of(mesh, b); });
  const Vec3d& a = mesh.vertices[largest[0]];
  const Vec3d n = cross(mesh.vertices[largest[1]] - a, mesh.vertices[largest[2]] - a);
  const double most = corner_tolerance(mesh) * norm(n);
  return most > 0 && std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& triangle) {
           return std::all_of(triangle.begin(), triangle.end(),
                              [&](int v) { return std::abs(dot(n, mesh.vertices[v] - a)) <= most; });
         });
}

// Length of the longest group of connected open edges [m].
double longest_border(const TriMesh& mesh) {
  DisjointSets groups(mesh.vertex_count());
  std::vector<std::array<int, 2>> open;
  for_each_edge(edge_uses(mesh.triangles), [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first == 1) open.push_back(first->edge);
  });
  for (const auto& [a, b] : open) groups.join(a, b);
  std::vector<double> length(mesh.vertices.size(), 0);
  for (const auto& [a, b] : open) length[groups.find(a)] += norm(mesh.vertices[a] - mesh.vertices[b]);
  return *std::max_element(length.begin(), length.end());
}

// A disk has a squared border of 4 pi times its area, a bowl half of that, a closed surface with a hole less.
bool has_long_border(const TriMesh& mesh) {
  constexpr double kSquaredBorderPerArea = 10;
  double area = 0;
  for (const Triangle& triangle : mesh.triangles) area += area_of(mesh, triangle);
  const double border = longest_border(mesh);
  return border * border > kSquaredBorderPerArea * area;
}

TriMesh with_merged_corners(const TriMesh& mesh) {
  TriMesh merged = mesh;
  const std::vector<int> first = first_agreeing_corner(mesh);
  for (Triangle& triangle : merged.triangles)
    for (int& v : triangle) v = first[v];
  return merged;
}

void examine_open_edges(const TriMesh& mesh, const SurfaceTopology& surface, Findings& findings) {
  if (surface.open.empty()) return;
  const TriMesh merged = with_merged_corners(mesh);
  const char* const thicken =
      "give its body in a scene shell = { thickness = 0.001 }, or make it solid (in Blender: Solidify; in Gmsh: "
      "Extrude)";
  if (is_planar(mesh))
    return findings.add_general({Severity::error,
                                 "planar_mesh",
                                 "the mesh is planar: all vertices lie in a plane, and it encloses no volume",
                                 thicken,
                                 {}});
  if (has_long_border(merged))
    return findings.add_general(
        {Severity::error, "sheet", "the surface is a sheet: it encloses no volume", thicken, {}});
  Finding finding{
      Severity::error, "open_surface",
      "the surface is open: " + std::to_string(surface.open_edges) + " edges around " + std::to_string(surface.holes) +
          (surface.holes == 1 ? " hole" : " holes") + " belong to only one triangle (these triangles are listed)",
      "close the holes in the source model; aspic mesh --fill-holes closes small ones, aspic mesh --rebuild wraps "
      "the surface in a closed one; for cloth, set shell.thickness of the body",
      surface.open};
  const int left = topology(merged.triangles, merged.vertex_count()).open_edges;
  if (left < surface.open_edges) {
    finding.message += "; " + std::to_string(surface.open_edges - left) +
                       " of these edges agree with another one within 1e-6 of the diagonal, " +
                       three_digits(corner_tolerance(mesh)) + " m";
    finding.remedy =
        "merge their corners with --repair (aspic mesh does so)" + (left > 0 ? "; " + finding.remedy : std::string());
  }
  findings.add(std::move(finding));
}

void examine_edges(const TriMesh& mesh, const SurfaceTopology& surface, Findings& findings) {
  const size_t total = mesh.triangles.size();
  examine_open_edges(mesh, surface, findings);
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

bool is_sheet(const TriMesh& mesh) {
  const TriMesh merged = with_merged_corners(mesh);
  if (mesh.triangles.empty() || topology(merged.triangles, merged.vertex_count()).open.empty()) return false;
  return is_planar(mesh) || has_long_border(merged);
}

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

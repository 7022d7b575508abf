#include "mesh/doctor.h"

#include <algorithm>
#include <limits>

#include "mesh/box_tree.h"
#include "mesh/components.h"
#include "mesh/findings.h"
#include "mesh/order.h"
#include "mesh/surface.h"
#include "mesh/tet_shape.h"
#include "mesh/topology.h"

namespace aspic {
namespace {

constexpr double kSliverAngle = 5;  // [degrees]

struct TetShapes {
  std::vector<int> inverted, flat, slivers, repeated_vertex;
  int worst_inverted = -1, worst_sliver = -1;
  double most_negative = 0, smallest_angle = 180;
};

TetShapes tet_shapes(const TetMesh& mesh) {
  TetShapes shapes;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    if (lists_vertex_twice(mesh.tets[t])) {
      shapes.repeated_vertex.push_back(t);
      continue;
    }
    const TetCorners X = corners(mesh, t);
    const double volume = signed_volume(X);
    if (std::abs(volume) <= flat_volume(X)) {
      shapes.flat.push_back(t);
      continue;
    }
    if (volume < 0) {
      shapes.inverted.push_back(t);
      if (volume < shapes.most_negative) shapes.worst_inverted = t, shapes.most_negative = volume;
    }
    const auto [least, most] = dihedral_range(X);
    const double angle = std::min(least, 180 - most);
    if (angle >= kSliverAngle) continue;
    shapes.slivers.push_back(t);
    if (angle < shapes.smallest_angle) shapes.worst_sliver = t, shapes.smallest_angle = angle;
  }
  return shapes;
}

std::string histogram_text(const TetMesh& mesh) {
  std::string text;
  for (int count : quality(mesh).mean_ratio_histogram) text += (text.empty() ? "" : " ") + std::to_string(count);
  return text;
}

void examine_shapes(const TetMesh& mesh, Findings& findings) {
  const TetShapes shapes = tet_shapes(mesh);
  const size_t total = mesh.tets.size();
  findings.add({Severity::error, "repeated_vertex_in_tet",
                count_of(shapes.repeated_vertex.size(), total, "tets", "list a vertex twice and have no volume"),
                "remove them with --repair", shapes.repeated_vertex, true});
  findings.add({Severity::error, "zero_volume_tets",
                count_of(shapes.flat.size(), total, "tets", "have no volume: their corners lie in a plane"),
                "remove them with --repair, or mesh the shape anew", shapes.flat, true});
  findings.add({Severity::error, "inverted_tets",
                count_of(shapes.inverted.size(), total, "tets", "are inverted; the worst is tet ") +
                    std::to_string(shapes.worst_inverted) + " with volume " + number(shapes.most_negative) + " m^3",
                "turn them with --repair", shapes.inverted, true});
  if (shapes.slivers.empty()) return;
  findings.add({Severity::warning, "slivers",
                count_of(shapes.slivers.size(), total, "tets",
                         "are slivers (a dihedral angle within 5 degrees of 0 or 180); the worst is tet ") +
                    std::to_string(shapes.worst_sliver) + " with " + number(shapes.smallest_angle) +
                    " degrees; mean ratios by tenths: " + histogram_text(mesh),
                "mesh the shape anew with aspic mesh; slivers make the solver slow and the material stiff",
                shapes.slivers, false});
}

// Faces shared by more than two tets, and by two that lie on the same side of it.
void examine_faces(const TetMesh& mesh, Findings& findings) {
  constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  struct Use {
    Triangle face;
    int tet;
    bool even;  // the outward face is an even permutation of the sorted one
  };
  std::vector<Use> uses;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    if (lists_vertex_twice(mesh.tets[t])) continue;
    for (const auto& [i, j, k] : kFaces) {
      Triangle face = {mesh.tets[t][i], mesh.tets[t][j], mesh.tets[t][k]};
      const bool even = (face[0] < face[1]) + (face[1] < face[2]) + (face[2] < face[0]) == 2;
      std::sort(face.begin(), face.end());
      uses.push_back({face, t, even == (volume(mesh, t) > 0)});
    }
  }
  std::sort(uses.begin(), uses.end(),
            [](const Use& a, const Use& b) { return a.face != b.face ? a.face < b.face : a.tet < b.tet; });
  std::vector<int> crowded, folded;
  for (size_t begin = 0, end; begin < uses.size(); begin = end) {
    for (end = begin + 1; end < uses.size() && uses[end].face == uses[begin].face;) ++end;
    const bool is_folded = end - begin == 2 && uses[begin].even == uses[begin + 1].even;
    for (size_t i = begin; i < end; ++i) {
      if (end - begin > 2) crowded.push_back(uses[i].tet);
      if (is_folded) folded.push_back(uses[i].tet);
    }
  }
  for (std::vector<int>* list : {&crowded, &folded}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  findings.add({Severity::error, "non_manifold_faces",
                count_of(crowded.size(), mesh.tets.size(), "tets", "share a face with more than one other tet"),
                "remove the extra tets where the mesh was made", crowded, false});
  findings.add({Severity::warning, "folded_tets",
                count_of(folded.size(), mesh.tets.size(), "tets",
                         "lie on the same side of a face as their neighbour, so they overlap"),
                "mesh the shape anew", folded, false});
}

// Tets whose centroid lies inside another one: not every overlap shows in this way, but a doubled part does.
std::vector<int> overlapping_tets(const TetMesh& mesh) {
  constexpr double kInside = 1e-6;  // smallest barycentric weight that counts
  std::vector<Box> boxes(mesh.tets.size());
  std::vector<Vec3d> centres = centroids(mesh);
  for (size_t t = 0; t < boxes.size(); ++t)
    for (int v : mesh.tets[t]) boxes[t].add(mesh.rest[v]);
  const BoxTree tree(boxes);
  std::vector<int> overlapping;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    bool is_free = true;
    Box here;
    here.add(centres[t]);
    tree.for_each_overlap(here, [&](int other) {
      const TetCorners X = corners(mesh, other);
      if (other == t || std::abs(signed_volume(X)) <= flat_volume(X)) return true;
      const std::array<double, 4> w = barycentric(X, centres[t]);
      is_free = *std::min_element(w.begin(), w.end()) < kInside;
      return is_free;
    });
    if (!is_free) overlapping.push_back(t);
  }
  return overlapping;
}

void examine_boundary(const TetMesh& mesh, Findings& findings) {
  const std::vector<Triangle> triangles = boundary_triangles(mesh, 0, mesh.tet_count());
  const SurfaceTopology surface = topology(triangles, mesh.vertex_count());
  std::vector<int> on_edges;
  for (int t : surface.non_manifold) on_edges.insert(on_edges.end(), triangles[t].begin(), triangles[t].end());
  std::sort(on_edges.begin(), on_edges.end());
  on_edges.erase(std::unique(on_edges.begin(), on_edges.end()), on_edges.end());
  findings.add({Severity::warning, "non_manifold_edges",
                std::to_string(surface.non_manifold_edges) +
                    " edges of the boundary have more than two boundary triangles: parts hang together by an edge, as "
                    "by a hinge (the vertices of these triangles are listed)",
                "join or separate the parts where the mesh was made", on_edges, false});
  findings.add({Severity::warning, "non_manifold_vertices",
                count_of(surface.non_manifold_vertices.size(), mesh.rest.size(), "vertices",
                         "join parts that touch there only, as by a ball joint"),
                "join or separate the parts where the mesh was made", surface.non_manifold_vertices, false});
}

}  // namespace

std::vector<Finding> diagnose(const TetMesh& mesh) {
  Findings findings;
  if (!examine_vertices(mesh.rest, mesh.tets, "tets", findings)) return findings.take();
  examine_shapes(mesh, findings);
  const std::vector<int> repeated = repeated_elements(mesh.tets);
  findings.add({Severity::error, "repeated_tets",
                count_of(repeated.size(), mesh.tets.size(), "tets", "have the same vertices as an earlier one"),
                "remove them with --repair", repeated, true});
  examine_faces(mesh, findings);
  const std::vector<int> overlapping = overlapping_tets(mesh);
  findings.add({Severity::warning, "overlapping_tets",
                count_of(overlapping.size(), mesh.tets.size(), "tets", "have their centroid inside another tet"),
                "mesh the shape anew", overlapping, false});
  examine_boundary(mesh, findings);
  examine_components(tet_components(mesh), "tets", findings);
  examine_units(mesh.rest, findings);
  return findings.take();
}

bool has_errors(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& f) { return f.severity == Severity::error; });
}

}  // namespace aspic

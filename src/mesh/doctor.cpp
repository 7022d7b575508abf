#include "mesh/doctor.h"

#include <algorithm>

#include "base/formatted.h"
#include "base/parallel.h"
#include "mesh/box_tree.h"
#include "mesh/components.h"
#include "mesh/findings.h"
#include "mesh/grouped_elements.h"
#include "mesh/order.h"
#include "mesh/self_intersection.h"
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

double distance_to_flat(const TetCorners& X) {  // [degrees]
  const auto [least, most] = dihedral_range(X);
  return std::min(least, 180 - most);
}

bool is_sound(const TetMesh& mesh, int tet) {
  if (lists_vertex_twice(mesh.tets[tet])) return false;
  const TetCorners X = corners(mesh, tet);
  return signed_volume(X) > flat_volume(X) && distance_to_flat(X) >= kSliverAngle;
}

void add_unsound(const TetMesh& mesh, int t, TetShapes& shapes) {
  if (lists_vertex_twice(mesh.tets[t])) return shapes.repeated_vertex.push_back(t);
  const TetCorners X = corners(mesh, t);
  const double volume = signed_volume(X);
  if (std::abs(volume) <= flat_volume(X)) return shapes.flat.push_back(t);
  if (volume < 0) {
    shapes.inverted.push_back(t);
    if (volume < shapes.most_negative) shapes.worst_inverted = t, shapes.most_negative = volume;
  }
  const double angle = distance_to_flat(X);
  if (angle >= kSliverAngle) return;
  shapes.slivers.push_back(t);
  if (angle < shapes.smallest_angle) shapes.worst_sliver = t, shapes.smallest_angle = angle;
}

TetShapes tet_shapes(const TetMesh& mesh) {
  std::vector<char> sound(mesh.tets.size());
  parallel_chunks(mesh.tet_count(), [&](int first, int last) {
    for (int t = first; t < last; ++t) sound[t] = is_sound(mesh, t);
  });
  TetShapes shapes;
  for (int t = 0; t < mesh.tet_count(); ++t)
    if (!sound[t]) add_unsound(mesh, t, shapes);
  return shapes;
}

std::string histogram_text(const TetMesh& mesh) {
  std::string text;
  for (int count : quality(mesh).mean_ratio_histogram) text += (text.empty() ? "" : " ") + std::to_string(count);
  return text;
}

// Returns whether all tets have a positive volume.
bool examine_shapes(const TetMesh& mesh, Findings& findings) {
  const TetShapes shapes = tet_shapes(mesh);
  const size_t total = mesh.tets.size();
  findings.add({Severity::error, "repeated_vertex_in_tet",
                count_of(shapes.repeated_vertex.size(), total, "tets", "list a vertex twice and have no volume"),
                "remove them with --repair", shapes.repeated_vertex});
  findings.add({Severity::error, "zero_volume_tets",
                count_of(shapes.flat.size(), total, "tets", "have no volume: their corners lie in a plane"),
                "remove them with --repair, or remesh the shape", shapes.flat});
  findings.add({Severity::error, "inverted_tets",
                count_of(shapes.inverted.size(), total, "tets", "are inverted; the worst is tet ") +
                    std::to_string(shapes.worst_inverted) + " with volume " + three_digits(shapes.most_negative) +
                    " m^3",
                "flip them with --repair", shapes.inverted});
  if (!shapes.slivers.empty())
    findings.add({Severity::warning, "slivers",
                  count_of(shapes.slivers.size(), total, "tets",
                           "are slivers (a dihedral angle within 5 degrees of 0 or 180); the worst is tet ") +
                      std::to_string(shapes.worst_sliver) + " with " + three_digits(shapes.smallest_angle) +
                      " degrees; mean ratios by tenths: " + histogram_text(mesh),
                  "remesh the shape with aspic mesh; slivers make the solver slow and the material stiff",
                  shapes.slivers});
  return shapes.repeated_vertex.empty() && shapes.flat.empty() && shapes.inverted.empty();
}

// Finds faces shared by more than two tets, or by two tets on the same side. Returns whether there are none.
bool examine_faces(const TetMesh& mesh, Findings& findings) {
  constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  const auto face = [&](int place) {
    const auto& [i, j, k] = kFaces[place % 4];
    const Tet& tet = mesh.tets[place / 4];
    return Triangle{tet[i], tet[j], tet[k]};
  };
  // An outward face is an even permutation of the sorted face.
  const auto is_even = [&](int place) {
    const auto [a, b, c] = face(place);
    return ((a < b) + (b < c) + (c < a) == 2) == (volume(mesh, place / 4) > 0);
  };
  const auto faces = grouped_elements<3>(mesh.vertex_count(), [&](const auto& visit) {
    for (int t = 0; t < mesh.tet_count(); ++t)
      for (int place = 4 * t; place < 4 * (t + 1) && !lists_vertex_twice(mesh.tets[t]); ++place)
        visit(face(place), place);
  });
  std::vector<int> crowded, folded;
  for_each_group(faces, [&](const GroupedElement<3>* begin, const GroupedElement<3>* end) {
    const bool is_folded = end - begin == 2 && is_even(begin[0].place) == is_even(begin[1].place);
    for (const GroupedElement<3>* use = begin; use < end; ++use) {
      if (end - begin > 2) crowded.push_back(use->place / 4);
      if (is_folded) folded.push_back(use->place / 4);
    }
  });
  for (std::vector<int>* list : {&crowded, &folded}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  findings.add({Severity::error, "non_manifold_faces",
                count_of(crowded.size(), mesh.tets.size(), "tets", "share a face with more than one other tet"),
                "remove the extra tets in the program that made the mesh", crowded});
  findings.add({Severity::warning, "folded_tets",
                count_of(folded.size(), mesh.tets.size(), "tets",
                         "lie on the same side of a face as their neighbor, so they overlap"),
                "remesh the shape with aspic mesh", folded});
  return crowded.empty() && folded.empty();
}

// Finds tets whose centroid is inside another tet. This misses some overlaps, but finds duplicated parts.
std::vector<int> overlapping_tets(const TetMesh& mesh) {
  constexpr double kInside = 1e-6;   // smallest barycentric weight that counts
  constexpr size_t kMaxNear = 4096;  // maximum tets near a few others, because a pile of tets would need all pairs
  std::vector<Box> boxes(mesh.tets.size());
  const std::vector<Vec3d> centers = centroids(mesh);
  for (size_t t = 0; t < boxes.size(); ++t)
    for (int v : mesh.tets[t]) boxes[t].add(mesh.rest[v]);
  const BoxTree tree(boxes);
  const auto holds = [&](int tet, const Vec3d& x) {
    const TetCorners X = corners(mesh, tet);
    const std::array<double, 4> w = barycentric(X, x);  // undefined for a flat tet
    const bool is_inside = std::all_of(w.begin(), w.end(), [](double wi) { return wi >= kInside; });
    return is_inside && std::abs(signed_volume(X)) > flat_volume(X);
  };
  std::vector<char> is_held(mesh.tets.size(), 0);
  // Returns false if too many tets are near, so that each must be examined alone.
  const auto examine = [&](std::span<const int> tets, std::vector<int>& near) {
    Box here;
    for (const int t : tets) here.add(centers[t]);
    near.clear();
    tree.for_each_overlap(here, [&](int other) {
      near.push_back(other);
      return near.size() < kMaxNear;
    });
    if (near.size() == kMaxNear && tets.size() > 1) return false;
    for (const int t : tets)
      is_held[t] = std::any_of(near.begin(), near.end(), [&](int other) {
        return other != t && boxes[other].contains(centers[t]) && holds(other, centers[t]);
      });
    return true;
  };
  parallel_chunks(mesh.tet_count(), [&](int first, int last) {
    constexpr int kTogether = 16;  // neighbors share the path through the tree
    std::vector<int> near;
    for (int i = first; i < last; i += kTogether) {
      const auto tets = tree.items().subspan(i, std::min(kTogether, last - i));
      if (examine(tets, near)) continue;
      for (size_t k = 0; k < tets.size(); ++k) examine(tets.subspan(k, 1), near);
    }
  });
  std::vector<int> overlapping;
  for (int t = 0; t < mesh.tet_count(); ++t)
    if (is_held[t]) overlapping.push_back(t);
  return overlapping;
}

void examine_overlaps(const TetMesh& mesh, Findings& findings) {
  const std::vector<int> overlapping = overlapping_tets(mesh);
  findings.add({Severity::warning, "overlapping_tets",
                count_of(overlapping.size(), mesh.tets.size(), "tets", "have their centroid inside another tet"),
                "remesh the shape with aspic mesh", overlapping});
}

void examine_boundary(const BoundarySurface& boundary, const SurfaceTopology& topology, int vertices,
                      Findings& findings) {
  const auto in_mesh = [&](int v) { return boundary.tet_vertex[v]; };
  std::vector<int> on_edges, at_points;
  for (const int t : topology.non_manifold)
    for (const int v : boundary.surface.triangles[t]) on_edges.push_back(in_mesh(v));
  for (const int v : topology.non_manifold_vertices) at_points.push_back(in_mesh(v));
  std::sort(on_edges.begin(), on_edges.end());
  on_edges.erase(std::unique(on_edges.begin(), on_edges.end()), on_edges.end());
  findings.add(
      {Severity::warning, "non_manifold_edges",
       std::to_string(topology.non_manifold_edges) +
           " edges of the boundary have more than two boundary triangles: parts are connected only by an edge, "
           "like a hinge (the vertices of these triangles are listed)",
       "join or separate the parts in the source model", on_edges});
  findings.add({Severity::warning, "non_manifold_vertices",
                count_of(at_points.size(), static_cast<size_t>(vertices), "vertices",
                         "connect parts only at a point, like a ball joint"),
                "join or separate the parts in the source model", at_points});
}

// Whether the closed surface is a manifold without self-intersections. A connected mesh of tets of positive volume that
// lie on opposite sides of their common faces then covers each point at most once: the number of tets at a point is
// constant away from the boundary, changes by one across it, and is zero outside.
bool is_embedded(const TriMesh& surface, const SurfaceTopology& topology) {
  if (topology.non_manifold_edges > 0 || !topology.non_manifold_vertices.empty()) return false;
  const std::vector<int> first = first_at_same_place(surface.vertices);
  for (int v = 0; v < surface.vertex_count(); ++v)
    if (first[v] != v) return false;
  const SelfIntersections intersections = self_intersections(surface, 1);
  return intersections.pairs.empty() && intersections.is_complete;
}

}  // namespace

std::vector<Finding> diagnose(const TetMesh& mesh) {
  Findings findings;
  if (!examine_vertices(mesh.rest, mesh.tets, "tets", findings)) return findings.take();
  const bool are_positive = examine_shapes(mesh, findings);
  const std::vector<int> repeated = repeated_elements(mesh.tets);
  findings.add({Severity::error, "repeated_tets",
                count_of(repeated.size(), mesh.tets.size(), "tets", "have the same vertices as an earlier one"),
                "remove them with --repair", repeated});
  const bool do_faces_agree = examine_faces(mesh, findings);
  const BoundarySurface boundary = boundary_surface(mesh);
  const SurfaceTopology boundary_topology = topology(boundary.surface.triangles, boundary.surface.vertex_count());
  const auto parts = tet_components(mesh);
  const bool is_simple = are_positive && do_faces_agree && parts.size() == 1 && mesh.mids.empty();
  if (!is_simple || !is_embedded(boundary.surface, boundary_topology)) examine_overlaps(mesh, findings);
  examine_boundary(boundary, boundary_topology, mesh.vertex_count(), findings);
  examine_components(mesh, parts, findings);
  examine_units(mesh.rest, findings);
  return findings.take();
}

bool has_errors(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& f) { return f.severity == Severity::error; });
}

}  // namespace aspic

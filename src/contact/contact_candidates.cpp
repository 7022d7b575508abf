#include "contact/contact_candidates.h"

#include <algorithm>
#include <numeric>

#include "mesh/distance.h"

namespace aspic {
namespace {

// Accepts pairs within one body, or between a body and any other part.
class PartFilter : public PairFilter {
 public:
  PartFilter(const ContactMesh& mesh, bool within_parts) : mesh_(mesh), within_parts_(within_parts) {}
  bool accepts_vertex_triangle(int p, int t) const override { return accepts(p, mesh_.triangles[t][0]); }
  bool accepts_edge_edge(int a, int b) const override { return accepts(mesh_.edges[a][0], mesh_.edges[b][0]); }

 private:
  bool accepts(int p, int q) const {
    return (mesh_.part[p] == mesh_.part[q]) == within_parts_ && (mesh_.row[p] >= 0 || mesh_.row[q] >= 0);
  }
  const ContactMesh& mesh_;
  bool within_parts_;
};

SurfacePrimitives primitives_of(const ContactMesh& mesh) {
  SurfacePrimitives primitives{
      .vertices = std::vector<int>(mesh.rest.size()), .edges = mesh.edges, .triangles = mesh.triangles};
  std::iota(primitives.vertices.begin(), primitives.vertices.end(), 0);
  return primitives;
}

}  // namespace

CandidateFinder::CandidateFinder(const ContactMesh& mesh, const ContactLaws& laws)
    : mesh_(mesh),
      laws_(laws),
      finder_(primitives_of(mesh)),
      point_radius_(mesh.rest.size(), laws.largest_reach()),
      edge_radius_(mesh.edges.size(), kEdgeReach * laws.largest_reach() / 2) {}

// At most half the distance at rest within a body, whose own edges must not repel each other at rest.
double CandidateFinder::reach_of(const Edge& a, const Edge& b) const {
  const int i = mesh_.part[a[0]], j = mesh_.part[b[0]];
  const double reach = kEdgeReach * laws_(i, j).reach;
  if (i != j) return reach;
  const auto& X = mesh_.rest;
  return std::min(reach, pair_distance(PairKind::edge_edge, {X[a[0]], X[a[1]], X[b[0]], X[b[1]]}).d / 2);
}

bool CandidateFinder::add(const std::vector<Box>& boxes, bool within_parts, ClosePairs& all) {
  const PartFilter filter(mesh_, within_parts);
  const ClosePairs found = finder_.find({.path = boxes,
                                         .vertex_radius = point_radius_,
                                         .edge_radius = edge_radius_,
                                         .triangle_radius = {},
                                         .filter = &filter});
  const auto append = [](const auto& more, auto& to) { to.insert(to.end(), more.begin(), more.end()); };
  append(found.vertex_triangle, all.vertex_triangle);
  append(found.edge_edge, all.edge_edge);
  return found.is_complete;
}

std::optional<ContactCandidates> CandidateFinder::find(ContactRange range) {
  ContactCandidates candidates{.range = std::move(range)};
  ClosePairs pairs;
  if (!add(candidates.range.relative, true, pairs) || !add(candidates.range.absolute, false, pairs)) return {};
  std::sort(pairs.vertex_triangle.begin(), pairs.vertex_triangle.end());
  std::sort(pairs.edge_edge.begin(), pairs.edge_edge.end());
  candidates.triangle_start.assign(mesh_.rest.size() + 1, 0);
  for (const auto& [p, t] : pairs.vertex_triangle) {
    ++candidates.triangle_start[p + 1];
    candidates.triangle.push_back(t);
  }
  std::partial_sum(candidates.triangle_start.begin(), candidates.triangle_start.end(),
                   candidates.triangle_start.begin());
  candidates.edge_pairs.reserve(pairs.edge_edge.size());
  for (const auto& [a, b] : pairs.edge_edge)
    candidates.edge_pairs.push_back({a, b, reach_of(mesh_.edges[a], mesh_.edges[b])});
  return candidates;
}

bool ContactCandidates::cover(const ContactMesh& mesh, std::span<const Vec3d> points) const {
  const std::vector<Vec3d> relative = relative_to_parts(mesh, points);
  for (size_t p = 0; p < points.size(); ++p)
    if (!range.absolute[p].contains(points[p]) || !range.relative[p].contains(relative[p])) return false;
  return true;
}

std::vector<Vec3d> relative_to_parts(const ContactMesh& mesh, std::span<const Vec3d> points) {
  std::vector<Vec3d> relative(points.begin(), points.end());
  for (const ContactPart& part : mesh.parts) {
    const auto own = std::span(relative).subspan(part.first_point, part.point_count);
    Vec3d mean{};
    for (const Vec3d& x : own) mean = mean + (1.0 / part.point_count) * x;
    for (Vec3d& x : own) x = x - mean;
  }
  return relative;
}

}  // namespace aspic

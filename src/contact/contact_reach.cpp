#include "contact/contact_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "base/formatted.h"
#include "contact/contact_candidates.h"
#include "mesh/distance.h"

namespace aspic {
namespace {

constexpr double kPerGap = 1.0 / 5;         // reach relative to the gap at the start
constexpr double kPerThickness = 1.0 / 10;  // reach relative to the thickness of a part
constexpr double kPerTouching = 1.0 / 50;   // reach of touching surfaces relative to that of others
constexpr double kThinArea = 1.0 / 20;      // fraction of the area of a part that may be thinner than its thickness
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_pair_of_obstacles(const ContactMesh& mesh, int a, int b) {
  return mesh.parts[a].is_obstacle && mesh.parts[b].is_obstacle;
}

// Visits every pair of parts of which at least one is a body, with ascending numbers.
template <class Visit>
void for_pairs(const ContactMesh& mesh, const Visit& visit) {
  const int parts = static_cast<int>(mesh.parts.size());
  for (int a = 0; a < parts; ++a)
    for (int b = a; b < parts; ++b)
      if (!is_pair_of_obstacles(mesh, a, b)) visit(a, b);
}

// Smallest gap of each pair of parts, as far as it is below the reach of `laws`; otherwise infinity.
class Gaps {
 public:
  Gaps(const ContactMesh& mesh, std::span<const Vec3d> start, const ContactLaws& laws)
      : mesh_(mesh), gap_(mesh.parts.size() * mesh.parts.size(), kInfinity) {
    const auto found = CandidateSearch(PairScope::between_parts, mesh, laws).along(start, {});
    if (!found) throw std::length_error("contact: too many features are close to each other at the start");
    for (const auto& [p, t, gap] : found->pairs->triangles)
      add(mesh.part[p], mesh.part[mesh.triangles[t][0]], gap, laws);
    for (const auto& [a, b, gap] : found->pairs->edge_pairs)
      add(mesh.part[mesh.edges[a][0]], mesh.part[mesh.edges[b][0]], gap, laws);
    for (const ContactPlane& plane : mesh.planes)
      for (int p = 0; p < mesh.point_count(); ++p)
        if (mesh.row[p] >= 0) add(mesh.part[p], plane.part, dot(plane.normal, start[p] - start[plane.point]), laws);
  }
  double operator()(int a, int b) const { return gap_[std::min(a, b) * mesh_.parts.size() + std::max(a, b)]; }

 private:
  void add(int a, int b, double distance, const ContactLaws& laws) {
    double& gap = gap_[std::min(a, b) * mesh_.parts.size() + std::max(a, b)];
    gap = std::min(gap, distance - laws(a, b).offset);
  }

  const ContactMesh& mesh_;
  std::vector<double> gap_;
};

void reduce(ContactLaws& laws, const std::array<int, 2>& pair, double fraction, ReachBasis basis, double length) {
  for (ContactLaw* law : {&laws(pair[0], pair[1]), &laws(pair[1], pair[0])}) {
    if (!(fraction * length < law->reach)) continue;
    law->edge_reach *= fraction * length / law->reach;
    law->reach = fraction * length;
    law->basis = basis;
    law->length = length;
  }
}

// The vertices and triangles of a part.
SurfacePrimitives primitives_of(const ContactMesh& mesh, int part) {
  SurfacePrimitives primitives{.vertices = std::vector<int>(mesh.parts[part].point_count)};
  std::iota(primitives.vertices.begin(), primitives.vertices.end(), mesh.parts[part].first_point);
  for (const Triangle& t : mesh.triangles)
    if (mesh.part[t[0]] == part) primitives.triangles.push_back(t);
  return primitives;
}

Vec3d area_vector(const ContactMesh& mesh, const Triangle& t) {
  return 0.5 * cross(mesh.rest[t[1]] - mesh.rest[t[0]], mesh.rest[t[2]] - mesh.rest[t[0]]);
}

// Accepts a vertex and a triangle on opposite sides of a solid.
class Opposite : public PairFilter {
 public:
  Opposite(const ContactMesh& mesh, const ContactPart& part, std::span<const Triangle> triangles, double limit)
      : mesh_(mesh), part_(part), triangles_(triangles), limit_(limit), normal_(part.point_count) {
    for (const Triangle& t : triangles) {
      const Vec3d area = area_vector(mesh, t);
      for (const int p : t) normal_[p - part.first_point] = normal_[p - part.first_point] + area;
    }
  }
  // Returns the distance of a vertex to a triangle on the opposite side; infinity: another triangle.
  double thickness(int vertex, int triangle) const {
    constexpr double kAcross = 0.5;  // least cosine between the way through the solid and the normal where it ends
    const Triangle& t = triangles_[triangle];
    const auto& X = mesh_.rest;
    const Distance distance = point_triangle_distance({X[part_.first_point + vertex], X[t[0]], X[t[1]], X[t[2]]});
    const Vec3d area = area_vector(mesh_, t), own = normal_[vertex];
    const bool is_across = -dot(distance.r, area) > kAcross * distance.d * norm(area);
    const bool is_opposite = -dot(own, area) > kAcross * norm(own) * norm(area);
    return is_across && is_opposite ? distance.d : kInfinity;
  }
  bool accepts_vertex_triangle(int vertex, int triangle) const override { return thickness(vertex, triangle) < limit_; }
  bool accepts_edge_edge(int, int) const override { return false; }

 private:
  const ContactMesh& mesh_;
  const ContactPart& part_;
  std::span<const Triangle> triangles_;
  double limit_;
  std::vector<Vec3d> normal_;
};

}  // namespace

double least_thickness(const ContactMesh& mesh, int part, double limit) {
  const ContactPart& own = mesh.parts[part];
  if (own.is_round) return 2 * own.offset < limit ? 2 * own.offset : kInfinity;
  const SurfacePrimitives primitives = primitives_of(mesh, part);
  if (primitives.triangles.empty()) return kInfinity;
  const std::vector<double> radius(std::max(primitives.vertices.size(), primitives.triangles.size()), limit / 2);
  const Opposite opposite(mesh, own, primitives.triangles, limit);
  PairQuery query{.x = mesh.rest, .filter = &opposite};
  query.vertex_radius = std::span(radius).first(primitives.vertices.size());
  query.triangle_radius = std::span(radius).first(primitives.triangles.size());
  PairFinder finder(primitives);
  const ClosePairs pairs = finder.find(query);
  std::vector<double> thickness(own.point_count, kInfinity);
  for (const auto& [v, t] : pairs.vertex_triangle) thickness[v] = std::min(thickness[v], opposite.thickness(v, t));
  std::vector<int> order(own.point_count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return thickness[a] != thickness[b] ? thickness[a] < thickness[b] : a < b; });
  double total = 0, thinner = 0;
  for (int v = 0; v < own.point_count; ++v) total += mesh.area[own.first_point + v];
  for (const int v : order)
    if ((thinner += mesh.area[own.first_point + v]) > kThinArea * total) return thickness[v];
  return kInfinity;
}

double allowed_self_offset(const ContactMesh& mesh, int part, double thickness) {
  constexpr double kPerDistance = 0.4;
  SurfacePrimitives primitives = primitives_of(mesh, part);
  for (const Edge& edge : mesh.edges)
    if (mesh.part[edge[0]] == part) primitives.edges.push_back(edge);
  const size_t most = std::max({primitives.vertices.size(), primitives.edges.size(), primitives.triangles.size()});
  const std::vector<double> radius(most, thickness / kPerDistance / 2);
  PairQuery query{.x = mesh.rest};
  query.vertex_radius = std::span(radius).first(primitives.vertices.size());
  query.edge_radius = std::span(radius).first(primitives.edges.size());
  query.triangle_radius = std::span(radius).first(primitives.triangles.size());
  PairFinder finder(primitives);
  const ClosePairs pairs = finder.find(query);
  if (!pairs.is_complete) throw std::length_error("contact: the thickness of a sheet is far above its edges");
  const auto& X = mesh.rest;
  double least = thickness / kPerDistance;
  for (const auto& [v, t] : pairs.vertex_triangle) {
    const auto& [a, b, c] = primitives.triangles[t];
    least = std::min(least, point_triangle_distance({X[primitives.vertices[v]], X[a], X[b], X[c]}).d);
  }
  for (const auto& [e, f] : pairs.edge_edge) {
    const Edge &a = primitives.edges[e], &b = primitives.edges[f];
    least = std::min(least, edge_edge_distance({X[a[0]], X[a[1]], X[b[0]], X[b[1]]}).d);
  }
  return kPerDistance * least;
}

double touching_reach(const ContactLaw& law) { return kPerTouching * law.widest; }

void bound_reaches(const ContactMesh& mesh, std::span<const Vec3d> start,
                   const std::set<std::array<int, 2>>& overlapping, ContactLaws& laws) {
  std::vector<double> thickness;
  for (int part = 0; part < static_cast<int>(mesh.parts.size()); ++part) {
    double widest = 0;
    for (int other = 0; other < static_cast<int>(mesh.parts.size()); ++other)
      widest = std::max(widest, laws(part, other).reach);
    thickness.push_back(least_thickness(mesh, part, widest / kPerThickness));
  }
  ContactLaws wide = laws;
  for_pairs(mesh, [&](int a, int b) {
    for (ContactLaw* law : {&wide(a, b), &wide(b, a)}) law->edge_reach = law->reach = laws(a, b).reach / kPerGap;
  });
  const Gaps gaps(mesh, start, wide);
  for_pairs(mesh, [&](int a, int b) {
    for (const int part : {a, b}) reduce(laws, {a, b}, kPerThickness, ReachBasis::thickness, thickness[part]);
    if (a == b || overlapping.count({a, b}) > 0) return;
    if (gaps(a, b) <= kTouching * laws(a, b).edge)
      reduce(laws, {a, b}, kPerTouching, ReachBasis::touching, laws(a, b).widest);
    else
      reduce(laws, {a, b}, kPerGap, ReachBasis::gap, gaps(a, b));
  });
}

std::string reason_of(const ContactLaw& law) {
  const std::string length = formatted("%.3g", law.length) + " m";
  switch (law.basis) {
    case ReachBasis::given:
      return "contact.reach";
    case ReachBasis::edge:
      return formatted("1/%.0f", law.length / law.reach) + " of the mean edge of the finer surface";
    case ReachBasis::gap:
      return "a fifth of their gap at the start, " + length;
    case ReachBasis::touching:
      return "they touch at the start; 1/50 of the reach of other surfaces, " + length;
    case ReachBasis::thickness:
      return "a tenth of the thickness of the thinner one, " + length;
  }
  return "";
}

}  // namespace aspic

#include "viewer/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "mesh/box.h"
#include "mesh/surface.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"
#include "mesh/topology.h"
#include "mesh/triangle_shape.h"

namespace aspic::viewer {
namespace {

// Incident elements of each vertex.
struct Incidence {
  std::vector<int> start;    // one entry per vertex, and the end; empty: not built yet
  std::vector<int> element;  // elements vertex by vertex, in the given order

  Incidence() = default;
  Incidence(int vertex_count, std::span<const std::pair<int, int>> vertex_and_element);
  bool is_made() const { return !start.empty(); }
  std::span<const int> around(int vertex) const {
    return std::span(element).subspan(start[vertex], start[vertex + 1] - start[vertex]);
  }
};

Incidence::Incidence(int vertex_count, std::span<const std::pair<int, int>> vertex_and_element)
    : start(vertex_count + 1, 0), element(vertex_and_element.size()) {
  for (const auto& [vertex, e] : vertex_and_element) ++start[vertex + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> next(start.begin(), start.end() - 1);
  for (const auto& [vertex, e] : vertex_and_element) element[next[vertex]++] = e;
}

Incidence tets_of_vertices(const TetMesh& mesh) {
  std::vector<std::pair<int, int>> pairs;
  pairs.reserve((mesh.mids.empty() ? 4 : 10) * mesh.tets.size());
  for (int t = 0; t < mesh.element_count(); ++t)
    for (const int v : nodes_of(mesh, t)) pairs.emplace_back(v, t);
  return {mesh.vertex_count(), pairs};
}

template <class Corners>
int tet_with(const TetMesh& mesh, const Incidence& tets, const Corners& corners) {
  for (const int t : tets.around(corners[0])) {
    const TetNodes tet = nodes_of(mesh, t);
    if (std::all_of(corners.begin(), corners.end(),
                    [&](int v) { return std::find(tet.begin(), tet.end(), v) != tet.end(); }))
      return t;
  }
  return tets.around(corners[0]).front();
}

// The linear tet itself, or the parts of a quadratic one.
TetMesh parts_of(const TetMesh& mesh, int tet) {
  TetMesh one{mesh.rest, {mesh.tets[tet]}, {}};
  if (is_quadratic(mesh, tet)) one.mids = {mesh.mids[tet]};
  return linear_parts(one).mesh;
}

Vec3d direction(const Vec3d& from, const Vec3d& to) {
  const Vec3d d = to - from;
  const double length = norm(d);
  return length > 0 ? (1 / length) * d : Vec3d{{1, 0, 0}};
}

// Rotates v by the smallest rotation from the unit vector s to the unit vector t.
Vec3d turned(const Vec3d& s, const Vec3d& t, const Vec3d& v) {
  const Vec3d c = cross(s, t);
  return dot(s, t) * v + cross(c, v) + (dot(c, v) / std::max(1 + dot(s, t), 1e-6)) * c;
}

// Adds a tube along the segments of rods: a ring of points at each vertex.
class TubeBuilder {
 public:
  TubeBuilder(const TetMesh& mesh, const Incidence& elements, Surface& surface)
      : mesh_(mesh), elements_(elements), surface_(surface), first_(mesh.rest.size(), -1), normal_(mesh.rest.size()) {}

  void add() {
    for (size_t s = 0; s < mesh_.rods.size(); ++s) {
      const auto& [a, b] = mesh_.rods[s];
      const double radius = mesh_.radius[s];
      if (first_[a] < 0) add_ring(a, any_normal(tangent(a)), radius);
      if (first_[b] < 0) add_ring(b, turned(tangent(a), tangent(b), normal_[a]), radius);
      const int element = mesh_.first_segment() + static_cast<int>(s);
      for (int k = 0; k < kSides; ++k) {
        const int next = (k + 1) % kSides, c = first_[a], d = first_[b];
        add_triangle({c + k, c + next, d + next}, element);
        add_triangle({c + k, d + next, d + k}, element);
      }
      for (int k = 1; k + 1 < kSides; ++k) {
        if (ends(a)[0] == a) add_triangle({first_[a], first_[a] + k + 1, first_[a] + k}, element);
        if (ends(b)[1] == b) add_triangle({first_[b], first_[b] + k, first_[b] + k + 1}, element);
      }
    }
  }

 private:
  static constexpr int kSides = 8;

  // Returns the vertices before and after a vertex; the vertex itself beyond an end.
  Segment ends(int v) const {
    Segment ends = {v, v};
    for (const int e : elements_.around(v)) {
      const auto& [a, b] = mesh_.segment(e);
      (a == v ? ends[1] : ends[0]) = a == v ? b : a;
    }
    return ends;
  }
  Vec3d tangent(int v) const { return direction(mesh_.rest[ends(v)[0]], mesh_.rest[ends(v)[1]]); }
  static Vec3d any_normal(const Vec3d& t) {
    const Vec3d n = cross(t, std::abs(t[0]) < 0.7 ? Vec3d{{1, 0, 0}} : Vec3d{{0, 1, 0}});
    return (1 / norm(n)) * n;
  }

  void add_ring(int v, const Vec3d& normal, double radius) {
    const Vec3d t = tangent(v), other = cross(t, normal);
    first_[v] = surface_.vertex_count();
    normal_[v] = normal;
    for (int k = 0; k < kSides; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSides;
      const Vec3d offset = (radius * std::cos(angle)) * normal + (radius * std::sin(angle)) * other;
      surface_.rest.push_back(mesh_.rest[v] + offset);
      surface_.carrier.push_back(Carrier::of_vertex(v));
      surface_.tube.push_back({v, ends(v)[0], ends(v)[1], t, offset});
      const std::span<const int> around = elements_.around(v);
      surface_.tets.insert(surface_.tets.end(), around.begin(), around.end());
      surface_.tets_start.push_back(static_cast<int>(surface_.tets.size()));
    }
  }
  void add_triangle(const Triangle& corners, int element) {
    surface_.triangles.push_back(corners);
    surface_.tet.push_back(element);
  }

  const TetMesh& mesh_;
  const Incidence& elements_;
  Surface& surface_;
  std::vector<int> first_;     // point of the ring of each vertex; -1: none
  std::vector<Vec3d> normal_;  // to the first point of the ring
};

void add_edges(Surface& surface) {
  for_each_edge(edge_uses(surface.triangles),
                [&](const EdgeUse* first, const EdgeUse*) { surface.edges.push_back(first->edge); });
}

}  // namespace

std::span<const int> Surface::tets_at(int vertex) const {
  return std::span(tets).subspan(tets_start[vertex], tets_start[vertex + 1] - tets_start[vertex]);
}

int Surface::anchor(int vertex) const { return carrier[vertex].nearest_vertex(); }

uint32_t Surface::user_number(int vertex, const Numbering& numbering) const {
  return is_fine ? kNoVertex : static_cast<uint32_t>(numbering.vertex.to_user(anchor(vertex)));
}

Vec3d TubePoint::position(std::span<const double> x) const {
  return point(x, vertex) + turned(tangent, direction(point(x, before), point(x, after)), offset);
}

Vec3d Surface::carried(int vertex, std::span<const double> field) const { return carrier[vertex].position(field); }

Vec3d Surface::position(int vertex, std::span<const double> x) const {
  const int place = vertex - first_of_tube();
  return place < 0 ? carried(vertex, x) : tube[place].position(x);
}

bool Surface::has_same_shape(const Surface& other) const {
  return rest.size() == other.rest.size() && triangles == other.triangles;
}

double size_of(const Surface& surface) {
  const Box box = bounding_box(surface.rest);
  return norm(box.upper - box.lower);
}

bool has_fine_skin(const Scene& scene) {
  for (const Skin& skin : scene.skins)
    for (const Carrier& carrier : skin.embedding.carriers)
      if (carrier.count > 1) return true;
  return false;
}

Surface fine_surface(const Scene& scene) {
  const TetMesh& mesh = scene.simulation.model().mesh;
  const Incidence tets = tets_of_vertices(mesh);
  Surface surface{.is_fine = true};
  for (const Skin& skin : scene.skins) {
    const int first = surface.vertex_count();
    surface.rest.insert(surface.rest.end(), skin.rest.vertices.begin(), skin.rest.vertices.end());
    for (const Triangle& t : skin.rest.triangles)
      surface.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    surface.carrier.insert(surface.carrier.end(), skin.embedding.carriers.begin(), skin.embedding.carriers.end());
  }
  for (int v = 0; v <= surface.vertex_count(); ++v) surface.tets_start.push_back(v);
  for (const Carrier& carrier : surface.carrier) surface.tets.push_back(tet_with(mesh, tets, carrier.vertices()));
  for (const Triangle& t : surface.triangles) surface.tet.push_back(surface.tets[t[0]]);
  TubeBuilder(mesh, tets, surface).add();
  add_edges(surface);
  return surface;
}

Surface boundary_of(const Model& model) {
  const Incidence tets = tets_of_vertices(model.mesh);
  BoundarySurface boundary = boundary_surface(model.mesh);
  Surface surface;
  surface.rest = std::move(boundary.surface.vertices);
  surface.triangles = std::move(boundary.surface.triangles);
  surface.tets_start.push_back(0);
  for (const int v : boundary.tet_vertex) {
    surface.carrier.push_back(Carrier::of_vertex(v));
    const std::span<const int> around = tets.around(v);
    surface.tets.insert(surface.tets.end(), around.begin(), around.end());
    surface.tets_start.push_back(static_cast<int>(surface.tets.size()));
  }
  for (const Triangle& t : surface.triangles) {
    const Triangle corners = {boundary.tet_vertex[t[0]], boundary.tet_vertex[t[1]], boundary.tet_vertex[t[2]]};
    surface.tet.push_back(tet_with(model.mesh, tets, corners));
  }
  TubeBuilder(model.mesh, tets, surface).add();
  add_edges(surface);
  return surface;
}

TetPoint tet_point(const Surface& surface, const TetMesh& mesh, int triangle, const Vec3d& corner_weights) {
  const Triangle& corners = surface.triangles[triangle];
  if (!mesh.is_tet(surface.tet[triangle])) {
    TetPoint point{{}, {corner_weights[0], corner_weights[1], corner_weights[2], 0}};
    for (int c = 0; c < 3; ++c) point.vertices[c] = surface.anchor(corners[c]);
    point.vertices[3] = point.vertices[0];
    return point;
  }
  if (!surface.is_fine) {
    const TetMesh parts = parts_of(mesh, surface.tet[triangle]);
    const auto has_corners = [&](const Tet& part) {
      return std::all_of(corners.begin(), corners.end(),
                         [&](int c) { return std::find(part.begin(), part.end(), surface.anchor(c)) != part.end(); });
    };
    TetPoint point{*std::find_if(parts.tets.begin(), parts.tets.end(), has_corners), {}};
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < 4; ++i)
        if (point.vertices[i] == surface.anchor(corners[c])) point.weights[i] = corner_weights[c];
    return point;
  }
  // Uses the tet that carries the nearest corner.
  int nearest = 0;
  Vec3d rest{};
  for (int c = 0; c < 3; ++c) {
    if (corner_weights[c] > corner_weights[nearest]) nearest = c;
    rest = rest + corner_weights[c] * surface.rest[corners[c]];
  }
  const int tet = surface.tets[corners[nearest]];
  const TetMesh parts = parts_of(mesh, tet);
  TetPoint best;
  double most =
      -std::numeric_limits<double>::infinity();  // the smallest coordinate in the part that contains the point
  for (int p = 0; p < parts.tet_count(); ++p) {
    const std::array<double, 4> weights = barycentric(aspic::corners(parts, p), rest);
    const double least = *std::min_element(weights.begin(), weights.end());
    if (least > most) most = least, best = {parts.tets[p], weights};
  }
  return best;
}

SurfacePoint nearest_surface_point(const Surface& surface, const Vec3d& rest) {
  SurfacePoint best;
  double least = std::numeric_limits<double>::infinity();
  for (int t = 0; t < surface.triangle_count(); ++t) {
    const auto [a, b, c] = surface.triangles[t];
    const Vec3d &A = surface.rest[a], &B = surface.rest[b], &C = surface.rest[c];
    const Vec3d p = nearest_point(rest, A, B, C), away = p - rest;
    if (!(dot(away, away) < least)) continue;
    least = dot(away, away);
    const Vec3d n = cross(B - A, C - A);
    const double nn = dot(n, n);
    best.triangle = t;
    best.weights = nn > 0 ? Vec3d{{dot(cross(C - B, p - B), n) / nn, dot(cross(A - C, p - C), n) / nn,
                                   dot(cross(B - A, p - A), n) / nn}}
                          : Vec3d{{1, 0, 0}};
  }
  return best;
}

Vec3d rest_point(const Surface& surface, const SurfacePoint& point) {
  Vec3d rest{};
  for (int c = 0; c < 3; ++c) rest = rest + point.weights[c] * surface.rest[surface.triangles[point.triangle][c]];
  return rest;
}

SurfacePoint same_point(const Surface& from, const SurfacePoint& point, const Surface& to) {
  return from.has_same_shape(to) ? point : nearest_surface_point(to, rest_point(from, point));
}

}  // namespace aspic::viewer

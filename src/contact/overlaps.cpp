#include "contact/overlaps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "mesh/box_tree.h"
#include "mesh/disjoint_sets.h"
#include "mesh/predicates.h"
#include "mesh/self_intersection.h"
#include "mesh/triangle_shape.h"

namespace aspic {
namespace {

constexpr int kMaxPairs = 100'000;

// Returns whether a segment passes through a triangle, or touches it. A segment in its plane does not count.
bool passes(const Vec3d& p, const Vec3d& q, const TriangleCorners& t) {
  const int from = orientation(t[0], t[1], t[2], p), to = orientation(t[0], t[1], t[2], q);
  if (from * to > 0 || (from == 0 && to == 0)) return false;
  const int sides[] = {orientation(p, q, t[0], t[1]), orientation(p, q, t[1], t[2]), orientation(p, q, t[2], t[0])};
  const auto [least, most] = std::minmax_element(std::begin(sides), std::end(sides));
  return *least >= 0 || *most <= 0;
}

// Visits pairs of a triangle without area and a triangle of another part through which one of its sides passes.
template <class Visit>
void for_pierced(const ContactMesh& mesh, std::span<const Vec3d> x, const Visit& visit) {
  const auto corners = [&](int t) {
    const Triangle& own = mesh.triangles[t];
    return TriangleCorners{x[own[0]], x[own[1]], x[own[2]]};
  };
  std::vector<int> needles;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    if (is_degenerate(corners(t))) needles.push_back(t);
  if (needles.empty()) return;
  std::vector<Box> boxes(mesh.triangle_count());
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (const int p : mesh.triangles[t]) boxes[t].add(x[p]);
  const BoxTree tree(boxes);
  const auto is_obstacle = [&](int t) { return mesh.row[mesh.triangles[t][0]] < 0; };
  const auto part = [&](int t) { return mesh.part[mesh.triangles[t][0]]; };
  for (const int needle : needles)
    tree.for_each_overlap(boxes[needle], [&](int t) {
      if (part(t) == part(needle) || (is_obstacle(t) && is_obstacle(needle))) return true;
      const TriangleCorners line = corners(needle);
      for (int k = 0; k < 3; ++k)
        if (passes(line[k], line[(k + 1) % 3], corners(t))) {
          visit(needle, t);
          break;
        }
      return true;
    });
}

// Returns one point of each connected component of each part.
std::vector<int> component_points(const ContactMesh& mesh) {
  DisjointSets sets(mesh.point_count());
  for (const Triangle& t : mesh.triangles) sets.join(t[0], t[1]), sets.join(t[1], t[2]);
  std::vector<int> points;
  std::vector<char> is_known(mesh.point_count(), 0);
  for (const Triangle& t : mesh.triangles)
    if (char& known = is_known[sets.find(t[0])]; !known) known = 1, points.push_back(t[0]);
  return points;
}

// The closed surfaces of the mesh, for tests of which points they enclose.
class ClosedParts {
 public:
  ClosedParts(const ContactMesh& mesh, std::span<const Vec3d> x)
      : mesh_(mesh), x_(x), boxes_(mesh.parts.size()), is_closed_(mesh.parts.size(), true) {
    for (int e = 0; e < mesh.edge_count(); ++e)
      if (mesh.edge_share[e] != -1) is_closed_[mesh.part[mesh.edges[e][0]]] = false;
    for (int p = 0; p < mesh.point_count(); ++p) boxes_[mesh.part[p]].add(x[p]);
  }
  bool encloses(int part, const Vec3d& p) const {
    const Box& box = boxes_[part];
    for (int k = 0; k < 3; ++k)
      if (!is_closed_[part] || p[k] < box.lower[k] || p[k] > box.upper[k]) return false;
    double angle = 0;  // solid angle of the surface; 4 pi times the winding number [Van Oosterom and Strackee 1983]
    for (const Triangle& t : mesh_.triangles) {
      if (mesh_.part[t[0]] != part) continue;
      const Vec3d a = x_[t[0]] - p, b = x_[t[1]] - p, c = x_[t[2]] - p;
      const double la = norm(a), lb = norm(b), lc = norm(c);
      angle += 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return std::abs(angle) > 2 * std::numbers::pi;
  }

 private:
  const ContactMesh& mesh_;
  std::span<const Vec3d> x_;
  std::vector<Box> boxes_;
  std::vector<char> is_closed_;
};

}  // namespace

Overlaps overlaps(const ContactMesh& mesh, std::span<const Vec3d> x) {
  SelfIntersections found = self_intersections({{x.begin(), x.end()}, mesh.triangles}, kMaxPairs);
  std::erase_if(found.pairs, [&](const auto& pair) {  // obstacles may intersect each other and themselves
    return mesh.row[mesh.triangles[pair[0]][0]] < 0 && mesh.row[mesh.triangles[pair[1]][0]] < 0;
  });
  for_pierced(mesh, x, [&](int needle, int t) { found.pairs.push_back({needle, t}); });
  std::map<std::array<int, 2>, Vec3d> places;
  for (const auto& [s, t] : found.pairs) {
    const auto [a, b] = std::minmax(mesh.part[mesh.triangles[s][0]], mesh.part[mesh.triangles[t][0]]);
    places.try_emplace({a, b}, x[mesh.triangles[s][0]]);
  }
  Overlaps result{.count = found.pairs.size(), .is_complete = found.is_complete};
  for (const auto& [parts, place] : places) result.pairs.push_back({parts, place});
  return result;
}

std::vector<Enclosed> enclosed_parts(const ContactMesh& mesh, std::span<const Vec3d> x) {
  const ClosedParts closed(mesh, x);
  std::vector<Enclosed> found;
  for (const int p : component_points(mesh))
    for (int outer = 0; outer < static_cast<int>(mesh.parts.size()); ++outer) {
      const int inner = mesh.part[p];
      if (outer == inner || mesh.parts[outer].is_hollow) continue;
      if (mesh.parts[inner].is_obstacle && mesh.parts[outer].is_obstacle) continue;
      const auto is_known = [&](const Enclosed& e) { return e.inner == inner && e.outer == outer; };
      if (!closed.encloses(outer, x[p]) || std::any_of(found.begin(), found.end(), is_known)) continue;
      found.push_back({inner, outer, x[p]});
    }
  return found;
}

}  // namespace aspic

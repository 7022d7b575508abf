#include "mesh/triangle_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/predicates.h"

namespace aspic {
namespace {

using Triangle2 = std::array<Vec2d, 3>;

// Projects along the coordinate axis in which the normal is largest.
Triangle2 flattened(const TriangleCorners& t, int without) {
  const int u = (without + 1) % 3, v = (without + 2) % 3;
  return {{{t[0][u], t[0][v]}, {t[1][u], t[1][v]}, {t[2][u], t[2][v]}}};
}

int largest_axis(const Vec3d& normal) {
  int largest = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (std::abs(normal[axis]) > std::abs(normal[largest])) largest = axis;
  return largest;
}

// Coplanar triangles of either orientation are disjoint if the line of an edge of one strictly separates the other
// (separating axes).
bool is_separated_by_edges(const Triangle2& s, const Triangle2& t) {
  const int inside = orientation(s[0], s[1], s[2]);
  for (int e = 0; e < 3; ++e) {
    bool all_outside = true;
    for (const Vec2d& p : t) all_outside = all_outside && orientation(s[e], s[(e + 1) % 3], p) * inside < 0;
    if (all_outside) return true;
  }
  return false;
}

bool meet_in_plane(const TriangleCorners& s, const TriangleCorners& t) {
  const int without = largest_axis(cross(s[1] - s[0], s[2] - s[0]));
  const Triangle2 a = flattened(s, without), b = flattened(t, without);
  return !is_separated_by_edges(a, b) && !is_separated_by_edges(b, a);
}

// Returns whether segment pq, which is not in the plane of t, intersects t: its line passes all edges on the same side.
bool segment_meets(const Vec3d& p, const Vec3d& q, const TriangleCorners& t) {
  bool left = true, right = true;
  for (int e = 0; e < 3; ++e) {
    const int side = orientation(p, q, t[e], t[(e + 1) % 3]);
    left = left && side >= 0;
    right = right && side <= 0;
  }
  return left || right;
}

// Returns whether an edge of s passes through t; `sides` are the sides of t on which the corners of s lie.
bool edge_passes_through(const TriangleCorners& s, const std::array<int, 3>& sides, const TriangleCorners& t) {
  for (int e = 0; e < 3; ++e) {
    const int f = (e + 1) % 3;
    if (sides[e] * sides[f] > 0 || (sides[e] == 0 && sides[f] == 0)) continue;
    if (segment_meets(s[e], s[f], t)) return true;
  }
  return false;
}

std::array<int, 3> sides_of(const TriangleCorners& plane, const TriangleCorners& t) {
  return {orientation(plane[0], plane[1], plane[2], t[0]), orientation(plane[0], plane[1], plane[2], t[1]),
          orientation(plane[0], plane[1], plane[2], t[2])};
}

bool all_on_one_side(const std::array<int, 3>& sides) {
  return sides[0] != 0 && sides[0] == sides[1] && sides[1] == sides[2];
}

bool all_in_plane(const std::array<int, 3>& sides) { return sides[0] == 0 && sides[1] == 0 && sides[2] == 0; }

// Returns whether the wedges at the common corner s[0] = t[0] of coplanar triangles overlap: one contains an edge of
// the other.
bool wedges_overlap(const TriangleCorners& s, const TriangleCorners& t) {
  const int without = largest_axis(cross(s[1] - s[0], s[2] - s[0]));
  const Triangle2 a = flattened(s, without), b = flattened(t, without);
  const auto contains = [](const Triangle2& wedge, const Vec2d& p) {
    const int inside = orientation(wedge[0], wedge[1], wedge[2]);
    return orientation(wedge[0], wedge[1], p) * inside > 0 && orientation(wedge[0], wedge[2], p) * inside < 0;
  };
  const auto coincide = [&] {  // both edges of b coincide with those of a
    return orientation(a[0], a[1], a[2]) != 0 && contains(a, {(b[1][0] + b[2][0]) / 2, (b[1][1] + b[2][1]) / 2});
  };
  return contains(a, b[1]) || contains(a, b[2]) || contains(b, a[1]) || contains(b, a[2]) || coincide();
}

}  // namespace

// Walks through the Voronoi regions of the corners, the edges and the face.
Vec3d nearest_point(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a;
  const double d1 = dot(ab, p - a), d2 = dot(ac, p - a);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = dot(ab, p - b), d4 = dot(ac, p - b);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  const double d5 = dot(ab, p - c), d6 = dot(ac, p - c);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  return a + (vb / (va + vb + vc)) * ab + (vc / (va + vb + vc)) * ac;
}

bool is_degenerate(const TriangleCorners& t) {
  double size = 0, longest = 0;
  for (int c = 0; c < 3; ++c) {
    const Vec3d edge = t[(c + 1) % 3] - t[c];
    longest = std::max(longest, norm(edge));
    for (int axis = 0; axis < 3; ++axis) size = std::max(size, std::abs(t[c][axis]));
  }
  const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
  // Round-off of the corners changes the cross product by about this amount.
  return !(norm(normal) > 4 * std::numeric_limits<double>::epsilon() * std::max(size, longest) * longest);
}

bool meet(const TriangleCorners& s, const TriangleCorners& t) {
  const std::array<int, 3> of_t = sides_of(s, t);
  if (all_on_one_side(of_t)) return false;
  const std::array<int, 3> of_s = sides_of(t, s);
  if (all_on_one_side(of_s)) return false;
  if (all_in_plane(of_t)) return meet_in_plane(s, t);
  return edge_passes_through(t, of_t, s) || edge_passes_through(s, of_s, t);
}

bool meet_beyond_vertex(const TriangleCorners& s, const TriangleCorners& t) {
  const std::array<int, 3> of_t = sides_of(s, t), of_s = sides_of(t, s);
  if (all_in_plane(of_t)) return wedges_overlap(s, t);
  // The intersection is a segment from the common corner to the opposite edge of one of the triangles.
  const auto opposite_edge_meets = [](const TriangleCorners& a, const std::array<int, 3>& sides,
                                      const TriangleCorners& b) {
    return sides[1] * sides[2] <= 0 && (sides[1] != 0 || sides[2] != 0) && segment_meets(a[1], a[2], b);
  };
  return opposite_edge_meets(t, of_t, s) || opposite_edge_meets(s, of_s, t);
}

bool meet_beyond_edge(const TriangleCorners& s, const TriangleCorners& t) {
  if (orientation(s[0], s[1], s[2], t[2]) != 0) return false;
  const Vec3d edge = s[1] - s[0];
  return dot(cross(edge, s[2] - s[0]), cross(edge, t[2] - t[0])) > 0;
}

}  // namespace aspic

#include "contact/touches.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "contact/contact_reach.h"

namespace aspic {
namespace {

constexpr double kFacing = 0.05;  // least cosine of the angle between the outward normal of a point and the way out
constexpr double kAlmostParallel = 1e-3;  // sine of the angle below which edges count as parallel
constexpr double kClear = 1.001;          // relative to the reach

class Touches {
 public:
  Touches(const ContactMesh& mesh, const ContactLaws& laws, std::span<const Vec3d> x)
      : mesh_(mesh), laws_(laws), x_(x), outward_(x.size()) {
    for (const Triangle& t : mesh.triangles)
      for (const int p : t) outward_[p] = outward_[p] + area_vector(t);
  }

  void add_point_triangle(int p, int triangle) {
    const Triangle& t = mesh_.triangles[triangle];
    const ContactLaw& law = laws_(mesh_.part[p], mesh_.part[t[0]]);
    const Distance distance = point_triangle_distance({x_[p], x_[t[0]], x_[t[1]], x_[t[2]]});
    if (!touches(distance.d, law, thin(p) + thin(t[0]))) return;
    const Vec3d normal = unit(law.is_round ? distance.r : area_vector(t));  // from the triangle to the point
    if (thin(p) + thin(t[0]) > 0) {
      const bool is_second = law.is_round || is_reference(t[0], p);
      const Vec3d out = is_second ? normal : -sign(dot(normal, outward_[p])) * normal;
      return add_thin(std::array{p}, t, out, distance);
    }
    const double side = is_body(t[0]) || law.is_round ? 1 : -sign(dot(normal, outward_[p]));
    if (is_body(p) && faces(p, side * normal)) add({p}, side * normal, mesh_.part[t[0]]);
    const bool is_facing =
        law.is_round || (is_body(p) ? faces(p, normal) : faces(p, normal) || faces(p, -1.0 * normal));
    if (is_body(t[0]) && is_facing) add(t, -1.0 * normal, mesh_.part[p]);
  }

  void add_edges(const Edge& a, const Edge& b) {
    const ContactLaw& law = laws_(mesh_.part[a[0]], mesh_.part[b[0]]);
    const Distance distance = edge_edge_distance({x_[a[0]], x_[a[1]], x_[b[0]], x_[b[1]]});
    // Ends of edges are points, which touch triangles.
    const double thickness = thin(a[0]) + thin(b[0]);
    if (distance.type != DistanceType::edge_edge || !touches(distance.d, law, thickness)) return;
    const Vec3d u = unit(x_[a[1]] - x_[a[0]]), v = unit(x_[b[1]] - x_[b[0]]);
    Vec3d normal = law.is_round ? distance.r : cross(u, v);
    if (!law.is_round && norm(normal) < kAlmostParallel) return;
    normal = unit(normal);
    if (thickness > 0) {
      const double side = law.is_round ? 1 : is_reference(b[0], a[0]) ? -side_of(b, normal) : side_of(a, normal);
      return add_thin(a, b, side * normal, distance);
    }
    const double from_b = side_of(a, normal), from_a = side_of(b, normal);
    if (!law.is_round && is_body(a[0]) && is_body(b[0]) && from_a == from_b) return;
    if (is_body(a[0])) add(a, from_b * normal, mesh_.part[b[0]]);
    if (is_body(b[0])) add(b, from_a * normal, mesh_.part[a[0]]);
  }

  void add_plane(int p, const ContactPlane& plane) {
    const ContactLaw& law = laws_(mesh_.part[p], plane.part);
    const double height = dot(plane.normal, x_[p] - x_[plane.point]);
    if (is_body(p) && touches(height, law, thin(p)))
      add_one(p, plane.normal, plane.part, thin(p) > 0 ? law.offset - height : 0);
  }

  std::vector<Touch> take() { return std::move(found_); }

 private:
  static double sign(double a) { return a < 0 ? -1 : 1; }
  static Vec3d unit(const Vec3d& v) { return norm(v) > 0 ? (1 / norm(v)) * v : Vec3d{}; }
  Vec3d area_vector(const Triangle& t) const { return 0.5 * cross(x_[t[1]] - x_[t[0]], x_[t[2]] - x_[t[0]]); }
  bool is_body(int p) const { return mesh_.row[p] >= 0; }
  // `half_thickness`: of the thin parts of the pair, whose points may be closer by twice that.
  static bool touches(double distance, const ContactLaw& law, double half_thickness) {
    const double rounding = kTouching * law.edge;
    return distance - law.offset <= rounding && distance - law.offset >= -2 * half_thickness - rounding;
  }
  // Half the thickness of a sheet, or the radius of a rod; 0 for other parts.
  double thin(int p) const {
    const ContactPart& part = mesh_.parts[mesh_.part[p]];
    return part.is_hollow ? part.offset : 0;
  }
  // Returns whether the normal of a point's part defines the side of the other part: for solids and obstacles, and for
  // the first of two sheets.
  bool is_reference(int p, int other) const {
    return thin(p) == 0 || (thin(other) > 0 && mesh_.part[p] < mesh_.part[other]);
  }
  // Moves the sheets and rods of a pair, but not the solids. `out`: the way from the second feature to the first if
  // they coincide, and out of solids.
  template <class First, class Second>
  void add_thin(const First& first, const Second& second, const Vec3d& out, const Distance& distance) {
    constexpr double kBehind = 0.5;  // least cosine
    const ContactLaw& law = laws_(mesh_.part[first[0]], mesh_.part[second[0]]);
    const bool coincide = distance.d <= kTouching * law.edge, is_sided = thin(first[0]) == 0 || thin(second[0]) == 0;
    const bool is_behind = is_sided && dot(distance.r, out) < -kBehind * distance.d;
    const Vec3d way = coincide || is_behind ? out : unit(distance.r);
    const double missing = law.offset - (coincide ? 0 : is_behind ? -distance.d : distance.d);
    for (const int p : first)
      if (is_body(p) && thin(p) > 0) add_one(p, way, mesh_.part[second[0]], missing);
    for (const int p : second)
      if (is_body(p) && thin(p) > 0) add_one(p, -1.0 * way, mesh_.part[first[0]], missing);
  }
  // Returns whether a way away from the other surface leads into the point's own body.
  bool faces(int p, const Vec3d& away) const { return dot(outward_[p], away) < -kFacing * norm(outward_[p]); }
  // Returns the sign of `normal` that leads into the body of an edge.
  double side_of(const Edge& edge, const Vec3d& normal) const {
    return -sign(dot(normal, outward_[edge[0]] + outward_[edge[1]]));
  }
  template <class Points>
  void add(const Points& points, const Vec3d& away, int other) {
    for (const int p : points) add_one(p, away, other);
  }
  void add(std::initializer_list<int> points, const Vec3d& away, int other) {
    for (const int p : points) add_one(p, away, other);
  }
  void add_one(int p, const Vec3d& away, int other, double missing = 0) {
    const int own = mesh_.part[p];
    const double by = missing + kClear * std::min(laws_(own, other).reach, touching_reach(laws_(own, other)));
    found_.push_back({p, away, by, {std::min(own, other), std::max(own, other)}});
  }

  const ContactMesh& mesh_;
  const ContactLaws& laws_;
  std::span<const Vec3d> x_;
  std::vector<Vec3d> outward_;  // sum of the area vectors of the triangles at each point [m^2]
  std::vector<Touch> found_;
};

}  // namespace

std::vector<Touch> touches(const ContactMesh& mesh, const ContactLaws& laws, const StencilSearch& search,
                           std::span<const Vec3d> x) {
  const auto near = search.along(PairScope::between_parts, x, {});
  if (!near) throw std::length_error("contact: too many features touch each other at the start");
  Touches found(mesh, laws, x);
  for (int p = 0; p < mesh.point_count(); ++p) {
    for (const NearTriangle& pair : near->pairs->near(p)) found.add_point_triangle(p, pair.triangle);
    for (const ContactPlane& plane : mesh.planes) found.add_plane(p, plane);
  }
  for (const auto& [a, b, gap] : near->pairs->edge_pairs) found.add_edges(mesh.edges[a], mesh.edges[b]);
  return found.take();
}

}  // namespace aspic

#include "indenter/probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "energy/surface_parts.h"
#include "indenter/indenter_depth.h"
#include "math/symmetric_eigen.h"
#include "mesh/vertices.h"

namespace aspic {
namespace {

constexpr double kSoftening = 0.02;  // e / radius; chosen, as wide as the sharpest rim of a disc
constexpr double kEdge = 0.125;      // width of the glue of a disc / radius: a cut of the triangles
constexpr double kLongestEdge = 64;  // longest edge of a triangle near the indenter / radius: 2^20 points per triangle
constexpr int kMaxFarCuts = 64;      // of an edge of a triangle that the indenter does not touch at rest: 4096 points

using Corners = std::array<Vec3d, 3>;

std::string text(double value) { return (std::ostringstream() << value).str(); }
Corners corners_of(Positions x, const Triangle& t) { return {point(x, t[0]), point(x, t[1]), point(x, t[2])}; }
Vec3d combine(const Corners& x, const Barycentric& b) { return b[0] * x[0] + b[1] * x[1] + b[2] * x[2]; }
Vec3d area_vector(const Corners& x) { return 0.5 * cross(x[1] - x[0], x[2] - x[0]); }
double longest_edge(const Corners& x) { return std::max({norm(x[1] - x[0]), norm(x[2] - x[1]), norm(x[0] - x[2])}); }

void add_at(std::span<double> g, int vertex, double scale, const Vec3d& v) {
  for (int r = 0; r < 3; ++r) g[3 * vertex + r] += scale * v[r];
}

// R = cos I + sin [a] + (1 - cos) a a'   [Rodrigues]
Mat3d rotation_matrix(const Vec3d& vector) {
  const double angle = norm(vector);
  if (angle == 0) return identity3<double>();
  const Vec3d a = (1 / angle) * vector;
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const Mat3d turn = {0, a[2], -a[1], -a[2], 0, a[0], a[1], -a[0], 0};
  const Mat3d along = from_columns(a[0] * a, a[1] * a, a[2] * a);
  return cosine * identity3<double>() + sine * turn + (1 - cosine) * along;
}

// Smooth transition from 1 below a to 0 above b.
double fade(double t, double a, double b) {
  const double s = std::clamp((t - a) / (b - a), 0.0, 1.0);
  return 1 - s * s * (3 - 2 * s);
}

// Weight of the glue of a bonded indenter, 0 to 1, at point X of the surface with the given normal.
double glue(const Indenter& indenter, const IndenterPose& touch, const Vec3d& X, const Vec3d& normal) {
  const double R = indenter.radius;
  const Vec3d u = X - touch.center;
  if (indenter.shape == IndenterShape::sphere)
    return dot(normal, u) < 0 ? fade(norm(u) - R, kGlue / 2 * R, kGlue * R) : 0;
  const double s = dot(u, touch.axis);
  if (dot(normal, touch.axis) >= 0 || s < -R) return 0;
  return fade(s, kGlue / 2 * R, kGlue * R) * fade(norm(u - s * touch.axis), (1 - kEdge) * R, (1 + kEdge) * R);
}

IndenterPose with_unit_axis(IndenterPose pose) {
  const double length = norm(pose.axis);
  if (!(length > 0)) throw InvalidInput("the axis of a tip is 0 0 0; it needs a direction, out of the tip");
  pose.axis = (1 / length) * pose.axis;
  return pose;
}

// Energy of a point and its derivatives with respect to its position.
struct Response {
  double value = 0;
  Vec3d gradient{};
  Mat3d hessian{};
};

// A triangle with points that the indenter may act on.
struct Patch {
  Triangle vertices;
  const std::vector<Barycentric>* points;
  double area = 0;   // area of each part at rest [m^2]
  size_t first = 0;  // index of its first point
};

class ProbeTerm : public Probe {
 public:
  ProbeTerm(const TetMesh& mesh, std::span<const Triangle> surface, const Indenter& indenter, const IndenterPose& touch)
      : indenter_(indenter), touch_(with_unit_axis(touch)), placed_(touch) {
    for (const Triangle& triangle : surface) add_patch(mesh, triangle);
  }

  std::string_view name() const override { return "probe"; }
  bool touches_something() const { return !patches_.empty(); }

  void set_pose(const IndenterPose& pose) override { placed_ = PlacedIndenter(pose); }
  const PlacedIndenter& placed() const override { return placed_; }

  double value_at(const PlacedIndenter& indenter, Positions x) const override {
    double V = 0;
    for_each_touched(indenter, x,
                     [&](const Patch&, const Barycentric&, const Vec3d&, const Response& r) { V += r.value; });
    return V;
  }

  void add_gradient_at(const PlacedIndenter& indenter, Positions x, double scale, std::span<double> g) const override {
    for_each_touched(indenter, x, [&](const Patch& patch, const Barycentric& b, const Vec3d&, const Response& r) {
      for (int i = 0; i < 3; ++i) add_at(g, patch.vertices[i], scale * b[i], r.gradient);
    });
  }

  void add_couplings(Couplings& couplings) const override {
    for (const Patch& patch : patches_)
      for (int i = 0; i < 3; ++i) couplings.emplace_back(patch.vertices[i], patch.vertices[(i + 1) % 3]);
  }

  void bind(const BlockPattern& pattern) override {
    slot_.resize(patches_.size());
    for (size_t k = 0; k < patches_.size(); ++k)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const auto [low, high] = std::minmax(patches_[k].vertices[i], patches_[k].vertices[j]);
          slot_[k][3 * i + j] = pattern.slot(high, low);
        }
  }

  int add_hessian_at(const PlacedIndenter& indenter, Positions x, double scale, const Projection& projection,
                     BlockSparse& H) const override {
    int projected = 0;
    for_each_touched(indenter, x, [&](const Patch& patch, const Barycentric& b, const Vec3d&, const Response& r) {
      Mat3d K = r.hessian;
      const auto covers = [&](int v) { return projection.covers(v); };
      if (is_sliding() && projection.kind != Definiteness::exact &&
          std::any_of(patch.vertices.begin(), patch.vertices.end(), covers))
        projected += modify_hessian(K, projection.kind);
      const auto& slot = slot_[&patch - patches_.data()];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          if (patch.vertices[j] <= patch.vertices[i]) add_block(H.block[slot[3 * i + j]], scale * b[i] * b[j], K);
    });
    return projected;
  }

  Wrench wrench(Positions x) const override {
    Wrench sum;
    for_each_touched(placed_, x, [&](const Patch&, const Barycentric&, const Vec3d& p, const Response& r) {
      sum.force = sum.force - r.gradient;
      sum.torque = sum.torque - cross(p - placed_.pose.center, r.gradient);
    });
    return sum;
  }

  Wrench wrench_product(Positions x, std::span<const double> dx) const override {
    Wrench sum;
    for_each_touched(placed_, x, [&](const Patch& patch, const Barycentric& b, const Vec3d& p, const Response& r) {
      const Vec3d dp = combine(corners_of(dx, patch.vertices), b), dg = r.hessian * dp;
      sum.force = sum.force - dg;
      sum.torque = sum.torque - cross(dp, r.gradient) - cross(p - placed_.pose.center, dg);
    });
    return sum;
  }

  void add_wrench_transposed(Positions x, const Wrench& wbar, double scale, std::span<double> xbar) const override {
    for_each_touched(placed_, x, [&](const Patch& patch, const Barycentric& b, const Vec3d& p, const Response& r) {
      // w . (dp x g) = dp . (g x w),  w . (u x dg) = dg . (w x u)
      const Vec3d gbar = wbar.force + cross(wbar.torque, p - placed_.pose.center);
      const Vec3d pbar = cross(r.gradient, wbar.torque) + r.hessian * gbar;
      for (int i = 0; i < 3; ++i) add_at(xbar, patch.vertices[i], -scale * b[i], pbar);
    });
  }

  Wrench add_rim_gradient(Positions x, double scale, std::span<double> g) const override {
    Wrench sum;
    if (!is_sliding() || indenter_.shape != IndenterShape::disc) return sum;
    for_each_touched(placed_, x, [&](const Patch& patch, const Barycentric& b, const Vec3d& p, const Response&) {
      const Depth d = depth(indenter_, placed_.pose, p);
      const RimChange change = rim_change(indenter_, placed_.pose, p);
      const Layer layer = layer_at(d.value, indenter_.stiffness * patch.area);
      const Vec3d dg = (layer.curvature * change.value) * d.gradient + layer.slope * change.gradient;
      for (int i = 0; i < 3; ++i) add_at(g, patch.vertices[i], scale * b[i], dg);
      sum.force = sum.force - dg;
      sum.torque = sum.torque - cross(p - placed_.pose.center, dg);
    });
    return sum;
  }

  int touched_points(Positions x) const override {
    int count = 0;
    for_each_touched(placed_, x, [&](const Patch&, const Barycentric&, const Vec3d&, const Response&) { ++count; });
    return count;
  }

  void visit_touched(Positions x, const std::function<void(const TouchedPoint&)>& visit) const override {
    for_each_touched(placed_, x, [&](const Patch& patch, const Barycentric& b, const Vec3d& p, const Response& r) {
      visit({patch.vertices, b, p, r.gradient, r.hessian});
    });
  }

 private:
  bool is_sliding() const { return indenter_.contact == IndenterContact::sliding; }

  void add_patch(const TetMesh& mesh, const Triangle& triangle) {
    const Corners X = {mesh.rest[triangle[0]], mesh.rest[triangle[1]], mesh.rest[triangle[2]]};
    const double edge = longest_edge(X), ideal = std::ceil((is_sliding() ? 16 : 8) * edge / indenter_.radius);
    const bool is_near = depth(indenter_, touch_, X[0]).value > -edge - indenter_.radius;
    if (!is_near && !is_sliding()) return;
    if (is_near && edge > kLongestEdge * indenter_.radius) throw_indenter_too_small(edge);
    const int cuts = static_cast<int>(is_near ? std::max(ideal, 1.0) : std::clamp(ideal, 1.0, 1.0 * kMaxFarCuts));
    const Vec3d a = area_vector(X);
    Patch patch{triangle, &centroids_.of(cuts), norm(a) / (static_cast<double>(cuts) * cuts), weight_.size()};
    if (is_sliding() || add_glue(patch, X, a)) patches_.push_back(patch);
  }

  void throw_indenter_too_small(double edge) const {
    throw InvalidInput("a tip of radius " + text(indenter_.radius) + " m beside a triangle whose edge is " +
                       text(edge) + " m long; refine the mesh there, or check the units of the tip");
  }

  // Adds the weights and offsets of the points of a bonded indenter. Returns false and adds nothing if it touches none.
  bool add_glue(const Patch& patch, const Corners& X, const Vec3d& normal) {
    bool touches = false;
    for (const Barycentric& b : *patch.points) {
      const Vec3d p = combine(X, b);
      weight_.push_back(glue(indenter_, touch_, p, normal));
      offset_.push_back(p - touch_.center);
      touches |= weight_.back() > 0;
    }
    if (!touches) weight_.resize(patch.first), offset_.resize(patch.first);
    return touches;
  }

  // Calls visit(patch, barycentric, p, response) for each point that the indenter acts on.
  template <class Visit>
  void for_each_touched(const PlacedIndenter& indenter, Positions x, Visit visit) const {
    for (const Patch& patch : patches_) {
      const Corners c = corners_of(x, patch.vertices);
      if (is_sliding() && depth(indenter_, indenter.pose, c[0]).value < -longest_edge(c)) continue;
      for (size_t i = 0; i < patch.points->size(); ++i) {
        const Barycentric& b = (*patch.points)[i];
        const Vec3d p = combine(c, b);
        if (is_sliding()) {
          const Depth d = depth(indenter_, indenter.pose, p);
          if (d.value > 0) visit(patch, b, p, pushed(d, indenter_.stiffness * patch.area));
        } else if (const double w = weight_[patch.first + i]; w > 0) {
          const Vec3d target = indenter.pose.center + indenter.turn * offset_[patch.first + i];
          visit(patch, b, p, pulled(p - target, w * indenter_.stiffness * patch.area));
        }
      }
    }
  }

  // Energy of a point at depth t > 0 and its derivatives by t.
  struct Layer {
    double value, slope, curvature;
  };
  Layer layer_at(double t, double k) const {
    const double e = kSoftening * indenter_.radius;
    if (t < e) return {k * (t * t * t / (6 * e)), k * (t * t / (2 * e)), k * (t / e)};
    return {k * (t * (t - e) / 2 + e * e / 6), k * (t - e / 2), k};
  }

  Response pushed(const Depth& d, double k) const {
    const auto [value, slope, curvature] = layer_at(d.value, k);
    const Vec3d n = d.gradient;
    const Mat3d across = from_columns(n[0] * n, n[1] * n, n[2] * n);
    return {value, slope * n, curvature * across + slope * d.hessian};
  }

  static Response pulled(const Vec3d& u, double k) { return {k / 2 * dot(u, u), k * u, k * identity3<double>()}; }

  static void add_block(Mat3d& block, double scale, const Mat3d& K) {
    for (int m = 0; m < 9; ++m) block.a[m] += scale * K.a[m];
  }

  // Returns whether an eigenvalue was modified.
  static bool modify_hessian(Mat3d& K, Definiteness kind) {
    std::array<double, 9> entries;
    std::copy(K.a, K.a + 9, entries.begin());
    const SymmetricEigen<3> e = symmetric_eigen<3, double>(entries);
    bool changed = false;
    for (int k = 0; k < 3; ++k) {
      if (e.values[k] >= 0) continue;
      changed = true;
      const double raise = kind == Definiteness::clamped ? -e.values[k] : -2 * e.values[k];
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) K(r, c) += raise * e.vectors[3 * k + r] * e.vectors[3 * k + c];
    }
    return changed;
  }

  Indenter indenter_;
  IndenterPose touch_;
  PlacedIndenter placed_;
  PartCentroids centroids_;
  std::vector<Patch> patches_;
  std::vector<double> weight_;  // weight of each point of a bonded indenter
  std::vector<Vec3d> offset_;   // X - c_touch of each point of a bonded indenter
  std::vector<std::array<int64_t, 9>> slot_;
};

}  // namespace

PlacedIndenter::PlacedIndenter(const IndenterPose& given)
    : pose(with_unit_axis(given)), turn(rotation_matrix(given.rotation)) {}

std::unique_ptr<Probe> make_probe(const TetMesh& mesh, std::span<const Triangle> surface, const Indenter& indenter,
                                  const IndenterPose& touch) {
  if (!(indenter.radius > 0) || !std::isfinite(indenter.radius))
    throw InvalidInput("the radius of a tip is " + text(indenter.radius) + " m; it must be positive");
  if (!(indenter.stiffness > 0) || !std::isfinite(indenter.stiffness))
    throw InvalidInput("the layer of a tip has the stiffness " + text(indenter.stiffness) +
                       " Pa/m; it must be positive (try 1000 times Young's modulus over the radius)");
  auto probe = std::make_unique<ProbeTerm>(mesh, surface, indenter, touch);
  if (probe->touches_something()) return probe;
  double gap = INFINITY;
  for (const Triangle& triangle : surface)
    for (const int v : triangle) gap = std::min(gap, -depth(indenter, with_unit_axis(touch), mesh.rest[v]).value);
  throw InvalidInput("a bonded tip touches nothing at rest: the nearest vertex is " + text(gap) +
                     " m away from it; check its pose at the touch, its axis and the units");
}

int touched_points_at_rest(const TetMesh& mesh, std::span<const Triangle> surface, const Indenter& indenter,
                           const IndenterPose& touch) {
  return ProbeTerm(mesh, surface, indenter, touch).touched_points(rest_positions(mesh));
}

}  // namespace aspic

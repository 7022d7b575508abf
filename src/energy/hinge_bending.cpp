#include "energy/hinge_bending.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/parallel.h"
#include "energy/element_groups.h"
#include "energy/hinge_angle.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kFolded = 3;  // angle beyond which two triangles of a junction lie on each other

using HingeVertices = std::array<int, 4>;  // a, b, c, d

struct Hinge {
  HingeVertices vertices;
  std::array<int, 2> triangles;
  double stiffness, rest_angle;  // k [N m], theta0
};

HingeCorners corners_at(Positions x, const HingeVertices& vertices) {
  return {vec_at(x, vertices[0]), vec_at(x, vertices[1]), vec_at(x, vertices[2]), vec_at(x, vertices[3])};
}

// A side of a triangle, with the smaller vertex first.
struct Side {
  int a, b, opposite, triangle;
};

std::vector<Side> sorted_sides(std::span<const Triangle> triangles) {
  std::vector<Side> sides;
  for (size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangles[t][(k + 1) % 3], triangles[t][(k + 2) % 3]);
      sides.push_back({a, b, triangles[t][k], static_cast<int>(t)});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& p, const Side& q) {
    return std::array{p.a, p.b, p.triangle} < std::array{q.a, q.b, q.triangle};
  });
  return sides;
}

class HingeList {
 public:
  HingeList(std::span<const Vec3d> rest, std::span<const Triangle> triangles, std::span<const double> moment)
      : rest_(rest), moment_(moment) {
    for (const Triangle& t : triangles)
      areas_.push_back(0.5 * norm(cross(rest[t[1]] - rest[t[0]], rest[t[2]] - rest[t[0]])));
  }

  // Adds the hinges of an edge, given its sides.
  void add_edge(std::span<Side> sides, RestAngles rest_angles) {
    if (sides.size() < 2) return;
    if (sides.size() == 2) return add(sides[0], sides[1], rest_angles);
    sort_around(sides);
    for (size_t i = 0; i < sides.size(); ++i)
      add(sides[i], sides[(i + 1) % sides.size()], RestAngles::of_rest, kFolded);
  }

  std::vector<double> areas() const { return areas_; }
  const std::vector<Hinge>& hinges() const { return hinges_; }

 private:
  void add(const Side& p, const Side& q, RestAngles rest_angles, double largest_angle = INFINITY) {
    const double A1 = areas_[p.triangle], A2 = areas_[q.triangle];
    ASPIC_CHECK(A1 > 0 && A2 > 0);
    const double D = (A1 * moment_[p.triangle] + A2 * moment_[q.triangle]) / (A1 + A2);
    const double angle = hinge_angle({rest_[p.a], rest_[p.b], rest_[p.opposite], rest_[q.opposite]});
    if (D == 0 || std::abs(angle) > largest_angle) return;
    hinges_.push_back({{p.a, p.b, p.opposite, q.opposite},
                       {p.triangle, q.triangle},
                       D * squared_norm(rest_[p.b] - rest_[p.a]) / (A1 + A2),
                       rest_angles == RestAngles::flat ? 0 : angle});
  }

  // Sorts the sides of an edge by their angle around it.
  void sort_around(std::span<Side> sides) const {
    const Vec3d origin = rest_[sides[0].a], e = rest_[sides[0].b] - origin, axis = (1 / norm(e)) * e;
    const Vec3d zero = cross(axis, rest_[sides[0].opposite] - origin);
    const auto angle = [&](const Side& side) {
      const Vec3d m = cross(axis, rest_[side.opposite] - origin);
      return std::atan2(dot(cross(zero, m), axis), dot(zero, m));
    };
    std::stable_sort(sides.begin(), sides.end(), [&](const Side& p, const Side& q) { return angle(p) < angle(q); });
  }

  std::span<const Vec3d> rest_;
  std::span<const double> moment_;
  std::vector<double> areas_;
  std::vector<Hinge> hinges_;
};

class SheetBending : public HingeBending {
 public:
  explicit SheetBending(const HingeList& list) : hinges_(list.hinges()), areas_(list.areas()) {
    std::vector<HingeVertices> vertices;
    for (const Hinge& hinge : hinges_) vertices.push_back(hinge.vertices);
    groups_ = ElementGroups(vertices);
  }

  std::string_view name() const override { return "bending"; }

  double value(Positions x, const Context&) const override {
    const double V = parallel_sum(count(), [&](int first, int last) {
      double sum = 0;
      for (int i = first; i < last; ++i) sum += energy(hinges_[i], x);
      return sum;
    });
    return std::isnan(V) ? std::numeric_limits<double>::infinity() : V;
  }

  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    groups_.for_each([&](int i) {
      const Hinge& hinge = hinges_[i];
      const auto [angle, gradient] = hinge_gradient(corners_at(x, hinge.vertices));
      const double torque = scale * hinge.stiffness * (angle - hinge.rest_angle);
      for (int u = 0; u < 4; ++u) add_vec(torque * gradient[u], hinge.vertices[u], g);
    });
  }

  void add_couplings(Couplings& couplings) const override {
    for (const Hinge& hinge : hinges_) aspic::add_couplings(hinge.vertices, couplings);
  }
  void bind(const BlockPattern& pattern) override {
    blocks_.resize(hinges_.size());
    parallel_for(count(), [&](int i) { blocks_[i].bind(hinges_[i].vertices, pattern); });
  }

  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return groups_.count_if([&](int i) {
      const Hinge& hinge = hinges_[i];
      const HingeShape shape(corners_at(x, hinge.vertices));
      const HingeHessian K(shape, shape.angle - hinge.rest_angle,
                           is_covered(hinge.vertices, projection) ? projection.kind : Definiteness::exact);
      blocks_[i].add(K, scale * hinge.stiffness, H);
      return K.is_modified();
    });
  }

  void evaluate(Positions x, std::vector<double>& energy_density) const override {
    energy_density.assign(areas_.size(), 0.0);
    for (const Hinge& hinge : hinges_) {
      const double share = 0.5 * energy(hinge, x);
      for (const int t : hinge.triangles) energy_density[t] += share / areas_[t];
    }
  }

 private:
  int count() const { return static_cast<int>(hinges_.size()); }
  static double energy(const Hinge& hinge, Positions x) {
    const double change = hinge_angle(corners_at(x, hinge.vertices)) - hinge.rest_angle;
    return 0.5 * hinge.stiffness * change * change;
  }

  std::vector<Hinge> hinges_;
  std::vector<double> areas_;  // of the triangles at rest [m^2]
  std::vector<ElementBlocks<4>> blocks_;
  ElementGroups groups_;
};

}  // namespace

std::unique_ptr<HingeBending> make_hinge_bending(std::span<const Vec3d> rest, std::span<const Triangle> triangles,
                                                 std::span<const double> moment, RestAngles rest_angles) {
  ASPIC_CHECK(moment.size() == triangles.size());
  HingeList list(rest, triangles, moment);
  std::vector<Side> sides = sorted_sides(triangles);
  for (auto first = sides.begin(); first != sides.end();) {
    const auto last =
        std::find_if(first, sides.end(), [&](const Side& side) { return side.a != first->a || side.b != first->b; });
    list.add_edge({first, last}, rest_angles);
    first = last;
  }
  return std::make_unique<SheetBending>(list);
}

}  // namespace aspic

#include "energy/hinge_bending.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "base/check.h"
#include "base/parallel.h"
#include "energy/bending_density.h"
#include "energy/element_groups.h"
#include "energy/hinge_angle.h"
#include "energy/internal_variables.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kFolded = 3;  // angle beyond which two triangles of a junction lie on each other

using HingeVertices = std::array<int, 4>;  // a, b, c, d

struct Hinge {
  HingeVertices vertices;
  std::array<int, 2> triangles;
  int side;                      // 3 * first triangle + corner opposite to the edge; unique
  double stiffness, rest_angle;  // k [N m], theta0
};

HingeCorners corners_at(Positions x, const HingeVertices& vertices) {
  return {vec_at(x, vertices[0]), vec_at(x, vertices[1]), vec_at(x, vertices[2]), vec_at(x, vertices[3])};
}

// A side of a triangle, with the smaller vertex first.
struct Side {
  int a, b, opposite, triangle, corner;
};

std::vector<Side> sorted_sides(std::span<const Triangle> triangles) {
  std::vector<Side> sides;
  for (size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangles[t][(k + 1) % 3], triangles[t][(k + 2) % 3]);
      sides.push_back({a, b, triangles[t][k], static_cast<int>(t), k});
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
                       3 * p.triangle + p.corner,
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

// The elastic part of the change of an angle, and its derivative by the angle.
struct ElasticChange {
  double change, slope = 1;
};

// What terms on hinges share.
template <class Base>
class HingeTerm : public Base {
 public:
  explicit HingeTerm(std::vector<Hinge> hinges) : hinges_(std::move(hinges)) {
    std::vector<HingeVertices> vertices;
    for (const Hinge& hinge : hinges_) vertices.push_back(hinge.vertices);
    groups_ = ElementGroups(vertices);
  }

  void add_couplings(Couplings& couplings) const override {
    for (const Hinge& hinge : hinges_) aspic::add_couplings(hinge.vertices, couplings);
  }
  void bind(const BlockPattern& pattern) override {
    blocks_.resize(hinges_.size());
    parallel_for(count(), [&](int i) { blocks_[i].bind(hinges_[i].vertices, pattern); });
  }

 protected:
  int count() const { return static_cast<int>(hinges_.size()); }
  double angle(int i, Positions x) const { return hinge_angle(corners_at(x, hinges_[i].vertices)); }

  // Returns the sum of of_hinge(i); +inf if it is not a number.
  template <class OfHinge>
  double sum(const OfHinge& of_hinge) const {
    const double V = parallel_sum(count(), [&](int first, int last) {
      double part = 0;
      for (int i = first; i < last; ++i) part += of_hinge(i);
      return part;
    });
    return std::isnan(V) ? std::numeric_limits<double>::infinity() : V;
  }

  // Add the derivatives of a term with the torque k elastic(i, angle).change.
  template <class Elastic>
  void add_torques(Positions x, double scale, std::span<double> g, const Elastic& elastic) const {
    groups_.for_each([&](int i) {
      const Hinge& hinge = hinges_[i];
      const auto [angle, gradient] = hinge_gradient(corners_at(x, hinge.vertices));
      const double torque = scale * hinge.stiffness * elastic(i, angle).change;
      for (int u = 0; u < 4; ++u) add_vec(torque * gradient[u], hinge.vertices[u], g);
    });
  }
  template <class Elastic>
  int add_stiffness(Positions x, double scale, const Projection& projection, BlockSparse& H,
                    const Elastic& elastic) const {
    return groups_.count_if([&](int i) {
      const Hinge& hinge = hinges_[i];
      const HingeShape shape(corners_at(x, hinge.vertices));
      const ElasticChange e = elastic(i, shape.angle);
      const HingeHessian K(shape, e.change,
                           is_covered(hinge.vertices, projection) ? projection.kind : Definiteness::exact, e.slope);
      blocks_[i].add(K, scale * hinge.stiffness, H);
      return K.is_modified();
    });
  }

  std::vector<Hinge> hinges_;

 private:
  std::vector<ElementBlocks<4>> blocks_;
  ElementGroups groups_;
};

class SheetBending final : public HingeTerm<HingeBending> {
 public:
  explicit SheetBending(const HingeList& list) : HingeTerm(list.hinges()), areas_(list.areas()) {}

  std::string_view name() const override { return "bending"; }

  double value(Positions x, const Context&) const override {
    return sum([&](int i) { return energy(i, x); });
  }
  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    add_torques(x, scale, g, [&](int i, double angle) { return change(i, angle); });
  }
  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return add_stiffness(x, scale, projection, H, [&](int i, double angle) { return change(i, angle); });
  }

  void evaluate(Positions x, std::vector<double>& energy_density) const override {
    energy_density.assign(areas_.size(), 0.0);
    for (int i = 0; i < count(); ++i) {
      const double share = 0.5 * energy(i, x);
      for (const int t : hinges_[i].triangles) energy_density[t] += share / areas_[t];
    }
  }

 private:
  ElasticChange change(int i, double angle) const { return {angle - hinges_[i].rest_angle}; }
  double energy(int i, Positions x) const {
    const double e = change(i, angle(i, x)).change;
    return 0.5 * hinges_[i].stiffness * e * e;
  }

  std::vector<double> areas_;  // of the triangles at rest [m^2]
};

class Creases final : public HingeTerm<Energy>, public InternalVariables, public BendingElements {
 public:
  Creases(std::string name, std::vector<Hinge> hinges, std::vector<double> limits, std::vector<double> volumes,
          const InternalRange& range)
      : HingeTerm(std::move(hinges)),
        name_(std::move(name)),
        limits_(std::move(limits)),
        volumes_(std::move(volumes)),
        range_(range) {}

  std::string_view name() const override { return name_; }
  std::unique_ptr<Context> make_context() const override {
    auto start = std::make_unique<Start>();
    start->angles.resize(hinges_.size());
    return start;
  }
  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    Start& start = static_cast<Start&>(context);
    parallel_for(count(), [&](int i) { start.angles[i] = angle(i, step.start); });
    begin_internal({}, step.h, context);
  }

  InternalRange internal_range() const override { return range_; }
  void write_initial(Positions x, std::span<double> z) const override {
    std::fill(z.begin(), z.end(), 0.0);
    for (int i = 0; i < count(); ++i) z[hinges_[i].side] = angle(i, x) - hinges_[i].rest_angle;
  }
  void begin_internal(std::span<const double> z, double, const Context& context) const override {
    const Start& start = static_cast<const Start&>(context);
    start.z = z;
    start.stored = z.empty() ? 0 : stored_energy(z);
  }
  void end_internal(Positions x, const Context& context, std::span<double> z) const override {
    std::fill(z.begin(), z.end(), 0.0);
    for (int i = 0; i < count(); ++i) z[hinges_[i].side] = elastic(i, angle(i, x), context).change;
  }
  double stored_energy(std::span<const double> z) const override {
    return sum([&](int i) { return energy(i, z[hinges_[i].side]); });
  }
  void add_bending_density(Positions, std::span<const double> z, std::span<double> density) const override {
    for (int i = 0; i < count(); ++i) {
      const double share = 0.5 * energy(i, z[hinges_[i].side]);
      for (const int t : hinges_[i].triangles) density[range_.first_tet + t] += share / volumes_[t];
    }
  }
  InternalEnergies internal_energies(const InternalStep& step, const Context& context) const override {
    const double work = sum([&](int i) {
      const auto [angle, gradient] = hinge_gradient(corners_at(step.end, hinges_[i].vertices));
      double change = 0;
      for (int u = 0; u < 4; ++u)
        change +=
            dot(gradient[u], vec_at(step.end, hinges_[i].vertices[u]) - vec_at(step.start, hinges_[i].vertices[u]));
      return hinges_[i].stiffness * elastic(i, angle, context).change * change;
    });
    const double loss = sum([&](int i) { return this->loss(i, trial(i, angle(i, step.end), context)); });
    return {work, stored_energy(step.z_end) - static_cast<const Start&>(context).stored, loss};
  }

  double value(Positions x, const Context& context) const override {
    return sum([&](int i) {
             const double t = trial(i, angle(i, x), context);
             return energy(i, std::clamp(t, -limits_[i], limits_[i])) + loss(i, t);
           }) -
           static_cast<const Start&>(context).stored;
  }
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    add_torques(x, scale, g, [&](int i, double angle) { return elastic(i, angle, context); });
  }
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return add_stiffness(x, scale, projection, H, [&](int i, double angle) { return elastic(i, angle, context); });
  }

 private:
  struct Start : Context {
    std::vector<double> angles;
    mutable std::span<const double> z;  // see begin_internal()
    mutable double stored = 0;          // [J]
  };

  // Returns theta - theta0 with the rest angle of the start of the step.
  double trial(int i, double angle, const Context& context) const {
    const Start& start = static_cast<const Start&>(context);
    const double change = std::remainder(angle - start.angles[i], 2 * std::numbers::pi);
    return (start.z.empty() ? 0 : start.z[hinges_[i].side]) + change;
  }
  ElasticChange elastic(int i, double angle, const Context& context) const {
    const double t = trial(i, angle, context);
    if (!(std::abs(t) > limits_[i])) return {t, 1};
    return {std::copysign(limits_[i], t), 0};
  }
  double energy(int i, double change) const { return 0.5 * hinges_[i].stiffness * change * change; }
  double loss(int i, double trial) const {
    return hinges_[i].stiffness * limits_[i] * std::max(std::abs(trial) - limits_[i], 0.0);
  }

  std::string name_;
  std::vector<double> limits_;   // largest elastic change of each angle
  std::vector<double> volumes_;  // of the triangles at rest [m^3]
  InternalRange range_;
};

HingeList list_of_hinges(std::span<const Vec3d> rest, std::span<const Triangle> triangles,
                         std::span<const double> moment, RestAngles rest_angles) {
  ASPIC_CHECK(moment.size() == triangles.size());
  HingeList list(rest, triangles, moment);
  std::vector<Side> sides = sorted_sides(triangles);
  for (auto first = sides.begin(); first != sides.end();) {
    const auto last =
        std::find_if(first, sides.end(), [&](const Side& side) { return side.a != first->a || side.b != first->b; });
    list.add_edge({&*first, static_cast<size_t>(last - first)}, rest_angles);
    first = last;
  }
  return list;
}

}  // namespace

std::unique_ptr<HingeBending> make_hinge_bending(std::span<const Vec3d> rest, std::span<const Triangle> triangles,
                                                 std::span<const double> moment, RestAngles rest_angles) {
  return std::make_unique<SheetBending>(list_of_hinges(rest, triangles, moment, rest_angles));
}

std::unique_ptr<Energy> make_creases(std::string name, const CreasedSheet& sheet) {
  const auto& X = sheet.mesh.rest;
  const std::span<const Triangle> triangles(&sheet.mesh.sheet[sheet.first], sheet.moment.size());
  const HingeList list = list_of_hinges(X, triangles, sheet.moment, sheet.rest);
  std::vector<Hinge> hinges = list.hinges();
  std::vector<double> limits, volumes = list.areas();
  for (size_t t = 0; t < volumes.size(); ++t) volumes[t] *= sheet.mesh.thickness[sheet.first + t];
  for (const Hinge& hinge : hinges)
    limits.push_back(sheet.yield * norm(X[hinge.vertices[1]] - X[hinge.vertices[0]]) / hinge.stiffness);
  const InternalRange range{sheet.mesh.tet_count() + sheet.first, static_cast<int>(triangles.size()), 3};
  return std::make_unique<Creases>(std::move(name), std::move(hinges), std::move(limits), std::move(volumes), range);
}

}  // namespace aspic

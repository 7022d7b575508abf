#include "energy/membrane.h"

#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/parallel.h"
#include "energy/element_groups.h"
#include "energy/membrane_law.h"
#include "math/vectors.h"

namespace aspic {
namespace {

// Axis a and b of the rest plane of three points.
struct PlaneAxes {
  Vec3d a, b;

  explicit PlaneAxes(const std::array<Vec3d, 3>& rest) {
    const Vec3d e = rest[1] - rest[0], n = cross(e, rest[2] - rest[0]), m = cross(n, e);
    a = (1 / norm(e)) * e;
    b = (1 / norm(m)) * m;
  }
};

// Returns the matrix that turns components in the rest plane into those along the warp and across it.
std::array<double, 4> warp_axes(const MembraneLaw& law) {
  const auto* woven = std::get_if<OrthotropicSheet>(&law);
  if (!woven) return {1, 0, 0, 1};
  const auto& [c, s] = woven->warp;
  return {c, -s, s, c};
}

double thickness_of(const MembraneLaw& law) {
  return std::visit([](const auto& sheet) { return sheet.thickness; }, law);
}

// A triangle with its law, in the axes of the warp.
struct Element {
  Triangle corners;
  double b[3][2];  // gradients of the shape functions: F = sum x_u b_u' [1/m]
  double area, thickness;
  SheetModuli moduli;

  Element(const SheetTriangle& triangle, const MembraneLaw& law)
      : corners(triangle.corners), area(triangle.area), thickness(thickness_of(law)), moduli(law) {
    ASPIC_CHECK(area > 0);
    const std::array<double, 4>&inverse = triangle.rest_inverse, axes = warp_axes(law);
    for (int u = 0; u < 2; ++u)
      for (int r = 0; r < 2; ++r) b[u + 1][r] = inverse[u] * axes[r] + inverse[u + 2] * axes[r + 2];
    for (int r = 0; r < 2; ++r) b[0][r] = -(b[1][r] + b[2][r]);
  }

  double weight() const { return area * thickness; }

  SheetDeformation deformation(Positions x) const {
    const Vec3d origin = vec_at(x, corners[0]), d1 = vec_at(x, corners[1]) - origin,
                d2 = vec_at(x, corners[2]) - origin;
    return {b[1][0] * d1 + b[2][0] * d2, b[1][1] * d1 + b[2][1] * d2};
  }
};

// The blocks of an element, d2V/dx_u dx_v.
class SheetBlocks {
 public:
  SheetBlocks(const Element& e, const SheetFrame& frame, const SheetHessian& H) {
    const Mat3d axes = from_columns(frame.t1, frame.t2, frame.n);
    for (int v = 1; v < 3; ++v)
      for (int u = 1; u <= v; ++u) K_[u][v] = axes * local(e.b[u], e.b[v], H) * transpose(axes);
    K_[2][1] = transpose(K_[1][2]);
    for (int v = 1; v < 3; ++v) {  // translations cause no force
      K_[0][v] = -1.0 * (K_[1][v] + K_[2][v]);
      K_[v][0] = transpose(K_[0][v]);
    }
    K_[0][0] = -1.0 * (K_[0][1] + K_[0][2]);
  }

  const Mat3d& operator()(int u, int v) const { return K_[u][v]; }

 private:
  // Returns the block in the axes of the frame.
  static Mat3d local(const double (&p)[2], const double (&q)[2], const SheetHessian& H) {
    Mat3d A{};
    for (int s = 0; s < 2; ++s)
      for (int r = 0; r < 2; ++r)
        for (int d = 0; d < 2; ++d)
          for (int c = 0; c < 2; ++c) A(r, s) += p[c] * q[d] * H.in_plane[r + 2 * c + 4 * (s + 2 * d)];
    const Sym2& S = H.normal;
    A(2, 2) = p[0] * q[0] * S.xx + p[1] * q[1] * S.yy + (p[0] * q[1] + p[1] * q[0]) * S.xy;
    return A;
  }

  Mat3d K_[3][3];
};

class SheetMembrane : public Membrane {
 public:
  SheetMembrane(const std::vector<SheetTriangle>& triangles, const std::vector<MembraneLaw>& laws) {
    ASPIC_CHECK(triangles.size() == laws.size());
    std::vector<Triangle> corners;
    elements_.reserve(triangles.size());
    for (size_t t = 0; t < triangles.size(); ++t) {
      elements_.emplace_back(triangles[t], laws[t]);
      corners.push_back(triangles[t].corners);
    }
    groups_ = ElementGroups(corners);
  }

  std::string_view name() const override { return "membrane"; }

  double value(Positions x, const Context&) const override {
    const double V = parallel_sum(count(), [&](int first, int last) {
      double sum = 0;
      for (int t = first; t < last; ++t)
        sum += elements_[t].weight() * elements_[t].moduli.density(elements_[t].deformation(x));
      return sum;
    });
    return std::isnan(V) ? std::numeric_limits<double>::infinity() : V;
  }

  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    groups_.for_each([&](int t) {
      const Element& e = elements_[t];
      const SheetDeformation d = e.deformation(x);
      const Sym2 S = e.moduli.stress(d);
      const double weight = scale * e.weight();
      const auto force = [&](int u) {  // weight F S b_u
        const double a = S.xx * e.b[u][0] + S.xy * e.b[u][1], b = S.xy * e.b[u][0] + S.yy * e.b[u][1];
        return (weight * a) * d.f1 + (weight * b) * d.f2;
      };
      const Vec3d g1 = force(1), g2 = force(2);
      add_vec(-1.0 * (g1 + g2), e.corners[0], g);
      add_vec(g1, e.corners[1], g);
      add_vec(g2, e.corners[2], g);
    });
  }

  void add_couplings(Couplings& couplings) const override {
    for (const Element& e : elements_) aspic::add_couplings(e.corners, couplings);
  }
  void bind(const BlockPattern& pattern) override {
    blocks_.resize(elements_.size());
    parallel_for(count(), [&](int t) { blocks_[t].bind(elements_[t].corners, pattern); });
  }

  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return groups_.count_if([&](int t) {
      const Element& e = elements_[t];
      const SheetDeformation d = e.deformation(x);
      const SheetFrame frame(d);
      SheetHessian A = e.moduli.hessian(d, frame);
      const bool is_modified = is_covered(e.corners, projection) && e.moduli.project(d, frame, projection.kind, A);
      e.moduli.add_limit(d, frame, A);
      blocks_[t].add(SheetBlocks(e, frame, A), scale * e.weight(), H);
      return is_modified;
    });
  }

  void evaluate(Positions x, MembraneFields& fields) const override {
    fields.stretch.resize(elements_.size());
    fields.energy_density.resize(elements_.size());
    fields.stress.resize(elements_.size());
    parallel_for(count(), [&](int t) {
      const Element& e = elements_[t];
      const SheetDeformation d = e.deformation(x);
      const Eigen2 C = symmetric_eigen(d.C);
      const double longest = std::sqrt(C.high);
      fields.stretch[t] = {longest, longest > 0 ? d.J / longest : 0};
      fields.energy_density[t] = e.thickness * e.moduli.density(d);
      const Eigen2 stress = symmetric_eigen(cauchy(d, e.moduli.stress(d)));
      fields.stress[t] = {stress.high, stress.low};
    });
  }

 private:
  int count() const { return static_cast<int>(elements_.size()); }

  // F S F' / J in the tangent plane.
  static Sym2 cauchy(const SheetDeformation& d, const Sym2& S) {
    const std::array<double, 4> G = SheetFrame(d).G;
    const double a = S.xx * G[0] + S.xy * G[2], b = S.xy * G[0] + S.yy * G[2];  // row 1 of G S
    return {(a * G[0] + b * G[2]) / d.J, S.yy * G[3] * G[3] / d.J, b * G[3] / d.J};
  }

  std::vector<Element> elements_;
  std::vector<ElementBlocks<3>> blocks_;
  ElementGroups groups_;
};

}  // namespace

SheetTriangle make_sheet_triangle(const Triangle& corners, const std::array<PlaneVector, 3>& pattern) {
  const double ax = pattern[1][0] - pattern[0][0], ay = pattern[1][1] - pattern[0][1];
  const double bx = pattern[2][0] - pattern[0][0], by = pattern[2][1] - pattern[0][1];
  const double det = ax * by - ay * bx, s = 1 / det;
  return {corners, {s * by, -s * ay, -s * bx, s * ax}, 0.5 * std::abs(det)};
}

SheetTriangle make_sheet_triangle(const Triangle& corners, const std::array<Vec3d, 3>& rest) {
  const PlaneAxes axes(rest);
  const auto in_plane = [&](int u) {
    const Vec3d d = rest[u] - rest[0];
    return PlaneVector{dot(axes.a, d), u == 1 ? 0 : dot(axes.b, d)};
  };
  return make_sheet_triangle(corners, std::array<PlaneVector, 3>{PlaneVector{0, 0}, in_plane(1), in_plane(2)});
}

PlaneVector direction_in_plane(const std::array<Vec3d, 3>& rest, const Vec3d& direction) {
  const PlaneAxes axes(rest);
  const double a = dot(axes.a, direction), b = dot(axes.b, direction), length = std::hypot(a, b);
  return length > 0 ? PlaneVector{a / length, b / length} : PlaneVector{1, 0};
}

std::unique_ptr<Membrane> make_membrane(const std::vector<SheetTriangle>& triangles,
                                        const std::vector<MembraneLaw>& laws) {
  return std::make_unique<SheetMembrane>(triangles, laws);
}

}  // namespace aspic

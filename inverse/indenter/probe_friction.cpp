#include "indenter/probe_friction.h"

#include <algorithm>
#include <cmath>

#include "indenter/indenter_depth.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kWidth = 1e-3;  // e / radius: the creep of points that stick

// f'(y) / y, and its derivative divided by y
struct Slope {
  double value, change;
};
Slope slope(double y, double e) {
  if (y < e) return {(2 - y / e) / e, y > 0 ? -1 / (e * e * y) : 0};
  return {1 / y, -1 / (y * y * y)};
}
double dissipation(double y, double e) { return y < e ? y * y / e * (1 - y / (3 * e)) : y - e / 3; }

Vec3d across(const Vec3d& n, const Vec3d& v) { return v - dot(n, v) * n; }

Vec3d sum(const TouchedPoint& point, std::span<const double> v) {
  Vec3d total{};
  for (int i = 0; i < 3; ++i) total = total + point.weights[i] * vec_at(v, point.vertices[i]);
  return total;
}
void add(const TouchedPoint& point, const Vec3d& force, std::span<double> g) {
  for (int i = 0; i < 3; ++i) add_vec(point.weights[i] * force, point.vertices[i], g);
}

// Coordinate along the axis of the surface of an indenter at rest, at a distance from the axis up to the radius.
double height(const Indenter& indenter, double r) {
  const double R = indenter.radius;
  if (indenter.shape == IndenterShape::sphere) return std::sqrt(R * R - r * r);
  const IndenterPose upright{.axis = {{0, 0, 1}}};
  double s = 0, last = 1;  // Newton's method, which descends up to round-off because the depth is concave
  while (s < last) {
    const Depth d = depth(indenter, upright, {{r, 0, s}});
    if (!(d.value < 0) || !(d.gradient[2] < 0)) break;
    last = s;
    s -= d.value / d.gradient[2];
  }
  return s;
}

}  // namespace

// A point in contact with lagged coefficients.
struct ProbeFriction::Slider {
  TouchedPoint point;
  Vec3d anchor{}, normal{};
  double force = 0;  // mu N [N]

  Vec3d slip(Positions x) const { return across(normal, sum(point, x) - anchor); }
};

struct ProbeFriction::Sliders : Context {
  std::vector<Slider> all;
};

// The friction q of a point and its derivative. `lagged` is the part by N and n.
struct ProbeFriction::Traction {
  Vec3d force{};
  Mat3d product{}, lagged{};
};

ProbeFriction::ProbeFriction(const TetMesh& mesh, const Probe& probe, const Indenter& indenter,
                             const IndenterPose& touch)
    : mesh_(mesh), probe_(probe), indenter_(indenter), touch_(touch), width_(kWidth * indenter.radius) {}

Vec3d ProbeFriction::anchor(const TouchedPoint& point) const {
  Vec3d X{};
  for (int i = 0; i < 3; ++i) X = X + point.weights[i] * mesh_.rest[point.vertices[i]];
  const Vec3d& axis = touch_.pose.axis;
  Vec3d offset = across(axis, X - touch_.pose.center);
  const double r = norm(offset);
  if (r > indenter_.radius) offset = (indenter_.radius / r) * offset;  // the indenter passes it
  offset = offset + height(indenter_, std::min(r, indenter_.radius)) * axis;
  const PlacedIndenter& placed = probe_.placed();
  return placed.pose.center + placed.turn * offset;
}

ProbeFriction::Slider ProbeFriction::slider_of(const TouchedPoint& point) const {
  const double N = norm(point.gradient);
  const Vec3d normal = N > 0 ? (1 / N) * point.gradient : Vec3d{};
  return {point, anchor(point), normal, indenter_.friction * N};
}

// With u = T w, w = p - a, s = f'(y) / y and H the Hessian of the probe: dN = n'H dp, dn = T H dp / N,
// du = T dp - (n.w) dn - n (dn.w), dq = mu (s u dN + N (s du + ds/dy/y u u'du)).
ProbeFriction::Traction ProbeFriction::traction_of(const TouchedPoint& point) const {
  const double N = norm(point.gradient);
  if (!(N > 0)) return {};
  const auto [own, a, n, force] = slider_of(point);
  const Vec3d w = point.position - a, u = across(n, w);
  const Slope s = slope(norm(u), width_);
  const Mat3d I = identity3<double>(), T = I - outer(n, n);
  const Mat3d M = force * (s.value * I + s.change * outer(u, u));
  const Mat3d dn = (1 / N) * (T * point.hessian);
  const Mat3d du = dot(n, w) * dn + outer(n, transpose(dn) * w);
  Traction traction;
  traction.force = force * s.value * u;
  traction.lagged = indenter_.friction * s.value * outer(u, transpose(point.hessian) * n) - M * du;
  traction.product = traction.lagged + M * T;
  return traction;
}

std::unique_ptr<Energy::Context> ProbeFriction::make_context() const { return std::make_unique<Sliders>(); }

void ProbeFriction::begin_step(const StepContext& step, Context& context) const {
  Energy::begin_step(step, context);
  update_lagged(step.start, false, context);
}

void ProbeFriction::update_lagged(Positions x, bool, Context& context) const {
  std::vector<Slider>& all = static_cast<Sliders&>(context).all;
  all.clear();
  probe_.visit_touched(x, [&](const TouchedPoint& point) { all.push_back(slider_of(point)); });
}

double ProbeFriction::value(Positions x, const Context& context) const {
  double D = 0;
  for (const Slider& slider : static_cast<const Sliders&>(context).all)
    D += slider.force * dissipation(norm(slider.slip(x)), width_);
  return D;
}

void ProbeFriction::add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const {
  for (const Slider& slider : static_cast<const Sliders&>(context).all) {
    const Vec3d u = slider.slip(x);
    add(slider.point, scale * slider.force * slope(norm(u), width_).value * u, g);
  }
}

// f is convex, so the Hessian needs no modification.
int ProbeFriction::add_hessian(Positions x, const Context& context, double scale, const Projection&,
                               BlockSparse& H) const {
  for (const auto& [point, anchor, n, force] : static_cast<const Sliders&>(context).all) {
    const Vec3d u = across(n, sum(point, x) - anchor);
    const Slope s = slope(norm(u), width_);
    const Mat3d K = (scale * force) * (s.value * (identity3<double>() - outer(n, n)) + s.change * outer(u, u));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (const int row = point.vertices[i], column = point.vertices[j]; column <= row) {
          Mat3d& block = H.block[pattern_->slot(row, column)];
          block = block + (point.weights[i] * point.weights[j]) * K;
        }
  }
  return 0;
}

void ProbeFriction::add_friction(Positions x, double scale, std::span<double> g) const {
  probe_.visit_touched(x, [&](const TouchedPoint& point) { add(point, scale * traction_of(point).force, g); });
}

Wrench ProbeFriction::wrench(Positions x) const {
  Wrench total;
  probe_.visit_touched(x, [&](const TouchedPoint& point) {
    const Vec3d q = traction_of(point).force;
    total.force = total.force - q;
    total.torque = total.torque - cross(point.position - probe_.pose().center, q);
  });
  return total;
}

Wrench ProbeFriction::wrench_product(Positions x, std::span<const double> dx) const {
  Wrench total;
  probe_.visit_touched(x, [&](const TouchedPoint& point) {
    const Traction traction = traction_of(point);
    const Vec3d dp = sum(point, dx), dq = traction.product * dp;
    total.force = total.force - dq;
    total.torque = total.torque - cross(dp, traction.force) - cross(point.position - probe_.pose().center, dq);
  });
  return total;
}

void ProbeFriction::add_wrench_transposed(Positions x, const Wrench& wbar, double scale, std::span<double> xbar) const {
  probe_.visit_touched(x, [&](const TouchedPoint& point) {
    const Traction traction = traction_of(point);
    const Vec3d qbar = wbar.force + cross(wbar.torque, point.position - probe_.pose().center);
    add(point, -scale * (cross(traction.force, wbar.torque) + transpose(traction.product) * qbar), xbar);
  });
}

// q turns with common rigid motions v of body and indenter, so its change with the pose alone is turn x q - dq/dp v.
void ProbeFriction::add_pose_product(Positions x, const Vec3d& velocity, const Vec3d& turn, double scale,
                                     std::span<double> g) const {
  probe_.visit_touched(x, [&](const TouchedPoint& point) {
    const Traction traction = traction_of(point);
    const Vec3d v = velocity + cross(turn, point.position - probe_.pose().center);
    add(point, scale * (cross(turn, traction.force) - traction.product * v), g);
  });
}

void ProbeFriction::add_lagged_product(Positions x, std::span<const double> dx, double scale,
                                       std::span<double> g) const {
  probe_.visit_touched(
      x, [&](const TouchedPoint& point) { add(point, scale * (traction_of(point).lagged * sum(point, dx)), g); });
}

void ProbeFriction::add_lagged_transposed(Positions x, std::span<const double> w, double scale,
                                          std::span<double> xbar) const {
  probe_.visit_touched(x, [&](const TouchedPoint& point) {
    add(point, scale * (transpose(traction_of(point).lagged) * sum(point, w)), xbar);
  });
}

}  // namespace aspic

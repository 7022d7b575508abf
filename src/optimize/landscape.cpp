#include "optimize/landscape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace aspic {
namespace {

using Vector = std::vector<double>;

double between(double first, double last, int i, int samples) { return first + (last - first) * i / (samples - 1); }

const BlockSparse& exact_hessian(const LiveIteration& at) { return at.E.hessian(at.x, {Definiteness::exact}); }

Vector product(const BlockSparse& H, std::span<const double> u) {
  Vector Hu(u.size());
  H.multiply(u, Hu);
  return Hu;
}

// Returns the component of u orthogonal to d, scaled to the length of d; empty if u is parallel to d.
Vector across(Objective& E, std::span<const double> u, std::span<const double> d) {
  const double dd = E.dot(d, d), along = E.dot(u, d) / dd;
  Vector v(u.size());
  for (size_t i = 0; i < v.size(); ++i) v[i] = u[i] - along * d[i];
  const double vv = E.dot(v, v);
  if (!(vv > 1e-16 * E.dot(u, u))) return {};
  for (double& vi : v) vi *= std::sqrt(dd / vv);
  return v;
}

Vector across_direction(const LiveIteration& at, const BlockSparse& H) {
  Vector downhill(at.g.begin(), at.g.end());
  for (double& gi : downhill) gi = -gi;
  Vector v = across(at.E, downhill, at.d);
  if (v.empty()) v = across(at.E, product(H, at.g), at.d);
  if (v.empty()) v.assign(at.d.size(), 0.0);  // E is isotropic here: all planes through d are equal
  return v;
}

// Places half of the samples around the accepted step if the longest trial is much longer.
Vector samples_along(const LiveIteration& at, int samples) {
  double last = at.tried.empty() ? 1 : 1.25 * at.alpha;
  for (const Trial& trial : at.tried) last = std::max(last, 1.25 * trial.alpha);
  const int around = at.alpha > 0 && last > 6 * at.alpha && samples >= 8 ? samples / 2 : 0;
  Vector alphas;
  for (int i = 0; i < around; ++i) alphas.push_back(between(-0.5 * at.alpha, 3 * at.alpha, i, around));
  for (int i = 0; i < samples - around; ++i) alphas.push_back(between(-0.2 * last, last, i, samples - around));
  std::sort(alphas.begin(), alphas.end());
  return alphas;
}

bool is_free(Objective& E, std::span<const double> x, std::span<const double> d) { return E.max_step(x, d) >= 1; }

}  // namespace

double largest_step(const LiveIteration& at, double last) {
  if (const double step = at.E.max_step(at.x, at.d); step < std::min(1.0, last)) return step;
  Vector d(at.d.begin(), at.d.end());
  for (double& di : d) di *= last;
  const double step = at.E.max_step(at.x, d);
  return step < 1 ? step * last : std::numeric_limits<double>::infinity();
}

std::vector<CurvePoint> curve_along(const LiveIteration& at, double c, int samples, const StopToken& stop) {
  ASPIC_CHECK(samples >= 2);
  const double slope = at.E.dot(at.g, at.d), curvature = at.E.dot(at.d, product(exact_hessian(at), at.d));
  const Vector alphas = samples_along(at, samples);
  const double upper = largest_step(at, alphas.back());
  std::vector<CurvePoint> curve(samples);
  Vector x(at.x.size()), back(at.d.begin(), at.d.end());
  for (double& di : back) di *= alphas.front();
  const double lower = is_free(at.E, at.x, back) ? alphas.front() : 0;
  for (int i = 0; i < samples; ++i) {
    if (stop.stopped()) return {};
    CurvePoint& point = curve[i];
    const double alpha = point.alpha = alphas[i];
    for (size_t k = 0; k < x.size(); ++k) x[k] = at.x[k] + alpha * at.d[k];
    point.value = alpha < lower || alpha > upper ? std::numeric_limits<double>::infinity() : at.E.value(x);
    point.model = at.value + alpha * slope + alpha * alpha / 2 * curvature;
    point.textbook_bound = at.value + c * alpha * slope;
    point.slide_bound = at.value + c * slope;
  }
  return curve;
}

Slice slice_through(const LiveIteration& at, int samples, const StopToken& stop) {
  ASPIC_CHECK(samples >= 2);
  Objective& E = at.E;
  const BlockSparse& H = exact_hessian(at);
  Vector v = across_direction(at, H);
  const Vector Hd = product(H, at.d), Hv = product(H, v);
  const double gd = E.dot(at.g, at.d), gv = E.dot(at.g, v);
  const double dHd = E.dot(at.d, Hd), dHv = E.dot(v, Hd), vHv = E.dot(v, Hv);
  Slice slice{samples, samples, {}, {}};
  Vector x(at.x.size()), d(at.x.size());
  for (int row = 0; row < samples; ++row)
    for (int column = 0; column < samples; ++column) {
      if (stop.stopped()) return {};
      const double s = between(-0.5, 1.5, column, samples), t = between(-1, 1, row, samples);
      for (size_t k = 0; k < x.size(); ++k) d[k] = s * at.d[k] + t * v[k];
      for (size_t k = 0; k < x.size(); ++k) x[k] = at.x[k] + d[k];
      const bool is_blocked = !is_free(E, at.x, d);
      slice.point.push_back({s, t, is_blocked ? std::numeric_limits<double>::infinity() : E.value(x),
                             at.value + s * gd + t * gv + s * s / 2 * dHd + s * t * dHv + t * t / 2 * vHv, is_blocked});
    }
  slice.across = std::move(v);
  return slice;
}

}  // namespace aspic

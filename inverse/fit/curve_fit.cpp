#include "fit/curve_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "base/formatted.h"
#include "fit/quantity.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kMinRelative = 0.05;  // relative to the largest stress; floor of relative errors
constexpr double kPowers = 100;        // larger ranges use logarithms

constexpr double kInf = std::numeric_limits<double>::infinity();

void check(const TestCurve& curve) {
  const std::string where = "curve '" + curve.name + "': ";
  if (curve.stretch.empty() || curve.stretch.size() != curve.stress.size())
    throw InvalidInput(where + "has " + std::to_string(curve.stretch.size()) + " stretches and " +
                       std::to_string(curve.stress.size()) + " stresses; give the same number of each");
  for (size_t i = 0; i < curve.stretch.size(); ++i) {
    const bool positive = curve.deformation == Deformation::simple_shear || curve.stretch[i] > 0;
    if (!std::isfinite(curve.stretch[i]) || !positive || std::abs(curve.stretch[i]) > 1e3)
      throw InvalidInput(where + "point " + std::to_string(i + 1) + " has the stretch " + six_digits(curve.stretch[i]) +
                         "; give length over rest length, 1 at rest");
    if (!std::isfinite(curve.stress[i]))
      throw InvalidInput(where + "point " + std::to_string(i + 1) + " has no finite stress");
  }
  if (!(max_abs(curve.stress) > 0)) throw InvalidInput(where + "all stresses are 0; there is nothing to fit");
}

double lambda_of(double mu, double poisson) { return 2 * mu * poisson / (1 - 2 * poisson); }

double scale_of(const TestCurve& curve, size_t point, Weighting weighting, double scatter) {
  if (weighting == Weighting::absolute) return scatter;
  if (weighting == Weighting::balanced) return std::sqrt(squared_norm(curve.stress));
  return std::fmax(std::abs(curve.stress[point]), kMinRelative * max_abs(curve.stress));
}

struct Squares {
  double residual = 0, measured = 0, sum = 0, about_mean = 0;
  size_t count = 0;

  void add(const std::vector<double>& measured_stress, std::span<const double> predicted) {
    for (size_t i = 0; i < measured_stress.size(); ++i) {
      const double m = measured_stress[i], e = predicted[i] - m;
      residual += e * e, measured += m * m, sum += m, ++count;
    }
    about_mean = measured - sum * sum / static_cast<double>(count);
  }
  double relative() const { return std::sqrt(residual / measured); }
  double r_squared() const { return about_mean > 0 ? 1 - residual / about_mean : std::nan(""); }
};

CurveErrors errors_of(const TestCurve& curve, std::span<const double> predicted) {
  CurveErrors e{.name = curve.name, .predicted = {predicted.begin(), predicted.end()}};
  Squares squares;
  squares.add(curve.stress, predicted);
  e.rms = std::sqrt(squares.residual / static_cast<double>(squares.count));
  e.relative = squares.relative();
  e.r_squared = squares.r_squared();
  for (size_t i = 0; i < predicted.size(); ++i)
    e.largest = std::fmax(e.largest, std::abs(predicted[i] - curve.stress[i]) / max_abs(curve.stress));
  return e;
}

}  // namespace

CurveMisfit::CurveMisfit(const std::vector<TestCurve>& curves, const CurveFitOptions& options)
    : curves_(curves), options_(options), info_(material_info(options.material)) {
  if (curves.empty()) throw InvalidInput("there is no curve to fit");
  if (fibre_components(info_.name))
    throw InvalidInput("the model " + info_.name +
                       " is anisotropic; curves need an isotropic one (`aspic fit` finds fibres from motions)");
  for (const TestCurve& curve : curves) check(curve);
  if (!(options.poisson > -1 && options.poisson < 0.5))
    throw InvalidInput("poisson = " + six_digits(options.poisson) + " must lie between -1 and 0.5 (try 0.49)");
  std::vector<std::string> names;
  for (const ExtraParameter& extra : info_.extra) names.push_back(extra.name);
  for (const std::string& held : options.held)
    if (std::find(names.begin(), names.end(), held) == names.end())
      throw InvalidInput("'" + held + "' is not a parameter of " + info_.name + suggestion(held, names));
  bounds_.push_back({-kInf, kInf});
  for (size_t k = 0; k < names.size(); ++k) {
    if (std::count(options.held.begin(), options.held.end(), names[k])) continue;
    const ExtraParameter& extra = info_.extra[k];
    const bool is_log = extra.min > 0 && extra.max > kPowers * extra.min;
    own_.push_back({static_cast<int>(k), is_log});
    bounds_.push_back(is_log ? Bounds{std::log(extra.min), std::log(extra.max)} : Bounds{extra.min, extra.max});
  }
  set_scale();
}

void CurveMisfit::set_scale() {
  double sum = 0, count = 0;
  for (const TestCurve& curve : curves_) sum += squared_norm(curve.stress), count += curve.stress.size();
  const double scatter = std::sqrt(sum / count);
  for (const TestCurve& curve : curves_)
    for (size_t i = 0; i < curve.stretch.size(); ++i) scale_.push_back(scale_of(curve, i, options_.weighting, scatter));
}

MaterialParameters CurveMisfit::parameters(std::span<const double> p) const {
  MaterialParameters m;
  m.lame.mu = std::exp(p[0]);
  m.lame.lambda = lambda_of(m.lame.mu, options_.poisson);
  for (size_t k = 0; k < info_.extra.size(); ++k) m.extra[k] = info_.extra[k].fallback;
  for (size_t k = 0; k < own_.size(); ++k) m.extra[own_[k].index] = own_[k].is_log ? std::exp(p[k + 1]) : p[k + 1];
  return m;
}

bool CurveMisfit::evaluate(std::span<const double> p, std::span<double> r) {
  const MaterialParameters m = parameters(p);
  const size_t n = bounds_.size();
  std::vector<double> predicted, jacobian;
  for (const TestCurve& curve : curves_)
    for (size_t i = 0; i < curve.stretch.size(); ++i) {
      const HomogeneousState s = homogeneous_state(info_.name, m, curve.deformation, curve.stretch[i], options_.volume);
      if (!s.is_found) return false;
      const double weight = 1 / scale_[predicted.size()];
      r[predicted.size()] = weight * (s.stress - curve.stress[i]);
      predicted.push_back(s.stress);
      jacobian.push_back(weight * (m.lame.mu * s.slopes[0] + m.lame.lambda * s.slopes[1]));
      for (size_t k = 1; k < n; ++k) {
        const Own& own = own_[k - 1];
        jacobian.push_back(weight * s.slopes[2 + own.index] * (own.is_log ? m.extra[own.index] : 1));
      }
    }
  predicted_ = std::move(predicted);
  jacobian_ = std::move(jacobian);
  return true;
}

void CurveMisfit::multiply(std::span<const double> dp, std::span<double> dr) {
  const size_t n = bounds_.size();
  for (size_t i = 0; i < scale_.size(); ++i) {
    dr[i] = 0;
    for (size_t k = 0; k < n; ++k) dr[i] += jacobian_[i * n + k] * dp[k];
  }
}
void CurveMisfit::multiply_transposed(std::span<const double> w, std::span<double> pbar) {
  const size_t n = bounds_.size();
  for (size_t k = 0; k < n; ++k) {
    pbar[k] = 0;
    for (size_t i = 0; i < scale_.size(); ++i) pbar[k] += jacobian_[i * n + k] * w[i];
  }
}

// Estimate for a neo-Hookean solid, whose stress is proportional to mu.
double CurveMisfit::fitted_shear() const {
  double product = 0, square = 0;
  size_t at = 0;
  for (const TestCurve& curve : curves_)
    for (size_t i = 0; i < curve.stretch.size(); ++i, ++at) {
      const HomogeneousState unit = homogeneous_state("neo_hookean_isochoric", {{1, 1}, {}}, curve.deformation,
                                                      curve.stretch[i], Volume::incompressible);
      const double weight = 1 / (scale_[at] * scale_[at]);
      product += weight * unit.stress * curve.stress[i];
      square += weight * unit.stress * unit.stress;
    }
  if (!(product > 0))
    throw InvalidInput(
        "stresses and stretches have opposite signs; use one sign convention: l > 1 and "
        "stress > 0 in tension");
  return product / square;
}

std::vector<double> CurveMisfit::guess(int start) const {
  std::vector<double> p{std::log(fitted_shear())};
  std::mt19937 random(static_cast<unsigned>(start));
  std::uniform_real_distribution<double> unit(0, 1);
  for (size_t k = 0; k < own_.size(); ++k) {
    const ExtraParameter& extra = info_.extra[own_[k].index];
    double value = extra.fallback;
    if (start > 0 && extra.max - extra.min >= kPowers) {
      value = std::pow(10.0, 3 * unit(random) - 2);  // 0.01 to 10
      if (extra.min < 0 && unit(random) < 0.5) value = -value;
    } else if (start > 0)
      value = extra.min + unit(random) * (extra.max - extra.min);
    value = std::clamp(value, extra.min, extra.max);
    p.push_back(own_[k].is_log ? std::log(value) : value);
  }
  return p;
}

std::vector<FittedParameter> CurveMisfit::described(const BoundedFit& fit) const {
  const double young = 2 * (1 + options_.poisson) * std::exp(fit.p[0]);
  std::vector<FittedParameter> list{{.name = "young", .unit = "Pa", .value = young, .sigma = young * fit.sigma[0]}};
  const MaterialParameters m = parameters(fit.p);
  for (size_t k = 0; k < info_.extra.size(); ++k) {
    const ExtraParameter& extra = info_.extra[k];
    FittedParameter f{.name = extra.name, .unit = extra.unit, .value = m.extra[k], .is_held = true};
    for (size_t o = 0; o < own_.size(); ++o)
      if (own_[o].index == static_cast<int>(k)) {
        f.is_held = false;
        f.at_bound = fit.at_bound[o + 1];
        f.sigma = fit.sigma[o + 1] * (own_[o].is_log ? f.value : 1);
      }
    list.push_back(std::move(f));
  }
  return list;
}

CurveFit fit_curves(const std::vector<TestCurve>& curves, const CurveFitOptions& options) {
  CurveMisfit misfit(curves, options);
  CurveFit result{.material = options.material, .parameters = {}, .poisson = options.poisson};
  BoundedFit best;
  best.objective = kInf;
  const int starts = misfit.parameter_count() > 1 ? std::max(1, options.starts) : 1;
  for (int start = 0; start < starts; ++start) {
    BoundedFit fit = minimize_within(misfit, misfit.guess(start), misfit.bounds());
    result.starts.push_back(fit.p.empty() ? kInf : fit.objective);
    if (!fit.p.empty() && fit.objective < best.objective) best = std::move(fit);
  }
  if (best.p.empty())
    throw InvalidInput(options.material +
                       " has no state of free faces at some stretch of the curves; choose another "
                       "material or its incompressible limit");
  std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
  misfit.evaluate(best.p, r);
  result.parameters = misfit.parameters(best.p);
  result.fitted = misfit.described(best);
  result.is_converged = best.is_converged;
  result.iterations = best.iterations;
  Squares all;
  std::span<const double> predicted = misfit.predicted();
  for (const TestCurve& curve : curves) {
    const auto own = predicted.first(curve.stress.size());
    predicted = predicted.subspan(own.size());
    result.curves.push_back(errors_of(curve, own));
    all.add(curve.stress, own);
  }
  result.relative = all.relative();
  result.r_squared = all.r_squared();
  return result;
}

std::string scene_line(const CurveFit& fit) {
  std::string line = "material = { model = \"" + fit.material + "\"";
  for (const FittedParameter& f : fit.fitted) {
    line += ", " + f.name + " = " + six_digits(f.value);
    if (is_stiffness(f.name)) line += ", poisson = " + six_digits(fit.poisson);
  }
  return line + " }";
}

}  // namespace aspic

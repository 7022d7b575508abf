#include "optimize/derivative_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace aspic {
namespace {

constexpr int kDecades = 9;
// Characteristic size of a zero gradient, as a fraction of the variation over one length.
constexpr double kRestShare = 0.01;

// Errors below this value are round-off.
constexpr double kRoundOffFloor = 1e-12;

using Vector = std::vector<double>;

struct Range {
  size_t begin, end;
};

class Checker {
 public:
  Checker(const Differentiable& f, std::span<const double> x, const DerivativeCheckOptions& options)
      : f_(f), options_(options), x_(x.begin(), x.end()), g_(x.size()), ahead_(x_), behind_(x_) {
    f_.gradient(x_, g_);
    for (double gi : g_) largest_gradient_ = std::max(largest_gradient_, std::abs(gi));
    std::mt19937_64 random(options.seed);
    for (int k = 0; k < options.directions; ++k) directions_.push_back(direction(random));
    for (const Vector& d : directions_) {
      products_.emplace_back(d.size());
      f_.hessian_times(x_, d, products_.back());
    }
  }

  DerivativeReport report() {
    DerivativeReport report;
    report.gradient = checked([this](size_t k, double h) { return gradient_error(k, h); });
    name_gradient_entry(report.gradient);
    report.hessian = checked([this](size_t k, double h) { return hessian_error(k, h); });
    name_hessian_entry(report.hessian);
    return report;
  }

 private:
  Vector direction(std::mt19937_64& random) const {
    Vector d(x_.size());
    for (size_t i = 0; i < d.size(); ++i) {
      const double u = 2 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1;  // equal on all systems
      d[i] = is_fixed(i) ? 0 : u;
    }
    return d;
  }
  bool is_fixed(size_t i) const { return !options_.fixed.empty() && options_.fixed[i]; }

  // x +- h d in the entries of the range.
  void step(const Vector& d, double h, Range range) {
    std::copy(x_.begin(), x_.end(), ahead_.begin());
    std::copy(x_.begin(), x_.end(), behind_.begin());
    for (size_t i = range.begin; i < range.end; ++i) ahead_[i] += h * d[i], behind_[i] -= h * d[i];
  }
  Range all() const { return {0, x_.size()}; }

  double slope_quotient(const Vector& d, double h, Range range) {
    step(d, h, range);
    return (f_.value(ahead_) - f_.value(behind_)) / (2 * h);
  }
  Vector gradient_quotient(const Vector& d, double h, Range range) {
    step(d, h, range);
    Vector plus(x_.size()), minus(x_.size());
    f_.gradient(ahead_, plus);
    f_.gradient(behind_, minus);
    for (size_t i = 0; i < plus.size(); ++i) plus[i] = is_fixed(i) ? 0 : (plus[i] - minus[i]) / (2 * h);
    return plus;
  }

  double slope(const Vector& d, Range range) const {
    double sum = 0;
    for (size_t i = range.begin; i < range.end; ++i) sum += g_[i] * d[i];
    return sum;
  }

  double gradient_error(size_t k, double h) {
    const Vector &d = directions_[k], &Hd = products_[k];
    double scale = 0;
    for (size_t i = 0; i < d.size(); ++i)
      scale += std::abs(g_[i] * d[i]) + kRestShare * options_.length * std::abs(d[i] * Hd[i]);
    return relative(std::abs(slope_quotient(d, h, all()) - slope(d, all())), scale);
  }

  double hessian_error(size_t k, double h) {
    const Vector &d = directions_[k], &Hd = products_[k];
    const Vector quotient = gradient_quotient(d, h, all());
    double worst = 0;
    for (size_t i = 0; i < d.size(); ++i) {
      const double error = is_fixed(i) ? 0 : std::abs(quotient[i] - Hd[i]);
      worst = std::isnan(error) ? error : std::max(worst, error);
      if (std::isnan(worst)) break;
    }
    return relative(worst, hessian_scale(Hd));
  }
  double hessian_scale(const Vector& Hd) const {
    double largest = std::max(options_.negligible, kRestShare * largest_gradient_ / options_.length);
    for (size_t i = 0; i < Hd.size(); ++i)
      if (!is_fixed(i)) largest = std::max(largest, std::abs(Hd[i]));
    return largest;
  }

  static double relative(double error, double scale) { return error == 0 ? 0 : scale > 0 ? error / scale : error; }

  template <class Error>
  DerivativeCheck checked(Error error) {
    DerivativeCheck check;
    check.smallest_error = std::numeric_limits<double>::infinity();
    for (int decade = 1; decade <= kDecades; ++decade) {
      const double step = std::pow(10.0, -decade);
      double worst = 0;
      for (size_t k = 0; k < directions_.size() && !std::isnan(worst); ++k) {
        const double e = error(k, step * options_.length);
        worst = std::isfinite(e) ? std::max(worst, e) : std::numeric_limits<double>::quiet_NaN();
      }
      check.step.push_back(step);
      check.error.push_back(worst);
      if (worst < check.smallest_error) check.smallest_error = worst, best_step_ = step * options_.length;
    }
    check.order = fitted_order(check);
    check.passed = check.smallest_error <= options_.tolerance;
    return check;
  }

  // Returns the least-squares slope over the decades in which the error decreases towards its minimum and is well above
  // it.
  static double fitted_order(const DerivativeCheck& check) {
    Vector u, v;
    for (size_t i = 0; i < check.step.size() && check.error[i] != check.smallest_error; ++i) {
      if (!(check.error[i] > std::max(30 * check.smallest_error, kRoundOffFloor))) continue;
      u.push_back(std::log10(check.step[i]));
      v.push_back(std::log10(check.error[i]));
    }
    if (u.size() < 2) return std::numeric_limits<double>::quiet_NaN();
    const double n = static_cast<double>(u.size());
    double mean_u = 0, mean_v = 0, top = 0, bottom = 0;
    for (size_t i = 0; i < u.size(); ++i) mean_u += u[i] / n, mean_v += v[i] / n;
    for (size_t i = 0; i < u.size(); ++i) {
      top += (u[i] - mean_u) * (v[i] - mean_v);
      bottom += (u[i] - mean_u) * (u[i] - mean_u);
    }
    return top / bottom;
  }

  // Bisects the range of entries, keeping the half with the larger error. The last entry is wrong if any entry is.
  template <class Error>
  size_t worst_entry(Error error) const {
    Range range = all();
    while (range.end - range.begin > 1) {
      const size_t middle = range.begin + (range.end - range.begin) / 2;
      const double left = error(Range{range.begin, middle}), right = error(Range{middle, range.end});
      range = std::isnan(left) || left >= right ? Range{range.begin, middle} : Range{middle, range.end};
    }
    return range.begin;
  }

  void name_gradient_entry(DerivativeCheck& check) {
    if (!std::isfinite(check.smallest_error) || x_.empty()) return;
    const Vector& d = directions_.front();
    const size_t i =
        worst_entry([&](Range range) { return std::abs(slope_quotient(d, best_step_, range) - slope(d, range)); });
    check.row = static_cast<int>(i);
    check.found = g_[i];
    check.expected = slope_quotient(Vector(d.size(), 1.0), best_step_, {i, i + 1});
  }

  void name_hessian_entry(DerivativeCheck& check) {
    if (!std::isfinite(check.smallest_error) || x_.empty()) return;
    const Vector &d = directions_.front(), &Hd = products_.front();
    const Vector quotient = gradient_quotient(d, best_step_, all());
    size_t row = 0;
    for (size_t i = 0; i < Hd.size(); ++i)
      if (!is_fixed(i) && std::abs(quotient[i] - Hd[i]) > std::abs(quotient[row] - Hd[row])) row = i;
    check.row = static_cast<int>(row);
    check.found = Hd[row];
    check.expected = quotient[row];
    if (check.passed) return;

    const auto product_in = [&](Range range, const Vector& along) {
      Vector part(d.size()), product(d.size());
      std::copy(along.begin() + static_cast<std::ptrdiff_t>(range.begin),
                along.begin() + static_cast<std::ptrdiff_t>(range.end),
                part.begin() + static_cast<std::ptrdiff_t>(range.begin));
      f_.hessian_times(x_, part, product);
      return product[row];
    };
    const size_t column = worst_entry(
        [&](Range range) { return std::abs(gradient_quotient(d, best_step_, range)[row] - product_in(range, d)); });
    const Vector ones(d.size(), 1.0);
    check.column = static_cast<int>(column);
    check.found = product_in({column, column + 1}, ones);
    check.expected = gradient_quotient(ones, best_step_, {column, column + 1})[row];
  }

  const Differentiable& f_;
  const DerivativeCheckOptions& options_;
  Vector x_, g_, ahead_, behind_;
  double largest_gradient_ = 0, best_step_ = 0;  // results of the last check
  std::vector<Vector> directions_, products_;    // d, H d
};

}  // namespace

Differentiable differentiable(Objective& E) {
  return {.value = [&E](std::span<const double> x) { return E.value(x); },
          .gradient = [&E](std::span<const double> x, std::span<double> g) { E.gradient(x, g); },
          .hessian_times =
              [&E](std::span<const double> x, std::span<const double> d, std::span<double> Hd) {
                E.hessian(x, {}).multiply(d, Hd);
                if (const auto* dense = E.traits().dense_rows) add_product(dense->dense_rows(), d, Hd);
              }};
}

DerivativeReport check_derivatives(const Differentiable& f, std::span<const double> x,
                                   const DerivativeCheckOptions& options) {
  return Checker(f, x, options).report();
}

}  // namespace aspic

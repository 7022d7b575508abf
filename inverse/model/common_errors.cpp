#include "model/common_errors.h"
#include "math/vectors.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

// What other directions leave of a dependent one, relative to it: J has errors of 1e-9.
constexpr double kRoundOff = 1e-10;

}  // namespace

void CommonErrors::Direction::subtract(std::span<double> r) const {
  const std::span<double> part = r.subspan(static_cast<size_t>(first), unit.size());
  add_scaled(-taken * dot(unit, part), unit, part);
}

// Returns n whitened by the previous errors.
std::vector<double> CommonErrors::beside_others(int first, const std::vector<double>& n) const {
  std::vector<double> all(static_cast<size_t>(first) + n.size(), 0.0);
  std::copy(n.begin(), n.end(), all.begin() + first);
  for (const Direction& d : directions_)
    if (d.first >= first && d.first + d.unit.size() <= all.size()) d.subtract(all);
  return {all.begin() + first, all.end()};
}

// Sequentially: (I + n n')^(-1/2) = I - (1 - 1 / sqrt(1 + |n|^2)) n n' / |n|^2.
void CommonErrors::add(int first, std::vector<double> n) {
  n = beside_others(first, n);
  const double length = norm(n);
  if (!(length > 0) || !std::isfinite(length)) return;
  for (double& x : n) x /= length;
  directions_.push_back({first, std::move(n), 1 - 1 / std::hypot(1, length)});
}

void CommonErrors::add_unbounded(std::vector<double> n) {
  const double before = norm(n);
  n = beside_others(0, n);
  const double length = norm(n);
  if (!(length > kRoundOff * before) || !std::isfinite(length)) return;
  for (double& x : n) x /= length;
  directions_.push_back({0, std::move(n), 1});
}

void CommonErrors::apply(std::span<double> r) const {
  for (const Direction& d : directions_) d.subtract(r);
}

void CommonErrors::apply_transposed(std::span<double> w) const {
  for (auto d = directions_.rbegin(); d != directions_.rend(); ++d) d->subtract(w);
}

bool WithUncertainLayers::evaluate(std::span<const double> p, std::span<double> r) {
  is_linearized_ = false;
  if (!data_.evaluate(p, r)) return false;
  if (!is_known_) find_directions();
  if (!shift_.empty()) add_scaled(1, shift_, r);
  errors_.apply(r);
  return true;
}

void WithUncertainLayers::find_directions() {
  is_known_ = true;
  const bool has_nuisances = data_.nuisance_count() > 0 && linearize();
  const int nuisances = has_nuisances ? data_.nuisance_count() : 0;
  std::vector<std::vector<double>> directions(nuisances, std::vector<double>(residual_count()));
  for (int k = 0; k < nuisances; ++k) {
    data_.nuisance(k, directions[k]);
    const double sigma = data_.nuisance_prior(k).case_sigma;
    if (!(sigma > 0)) continue;
    for (const auto& [first, count] : data_.residuals_by_case()) {
      std::vector<double> n(directions[k].begin() + first, directions[k].begin() + first + count);
      for (double& x : n) x *= sigma;
      errors_.add(first, std::move(n));
    }
  }
  for (int k = 0; k < nuisances; ++k) add_bounded(directions[k], data_.nuisance_prior(k));
  for (int k = 0; k < nuisances; ++k)
    if (!std::isfinite(data_.nuisance_prior(k).sigma)) errors_.add_unbounded(std::move(directions[k]));
}

void WithUncertainLayers::add_bounded(const std::vector<double>& dr, const NuisancePrior& prior) {
  if (!std::isfinite(prior.sigma)) return;
  if (prior.value != 0) {
    shift_.resize(dr.size(), 0.0);
    add_scaled(-prior.value, dr, shift_);
  }
  bounded_.push_back({prior.sigma, dr});
  std::vector<double> n = dr;
  for (double& x : n) x *= prior.sigma;
  errors_.add(0, std::move(n));
}

// The minimum over q has q = -sigma^2 N' e, where e = L'L (r - N q_now) are the residuals there.
std::vector<double> WithUncertainLayers::estimates(std::span<const double> r) const {
  std::vector<double> e(r.begin(), r.end()), q;
  errors_.apply_transposed(e);
  for (const Bounded& b : bounded_) q.push_back(-b.sigma * b.sigma * dot(b.dr, e));
  return q;
}

std::vector<double> WithUncertainLayers::whitened_direction(int k) const {
  std::vector<double> n = bounded_[k].dr;
  errors_.apply(n);
  return n;
}

bool WithUncertainLayers::linearize() { return is_linearized_ = is_linearized_ || data_.linearize(); }

void WithUncertainLayers::multiply(std::span<const double> dp, std::span<double> dr) {
  data_.multiply(dp, dr);
  errors_.apply(dr);
}

void WithUncertainLayers::multiply_transposed(std::span<const double> w, std::span<double> pbar) {
  std::vector<double> own(w.begin(), w.end());
  errors_.apply_transposed(own);
  data_.multiply_transposed(own, pbar);
}

}  // namespace aspic

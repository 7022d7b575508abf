#include "model/history_misfit.h"

#include <cmath>

#include "base/parallel.h"
#include "math/vectors.h"
#include "model/limits.h"

namespace aspic {
namespace {

int readings_of(const LoadHistory& history) {
  size_t count = history.forces.size();
  for (const LoadCase& c : history.waypoints) count += 3 * c.positions.size();
  return static_cast<int>(count);
}

}  // namespace

HistoryMisfit::HistoryMisfit(const Experiment& body, const std::vector<LoadHistory>& histories,
                             ViscoelasticMaterial material, int branches, const EquilibriumOptions& options)
    : body_(body), histories_(histories), material_(std::move(material)), branches_(branches), options_(options) {
  for (const LoadHistory& history : histories) residuals_ += readings_of(history);
}

ViscoelasticMaterial HistoryMisfit::material_of(std::span<const double> p) const {
  ViscoelasticMaterial material = material_;
  const double scale = is_scale_known_ || material_at_ ? 1 : std::exp(p[0]);
  if (material_at_) material.parameters = material_at_(p[0]);
  for (MaterialParameters& m : material.parameters) m.lame.mu *= scale, m.lame.lambda *= scale;
  material.branches.clear();
  for (size_t b = 0; b < static_cast<size_t>(branches_); ++b)
    material.branches.push_back({std::exp(p[1 + 2 * b]), std::exp(p[2 + 2 * b])});
  return material;
}

std::vector<HistoryPrediction> HistoryMisfit::predicted(std::span<const double> p) const {
  const ViscoelasticMaterial material = material_of(p);
  std::vector<HistoryPrediction> predictions;
  for (const LoadHistory& history : histories_) predictions.push_back(simulate(body_, history, material, options_));
  return predictions;
}

bool HistoryMisfit::residuals(const std::vector<HistoryPrediction>& predictions, std::span<double> r) {
  size_t i = 0;
  for (size_t h = 0; h < predictions.size(); ++h) {
    const HistoryPrediction& prediction = predictions[h];
    if (!prediction.is_ok()) {
      failure_ = prediction.failure;
      return false;
    }
    for (size_t k = 0; k < prediction.forces.size(); ++k) {
      const ForceReading& reading = histories_[h].forces[k];
      r[i++] = (prediction.forces[k] - reading.value) / reading.sigma;
    }
    size_t marker = 0;
    for (const LoadCase& c : histories_[h].waypoints)
      for (const MarkerReading& reading : c.positions) {
        const Vec3d error = prediction.markers[marker++] - reading.position;
        for (int axis = 0; axis < 3; ++axis) r[i++] = error[axis] / reading.sigma[axis];
      }
  }
  return true;
}

bool HistoryMisfit::evaluate(std::span<const double> p, std::span<double> r) {
  std::vector<HistoryPrediction> predictions = predicted(p);
  if (!residuals(predictions, r)) return false;
  predictions_ = std::move(predictions);
  p_.assign(p.begin(), p.end());
  r_.assign(r.begin(), r.end());
  return true;
}

bool HistoryMisfit::linearize() {
  std::vector<std::vector<HistoryPrediction>> changed(p_.size());
  parallel_for(static_cast<int>(p_.size()), [&](int k) {
    std::vector<double> p = p_;
    p[static_cast<size_t>(k)] += kParameterStep;
    changed[static_cast<size_t>(k)] = predicted(p);
  });
  columns_.assign(p_.size(), std::vector<double>(r_.size()));
  for (size_t k = 0; k < p_.size(); ++k) {
    if (!residuals(changed[k], columns_[k])) return false;
    for (size_t i = 0; i < r_.size(); ++i) columns_[k][i] = (columns_[k][i] - r_[i]) / kParameterStep;
  }
  return true;
}

void HistoryMisfit::multiply(std::span<const double> dp, std::span<double> dr) {
  std::fill(dr.begin(), dr.end(), 0.0);
  for (size_t k = 0; k < columns_.size(); ++k) add_scaled(dp[k], columns_[k], dr);
}

void HistoryMisfit::multiply_transposed(std::span<const double> w, std::span<double> pbar) {
  for (size_t k = 0; k < columns_.size(); ++k) pbar[k] = dot(columns_[k], w);
}

double IndependentPriors::value(std::span<const double> p) const {
  double sum = 0;
  for (size_t i = 0; i < p.size(); ++i) sum += precision(i) * (p[i] - means_[i]) * (p[i] - means_[i]) / 2;
  return sum;
}
void IndependentPriors::add_gradient(std::span<const double> p, double scale, std::span<double> g) const {
  for (size_t i = 0; i < p.size(); ++i) g[i] += scale * precision(i) * (p[i] - means_[i]);
}
void IndependentPriors::add_hessian_product(std::span<const double>, std::span<const double> v, double scale,
                                            std::span<double> y) const {
  for (size_t i = 0; i < v.size(); ++i) y[i] += scale * precision(i) * v[i];
}
void IndependentPriors::solve(std::span<const double>, std::span<const double> v, double shift, std::span<double> z) {
  for (size_t i = 0; i < v.size(); ++i) z[i] = v[i] / (precision(i) + shift);
}
void IndependentPriors::add_noise(std::span<const double>, std::mt19937_64& random, std::span<double> g) const {
  std::normal_distribution<double> normal;
  for (size_t i = 0; i < g.size(); ++i) g[i] += normal(random) / sigmas_[i];
}

}  // namespace aspic

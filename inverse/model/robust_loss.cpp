#include "model/robust_loss.h"

#include <cmath>

#include "base/check.h"

namespace aspic {
namespace {

constexpr double kFreedom = 4;    // degrees of freedom. Chosen: half and double move values by 0.3 standard deviations
constexpr double kQuadratic = 3;  // mean square of a normal vector
constexpr double kOutlier = 5;    // standard deviations; one of 65 000 normal vectors is longer

}  // namespace

double robust_loss(double squared) {
  if (squared <= kQuadratic) return squared;
  return kQuadratic + (kFreedom + kQuadratic) * std::log((kFreedom + squared) / (kFreedom + kQuadratic));
}

double robust_weight(double squared) {
  return squared <= kQuadratic ? 1 : (kFreedom + kQuadratic) / (kFreedom + squared);
}

bool is_outlier(double weight) { return weight < robust_weight(kOutlier * kOutlier); }

Corrected weighted(Corrected experiment, std::span<const CaseWeights> weights) {
  if (weights.empty()) return experiment;
  ASPIC_CHECK(weights.size() == experiment.cases.size());
  for (size_t c = 0; c < weights.size(); ++c) {
    LoadCase& load = experiment.cases[c];
    for (size_t k = 0; k < load.positions.size(); ++k) {
      const double weight = weights[c].positions[k];
      load.positions[k].sigma = (1 / std::sqrt(weight)) * load.positions[k].sigma;
      load.positions[k].is_outlier = is_outlier(weight);
    }
    load.force_sigma = (1 / std::sqrt(weights[c].force)) * load.force_sigma;
    load.torque_sigma = (1 / std::sqrt(weights[c].torque)) * load.torque_sigma;
  }
  return experiment;
}

std::vector<CaseWeights> robust_weights(const Corrected& fitted, std::span<const double> r,
                                        std::span<const CaseWeights> present) {
  std::vector<CaseWeights> weights;
  size_t i = 0;
  const auto next = [&](double now) {
    double squared = 0;
    for (int k = 0; k < 3; ++k, ++i) squared += r[i] * r[i];
    return robust_weight(squared / now);
  };
  for (size_t c = 0; c < fitted.cases.size(); ++c) {
    const LoadCase& load = fitted.cases[c];
    CaseWeights& own = weights.emplace_back();
    for (size_t k = 0; k < load.positions.size(); ++k)
      own.positions.push_back(next(present.empty() ? 1 : present[c].positions[k]));
    if (load.force) own.force = next(present.empty() ? 1 : present[c].force);
    if (load.torque) own.torque = next(present.empty() ? 1 : present[c].torque);
  }
  ASPIC_CHECK(i == r.size());
  return weights;
}

}  // namespace aspic

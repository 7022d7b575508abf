#include "data/judge.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.h"
#include "estimate/uncertainty.h"
#include "model/limits.h"
#include "model/quantity.h"

namespace aspic {
namespace {

constexpr int kPoints = 20;  // points per tet of the fit at which the truth is evaluated, see points_of()

// Evenly spread over a tet: barycentric coordinates (i + 1/4) / 4 with i + j + k + l = 3.
std::vector<Vec3d> points_of(const TetMesh& mesh) {
  std::vector<Vec3d> points;
  for (const Tet& tet : mesh.tets)
    for (int i = 0; i <= 3; ++i)
      for (int j = 0; i + j <= 3; ++j)
        for (int k = 0; i + j + k <= 3; ++k) {
          const int counts[] = {i, j, k, 3 - i - j - k};
          Vec3d p{};
          for (int a = 0; a < 4; ++a) p = p + ((counts[a] + 0.25) / 4) * mesh.rest[tet[a]];
          points.push_back(p);
        }
  return points;
}

// Sums over the body, by volume.
double weighted_mean(const std::vector<double>& weight, const std::vector<double>& x) {
  return std::inner_product(weight.begin(), weight.end(), x.begin(), 0.0) /
         std::accumulate(weight.begin(), weight.end(), 0.0);
}

// Threshold with the greatest variance between the two classes of z.
double otsu_threshold(const std::vector<double>& weight, const std::vector<double>& z) {
  std::vector<size_t> order(z.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return z[a] < z[b]; });
  const double total = std::accumulate(weight.begin(), weight.end(), 0.0), mean = weighted_mean(weight, z);
  double below = 0, sum = 0, best = 0, threshold = mean;
  for (size_t i = 0; i + 1 < order.size(); ++i) {
    below += weight[order[i]], sum += weight[order[i]] * (z[order[i]] - mean);
    const double between = sum * sum / (below * (total - below));
    if (between > best && z[order[i]] < z[order[i + 1]])
      best = between, threshold = (z[order[i]] + z[order[i + 1]]) / 2;
  }
  return threshold;
}

class Judge {
 public:
  Judge(const FittedMaterial& fitted, const FittedMaterial& truth)
      : fitted_(fitted), truth_(truth), tet_(sampling(truth, points_of(fitted.mesh)).tet) {
    for (int t = 0; t < fitted.mesh.tet_count(); ++t) volume_.push_back(volume(fitted.mesh, t));
  }

  Judgment of(const Quantity& quantity, const std::vector<double>& values) {
    is_log_ = quantity.role != QuantityRole::compressibility;
    true_values_ = truth_.find(quantity.name);
    Judgment result{.quantity = quantity.name, .is_log = is_log_};
    std::vector<double> z, truth;
    for (size_t t = 0; t < values.size(); ++t) {
      z.push_back(fitted_scale(values[t]));
      double sum = 0;
      for (int i = 0; i < kPoints; ++i) sum += fitted_scale(truth_at(t, i));
      truth.push_back(sum / kPoints);
    }
    set_errors(z, truth, result);
    if (is_log_) set_coverage(z, truth, result);
    set_phases(z, result);
    return result;
  }

 private:
  double fitted_scale(double q) const { return is_log_ ? std::log(q) : q; }
  double value(double z) const { return is_log_ ? std::exp(z) : z; }
  double truth_at(size_t t, int point) const { return (*true_values_)[tet_[t * kPoints + point]]; }

  void set_errors(const std::vector<double>& z, const std::vector<double>& truth, Judgment& result) const {
    const double mean = weighted_mean(volume_, truth);
    std::vector<double> difference, squares, variation;
    for (size_t t = 0; t < z.size(); ++t) {
      difference.push_back(z[t] - truth[t]);
      squares.push_back(difference[t] * difference[t]);
      variation.push_back((truth[t] - mean) * (truth[t] - mean));
      result.largest = std::max(result.largest, std::abs(difference[t]));
    }
    result.level = weighted_mean(volume_, difference);
    result.error = std::sqrt(weighted_mean(volume_, squares));
    const double spread = std::sqrt(weighted_mean(volume_, variation));
    if (spread > kSame * std::max(std::abs(mean), 1e-300)) result.relative_error = result.error / spread;
  }

  void set_coverage(const std::vector<double>& z, const std::vector<double>& truth, Judgment& result) const {
    for (const auto& [name, sigma] : fitted_.further) {
      if (name != result.quantity + "_deviation") continue;
      int covered = 0;
      for (size_t t = 0; t < z.size(); ++t) covered += std::abs(z[t] - truth[t]) <= kSigmas95 * sigma[t] ? 1 : 0;
      result.coverage = static_cast<double>(covered) / static_cast<double>(z.size());
    }
  }

  // Number of points of a tet in a phase.
  int points_in(size_t t, double level) const {
    int count = 0;
    for (int i = 0; i < kPoints; ++i) count += std::abs(truth_at(t, i) - level) <= kSame * std::abs(level) ? 1 : 0;
    return count;
  }

  Phase phase(const std::vector<double>& z, double level) const {
    double all = 0, partly = 0, wholly = 0, partly_z = 0, wholly_z = 0;
    Phase result{.truth = level};
    for (size_t t = 0; t < z.size(); ++t) {
      const int count = points_in(t, level);
      all += volume_[t];
      partly += volume_[t] * count / kPoints, partly_z += volume_[t] * count / kPoints * z[t];
      if (count == kPoints) wholly += volume_[t], wholly_z += volume_[t] * z[t];
    }
    result.share = partly / all;
    result.fitted = value(wholly > 0 ? wholly_z / wholly : partly_z / partly);
    return result;
  }

  void set_phases(const std::vector<double>& z, Judgment& result) const {
    const std::vector<double> levels = levels_of(*true_values_);
    for (const double level : levels) result.phases.push_back(phase(z, level));
    if (levels.size() == 2) set_overlap(z, result);
  }

  void set_overlap(const std::vector<double>& z, Judgment& result) const {
    const int smaller = result.phases[0].share < result.phases[1].share ? 0 : 1;
    const double threshold = otsu_threshold(volume_, z);
    double both = 0, either = 0;
    for (size_t t = 0; t < z.size(); ++t) {
      const bool is_in = 2 * points_in(t, result.phases[smaller].truth) > kPoints;
      const bool is_found = (z[t] > threshold) == (smaller == 1);
      both += is_in && is_found ? volume_[t] : 0;
      either += is_in || is_found ? volume_[t] : 0;
    }
    result.overlap = either > 0 ? both / either : 0;
  }

  const FittedMaterial& fitted_;
  const FittedMaterial& truth_;
  std::vector<int> tet_;  // tet of the truth at each point
  std::vector<double> volume_;
  const std::vector<double>* true_values_ = nullptr;  // true values of the judged parameter
  bool is_log_ = true;
};

}  // namespace

std::vector<double> levels_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::vector<double> levels;
  for (const double v : values) {
    if (levels.empty() || v - levels.back() > kSame * std::abs(v)) levels.push_back(v);
    if (levels.size() > kMaxPhases) return {};
  }
  return levels;
}

std::vector<Judgment> judge(const FittedMaterial& fitted, const FittedMaterial& truth) {
  Judge judge(fitted, truth);
  std::vector<Judgment> result;
  for (const Quantity& quantity : material_quantities(fitted.model))
    if (const auto* values = fitted.find(quantity.name); values && truth.find(quantity.name))
      result.push_back(judge.of(quantity, *values));
  return result;
}

}  // namespace aspic

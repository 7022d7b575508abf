#include "estimate/parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "linalg/dense_eigen.h"
#include "mesh/grouped_elements.h"
#include "model/limits.h"

namespace aspic {
namespace {

// Prior of the surface between parts.
struct Surface {
  double penalty;        // per face of mean area between unlike tets [nats]; a single tet has four
  bool is_size_neutral;  // a part that grows or shrinks in the same shape keeps its penalty
  double weight;         // of its samples
};
// Without neutrality, parts are scattered below 0.9 and shrink above 1.1. With it, results of 2 and 3 agree.
constexpr Surface kSurfaces[] = {{1, false, 0.75}, {3, true, 0.25}};

struct Neighbor {
  int tet;
  double area;  // area of the common face, relative to the mean
};

std::vector<std::vector<Neighbor>> neighbors_of(const TetMesh& mesh) {
  std::vector<std::vector<Neighbor>> all(mesh.tets.size());
  const auto faces = grouped_elements<3>(mesh.vertex_count(), [&](const auto& visit) {
    for (int t = 0; t < mesh.tet_count(); ++t) {
      const auto& [a, b, c, d] = mesh.tets[t];
      visit(Triangle{b, c, d}, t), visit(Triangle{a, c, d}, t), visit(Triangle{a, b, d}, t),
          visit(Triangle{a, b, c}, t);
    }
  });
  double sum = 0;
  int count = 0;
  for_each_group(faces, [&](const GroupedElement<3>* begin, const GroupedElement<3>* end) {
    if (end != begin + 2) return;
    const auto& v = begin[0].vertices;
    const double area = norm(cross(mesh.rest[v[1]] - mesh.rest[v[0]], mesh.rest[v[2]] - mesh.rest[v[0]])) / 2;
    sum += area, ++count;
    all[begin[0].place].push_back({begin[1].place, area});
    all[begin[1].place].push_back({begin[0].place, area});
  });
  for (auto& list : all)
    for (Neighbor& n : list) n.area *= count / sum;
  return all;
}

int nearest(const std::vector<double>& levels, double z) {
  int best = 0;
  for (int k = 1; k < static_cast<int>(levels.size()); ++k)
    if (std::abs(levels[k] - z) < std::abs(levels[best] - z)) best = k;
  return best;
}

// Mean and standard deviation of weighted samples.
class RunningMoments {
 public:
  void add(double value, double weight) {
    weight_ += weight, sum_ += weight * value, squares_ += weight * value * value;
  }
  double mean() const { return weight_ > 0 ? sum_ / weight_ : 0; }
  double sigma() const { return weight_ > 0 ? std::sqrt(std::max(0.0, squares_ / weight_ - mean() * mean())) : 0; }

 private:
  double weight_ = 0, sum_ = 0, squares_ = 0;
};

class Sampler {
 public:
  Sampler(const LinearizedField& field, std::vector<double> levels, const PartsOptions& options)
      : options_(options),
        neighbors_(neighbors_of(field.mesh)),
        rank_(field.spectrum.dual.count()),
        tets_(static_cast<int>(field.z.size())),
        start_(levels),
        levels_(std::move(levels)),
        random_(options.seed) {
    const auto& [mesh, s, gradient, first, z, noise_factor] = field;
    const double relief = 1 / (noise_factor * noise_factor);
    std::vector<double> g(gradient.begin(), gradient.end());
    slope_ = product_transposed(s.W, g);
    for (int j = 0; j < rank_; ++j) d_.push_back(s.d[j] * relief), slope_[j] *= relief;
    rows_.resize(static_cast<size_t>(tets_) * rank_);
    for (int j = 0; j < rank_; ++j)
      for (int t = 0; t < tets_; ++t) rows_[static_cast<size_t>(t) * rank_ + j] = s.dual[j][first + t];
    for (int t = 0; t < tets_; ++t) {
      label_.push_back(nearest(levels_, z[t]));
      double h = 0;
      for (int j = 0; j < rank_; ++j) h += d_[j] * row(t)[j] * row(t)[j];
      own_.push_back(h);
      volume_.push_back(volume(mesh, t));
      total_ += volume_.back();
    }
    origin_.assign(rank_, 0.0);
    for (int t = 0; t < tets_; ++t) add_row(t, z[t], origin_);
  }

  PartsEstimate run() {
    const int K = static_cast<int>(levels_.size());
    PartsEstimate e{.share = std::vector<std::vector<double>>(K, std::vector<double>(tets_, 0.0))};
    level_.resize(K), z_.resize(tets_);
    for (const Surface& surface : kSurfaces) add_samples(surface, e);
    for (const RunningMoments& level : level_) e.levels.push_back(level.mean()), e.level_sigma.push_back(level.sigma());
    e.contrast_sigma = contrast_.sigma();
    for (const RunningMoments& z : z_) e.mean.push_back(z.mean()), e.sigma.push_back(z.sigma());
    return e;
  }

 private:
  void add_samples(const Surface& surface, PartsEstimate& e) {
    const int burn = options_.sweeps / 4, settled = burn / 2;
    std::vector<double> mean_neutral(levels_.size(), 0.0);
    for (int i = 0; i < burn + options_.sweeps; ++i) {
      move_levels();
      measure();
      if (i < burn) set_neutral(surface.is_size_neutral);
      if (i == burn) neutral_ = mean_neutral;
      sweep(surface.penalty);
      if (i >= settled && i < burn) add_scaled(1.0 / (burn - settled), neutral_, mean_neutral);
      if (i >= burn) add_sample(surface.weight / options_.sweeps, e);
    }
  }

  void add_sample(double part, PartsEstimate& e) {
    const double least = 1e-9 * total_;  // for parts that are always empty
    for (size_t k = 0; k < levels_.size(); ++k) level_[k].add(levels_[k], part * std::max(size_[k], least));
    contrast_.add(levels_.back() - levels_.front(), part * std::max(size_.back() * size_.front(), least * total_));
    for (int t = 0; t < tets_; ++t) {
      e.share[label_[t]][t] += part;
      z_[t].add(levels_[label_[t]], part);
    }
  }

  // Volume and interface of each part.
  void measure() {
    size_.assign(levels_.size(), 0.0), area_.assign(levels_.size(), 0.0);
    for (int t = 0; t < tets_; ++t) {
      size_[label_[t]] += volume_[t];
      for (const Neighbor& n : neighbors_[t])
        if (label_[n.tet] != label_[t]) area_[label_[t]] += n.area;
    }
  }

  // Scale of the area of a part, or of the rest of the body if that is smaller.
  double scale(double size) const { return std::pow(std::max(0.0, std::min(size, total_ - size)), 2.0 / 3); }

  // Every face belongs to two parts.
  void set_neutral(bool is_size_neutral) {
    neutral_.assign(levels_.size(), 0.0);
    for (size_t k = 0; k < levels_.size() && is_size_neutral; ++k)
      if (area_[k] > 0) neutral_[k] = area_[k] / 2 / scale(size_[k]);
  }

  // Change of the area without penalty if a part gets the volume `added`.
  double neutral_change(int k, double added) const {
    return neutral_[k] > 0 ? neutral_[k] * (scale(size_[k] + added) - scale(size_[k])) : 0;
  }

  const double* row(int t) const { return rows_.data() + static_cast<size_t>(t) * rank_; }
  void add_row(int t, double scale, std::vector<double>& to) const {
    const double* r = row(t);
    for (int j = 0; j < rank_; ++j) to[j] += scale * r[j];
  }

  // Samples the levels for given memberships from a normal distribution.
  void move_levels() {
    const int K = static_cast<int>(levels_.size());
    std::vector<std::vector<double>> S(K, std::vector<double>(rank_, 0.0));
    for (int t = 0; t < tets_; ++t) add_row(t, 1, S[label_[t]]);
    std::vector<double> A(static_cast<size_t>(K) * K), b(K);
    for (int k = 0; k < K; ++k) {
      for (int j = 0; j < rank_; ++j) b[k] += S[k][j] * (d_[j] * origin_[j] - slope_[j]);
      b[k] += start_[k] / (kPriorSigma * kPriorSigma);
      for (int l = 0; l < K; ++l) {
        double sum = k == l ? 1 / (kPriorSigma * kPriorSigma) : 0;
        for (int j = 0; j < rank_; ++j) sum += S[k][j] * d_[j] * S[l][j];
        A[static_cast<size_t>(l) * K + k] = sum;
      }
    }
    const DenseEigen e = dense_eigen(K, A);
    std::vector<double> a(K, 0.0);
    for (int i = 0; i < K; ++i) {
      double y = 0;
      for (int k = 0; k < K; ++k) y += e.vectors[static_cast<size_t>(i) * K + k] * b[k];
      y = y / e.values[i] + normal_(random_) / std::sqrt(e.values[i]);
      for (int k = 0; k < K; ++k) a[k] += e.vectors[static_cast<size_t>(i) * K + k] * y;
    }
    for (int k = 0; k < K; ++k) a[k] = std::clamp(a[k], start_[k] - kLinearRange, start_[k] + kLinearRange);
    if (std::is_sorted(a.begin(), a.end())) levels_ = a;
    force_.assign(rank_, 0.0);  // slope + d c
    for (int k = 0; k < K; ++k)
      for (int j = 0; j < rank_; ++j) force_[j] += levels_[k] * S[k][j];
    for (int j = 0; j < rank_; ++j) force_[j] = slope_[j] + d_[j] * (force_[j] - origin_[j]);
  }

  void sweep(double penalty) {
    const int K = static_cast<int>(levels_.size());
    std::vector<double> energy(K);
    for (int t = 0; t < tets_; ++t) {
      const double* r = row(t);
      double pull = 0;
      for (int j = 0; j < rank_; ++j) pull += force_[j] * r[j];
      std::fill(energy.begin(), energy.end(), 0.0);
      for (const Neighbor& n : neighbors_[t]) energy[label_[n.tet]] -= penalty * n.area;
      const int own = label_[t];
      const double lost = neutral_change(own, -volume_[t]);
      for (int k = 0; k < K; ++k) {
        if (k != own) energy[k] -= penalty * (lost + neutral_change(k, volume_[t]));
        const double step = levels_[k] - levels_[own];
        energy[k] += step * pull + step * step * own_[t] / 2;
      }
      const double least = *std::min_element(energy.begin(), energy.end());
      double sum = 0;
      for (double& x : energy) sum += x = std::exp(least - x);
      double u = sum * uniform_(random_);
      int chosen = 0;
      while (chosen + 1 < K && u > energy[chosen]) u -= energy[chosen++];
      if (chosen == label_[t]) continue;
      const double step = levels_[chosen] - levels_[label_[t]];
      for (int j = 0; j < rank_; ++j) force_[j] += step * d_[j] * r[j];
      size_[own] -= volume_[t], size_[chosen] += volume_[t];
      label_[t] = chosen;
    }
  }

  const PartsOptions& options_;
  std::vector<std::vector<Neighbor>> neighbors_;
  int rank_, tets_;
  std::vector<double> start_, levels_;
  std::vector<double> d_, slope_, origin_, force_;  // along each direction
  std::vector<double> rows_, own_, volume_;         // per tet: directions; own curvature; volume
  std::vector<double> size_, area_, neutral_;  // of each part: volume; interface; part of it without penalty, by scale
  double total_ = 0;                           // volume of the body
  std::vector<RunningMoments> level_, z_;      // over the samples: of each part, and in each tet
  RunningMoments contrast_;                    // levels_.back() - levels_.front()
  std::vector<int> label_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
};

// Independent tets with standard deviation 1 at mean volume: the metric for changes of single tets.
class Independent : public Gaussian {
 public:
  explicit Independent(std::vector<double> precision) : precision_(std::move(precision)) {}
  int size() const override { return static_cast<int>(precision_.size()); }
  void precision(std::span<const double> v, std::span<double> y) override {
    for (size_t i = 0; i < v.size(); ++i) y[i] = precision_[i] * v[i];
  }
  void covariance(std::span<const double> v, std::span<double> z) override {
    for (size_t i = 0; i < v.size(); ++i) z[i] = v[i] / precision_[i];
  }

 private:
  std::vector<double> precision_;
};

Independent one_by_one(const ParameterMap& map, int parameter, const std::vector<double>& volumes, double total) {
  const auto [first, tets] = map.range(parameter);
  std::vector<double> precision(static_cast<size_t>(map.size()), 1.0);
  for (int t = 0; t < tets; ++t) precision[first + t] = volumes[t] * tets / total;
  return Independent(std::move(precision));
}

// The change by one more linearization is a lower bound of the uncertainty.
void widen(PartsEstimate& e, std::span<const double> before, const std::vector<double>& levels) {
  for (size_t t = 0; t < before.size(); ++t) e.sigma[t] = std::hypot(e.sigma[t], e.mean[t] - before[t]);
  for (size_t k = 0; k < levels.size(); ++k) e.level_sigma[k] = std::hypot(e.level_sigma[k], e.levels[k] - levels[k]);
  const double contrast = e.levels.back() - e.levels.front(), contrast_before = levels.back() - levels.front();
  e.contrast_sigma = std::hypot(e.contrast_sigma, contrast - contrast_before);
}

}  // namespace

std::vector<double> gathered_levels(std::span<const double> z, std::span<const double> volume, int count) {
  std::vector<size_t> order(z.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return z[a] < z[b]; });
  const double low = z[order[order.size() / 100]], high = z[order[order.size() - 1 - order.size() / 100]];
  std::vector<double> levels;
  for (int k = 0; k < count; ++k) levels.push_back(low + (high - low) * (count > 1 ? k / (count - 1.0) : 0.5));
  for (int i = 0; i < 100; ++i) {
    std::vector<double> sum(levels.size(), 0.0), weight(levels.size(), 0.0);
    for (size_t t = 0; t < z.size(); ++t) {
      const int k = nearest(levels, z[t]);
      sum[k] += volume[t] * z[t], weight[k] += volume[t];
    }
    std::vector<double> moved;
    for (size_t k = 0; k < levels.size(); ++k)
      if (weight[k] > 0) moved.push_back(sum[k] / weight[k]);
    if (moved == levels) break;
    levels = moved;
  }
  return levels;
}

PartsEstimate sample_parts(const LinearizedField& field, std::vector<double> levels, const PartsOptions& options) {
  return Sampler(field, std::move(levels), options).run();
}

Parts find_parts(LeastSquares& model, const FittedField& field, int parameter, int count, const PartsOptions& options) {
  const auto& [map, mesh, p] = field;
  const auto [first, tets] = map.range(parameter);
  std::vector<double> volumes;
  double total = 0;
  for (int t = 0; t < tets; ++t) total += volumes.emplace_back(volume(mesh, t));
  Independent prior = one_by_one(map, parameter, volumes, total);
  Parts parts{.p = std::vector<double>(p.begin(), p.end())};
  const std::span<double> z = std::span(parts.p).subspan(first, tets);
  std::vector<double> r(model.residual_count()), g(p.size());
  std::vector<double> levels = gathered_levels(z, volumes, count);
  if (static_cast<int>(levels.size()) < count) return parts;
  for (int pass = 0; pass < options.passes; ++pass) {
    if (!model.evaluate(parts.p, r) || !model.linearize()) return parts;
    const double noise_factor = std::max(1.0, std::sqrt(dot(r, r) / static_cast<double>(r.size())));
    const bool is_last = pass + 1 == options.passes;
    const Spectrum s = spectrum(model, prior, {.max_rank = is_last ? options.rank : options.rank / 4});
    if (!s.ok) return parts;
    model.multiply_transposed(r, g);
    parts.estimate = sample_parts({mesh, s, g, first, z, noise_factor}, levels, options);
    if (is_last) widen(parts.estimate, z, levels);
    // The mean with the last pass damps cycles of two passes.
    const double part = pass == 0 || is_last ? 1 : 0.5;
    for (int k = 0; k < count; ++k) levels[k] += part * (parts.estimate.levels[k] - levels[k]);
    for (int t = 0; t < tets; ++t) z[t] += part * (parts.estimate.mean[t] - z[t]);
  }
  parts.ok = model.evaluate(parts.p, r);
  parts.squares = dot(r, r);
  return parts;
}

bool are_as_good(const Parts& parts, double field_squares, int residuals) {
  return parts.ok && parts.squares <= std::max(field_squares, 1.0 * residuals) + 2 * std::sqrt(2.0 * residuals);
}

}  // namespace aspic

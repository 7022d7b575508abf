#include "estimate/relaxation_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/formatted.h"
#include "estimate/fit.h"
#include "math/vectors.h"
#include "model/history_misfit.h"
#include "model/limits.h"

namespace aspic {
namespace {

constexpr int kIterationsPerStart = 40;   // per initial guess; other guesses follow one that takes more. Chosen
constexpr double kRatio = 0.3;            // median of the prior of the ratios, 0.006 to 15 with 95 %. Chosen
constexpr double kUndeterminedLog = 1.5;  // standard deviation of a logarithm, chosen; the prior of a ratio has 2
// Of the range of times, as a ratio: e^(-1/3) = 72 % of the branch is left at the end.
constexpr double kFarOutside = 3;

// Times between which relaxation is visible: from the shortest distance of two readings to the longest duration [s].
struct TimeRange {
  double shortest = 0, longest = 0;

  double at(double part) const { return shortest * std::pow(longest / shortest, part); }
};

TimeRange range_of(const std::vector<LoadHistory>& histories) {
  TimeRange range;
  for (const LoadHistory& history : histories) {
    std::vector<double> times = history.times;
    for (const ForceReading& reading : history.forces) times.push_back(reading.time);
    std::sort(times.begin(), times.end());
    const double duration = times.back() - times.front();
    range.longest = std::max(range.longest, duration);
    for (size_t i = 1; i < times.size(); ++i)
      if (const double step = times[i] - times[i - 1];
          step > 1e-6 * duration && (range.shortest == 0 || step < range.shortest))
        range.shortest = step;
  }
  if (range.shortest == 0) range.shortest = range.longest / 100;
  return range;
}

// Largest force relative to the last one, minus 1: the sum of the ratios if the ramp is fast and the hold is long.
double decay_of(const std::vector<LoadHistory>& histories) {
  double ratio = kRatio;
  for (const LoadHistory& history : histories) {
    double largest = 0;
    for (const ForceReading& reading : history.forces) largest = std::max(largest, std::abs(reading.value));
    if (!history.forces.empty() && history.forces.back().value != 0)
      ratio = std::clamp(largest / std::abs(history.forces.back().value) - 1, 0.05, 20.0);
  }
  return ratio;
}

struct Candidate {
  std::vector<double> p;
  double squares = 0, roughness = 0;
  std::vector<double> information, sigma;  // d of the spectrum; standard deviations of p
  std::vector<HistoryPrediction> predictions;
  std::string failure = "not fitted";
};

double log_evidence(const Candidate& c, double factor) {
  double determinant = 0;
  for (const double d : c.information) determinant += std::log1p(d / (factor * factor));
  const size_t branches = (c.p.size() - 1) / 2;
  const double orders = std::lgamma(static_cast<double>(branches) + 1);  // branches may be exchanged
  return -c.squares / (2 * factor * factor) - c.roughness - determinant / 2 + orders;
}

class RelaxationFitter {
 public:
  RelaxationFitter(const Experiment& body, const std::vector<LoadHistory>& histories,
                   const ViscoelasticMaterial& material, const RelaxationOptions& options)
      : body_(body), histories_(histories), material_(material), options_(options), range_(range_of(histories)) {}

  RelaxationFit run() {
    const int first = options_.branches > 0 ? options_.branches : 1,
              last = options_.branches > 0 ? options_.branches : kMaxBranches;
    for (int count = first; count <= last && !is_stopped(); ++count) candidates_.push_back(fitted(count));
    result_.is_stopped = is_stopped();
    if (!result_.is_stopped) choose(first);
    return std::move(result_);
  }

 private:
  bool is_stopped() const { return options_.stop.stopped(); }
  bool is_scale_known() const { return options_.scale_sigma == 0; }

  IndependentPriors prior(int count) const {
    std::vector<double> means = {0}, sigmas = {is_scale_known() ? 1 : options_.scale_sigma};
    for (int b = 0; b < count; ++b) {
      means.insert(means.end(), {std::log(kRatio), std::log(range_.at(0.5))});
      sigmas.insert(sigmas.end(), {kPriorSigma, std::log(range_.longest / range_.shortest) / 2});
    }
    return {std::move(means), std::move(sigmas)};
  }

  // The last fit with another branch, and relaxation times that are spread over the range.
  std::vector<std::vector<double>> starts(int count) const {
    std::vector<std::vector<double>> all;
    const double ratio = decay_of(histories_) / count;
    if (has_last_fit())
      for (const double part : {0.2, 0.8}) {
        std::vector<double>& p = all.emplace_back(candidates_.back().p);
        p.insert(p.end(), {std::log(0.3 * ratio), std::log(range_.at(part))});
      }
    for (const double shift : {0.5, 0.25}) {
      std::vector<double>& p = all.emplace_back(std::vector<double>{0});
      for (int b = 0; b < count; ++b) p.insert(p.end(), {std::log(ratio), std::log(range_.at((b + shift) / count))});
    }
    return all;
  }
  bool has_last_fit() const { return !candidates_.empty() && candidates_.back().failure.empty(); }
  // Whether another branch in two places has reduced |r|^2 too little to make its evidence decisive.
  bool is_hopeless(const Candidate& best) const {
    return has_last_fit() && best.failure.empty() && candidates_.back().squares - best.squares < 2 * kStrongEvidence;
  }

  Candidate fitted(int count) {
    if (options_.begin) options_.begin(std::to_string(count) + (count == 1 ? " branch" : " branches"));
    Candidate best;
    HistoryMisfit misfit(body_, histories_, material_, count, options_.equilibrium);
    if (is_scale_known()) misfit.keep_scale();
    misfit.set_material(options_.material_at);
    result_.residuals = misfit.residual_count();
    IndependentPriors priors = prior(count);
    const FitOptions fit_options{.max_iterations = kIterationsPerStart, .weight = 1, .stop = options_.stop};
    int tried = 0;
    for (const std::vector<double>& start : starts(count)) {
      if (tried++ == 2 && is_hopeless(best)) break;
      const FitReport report = fit(misfit, priors, start, fit_options);
      if (is_stopped()) return best;
      if (!is_success(report.status) && report.status != Status::iteration_limit) {
        if (best.p.empty()) best.failure = report.message + (misfit.failure().empty() ? "" : ": " + misfit.failure());
        continue;
      }
      const double squares = 2 * report.misfit;
      if (!best.failure.empty() || squares / 2 + report.roughness < best.squares / 2 + best.roughness)
        best = {.p = report.p, .squares = squares, .roughness = report.roughness, .failure = ""};
    }
    if (best.failure.empty()) add_uncertainty(misfit, priors, best);
    return best;
  }

  static void add_uncertainty(HistoryMisfit& misfit, IndependentPriors& priors, Candidate& c) {
    std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
    if (!misfit.evaluate(c.p, r) || !misfit.linearize()) {
      c.failure = "its derivatives could not be computed";
      return;
    }
    c.predictions = misfit.predictions();
    PriorGaussian before(priors, 1, c.p);
    Spectrum s = spectrum(misfit, before);
    c.information = s.d;
    PosteriorGaussian after(std::move(before), std::move(s));
    std::vector<double> unit(c.p.size(), 0.0), z(c.p.size());
    for (size_t i = 0; i < c.p.size(); ++i) {
      unit[i] = 1;
      after.covariance(unit, z);
      unit[i] = 0;
      c.sigma.push_back(std::sqrt(z[i]));
    }
    std::vector<double> times;
    for (size_t i = 2; i < c.p.size(); i += 2) times.push_back(c.p[i]);
    std::sort(times.begin(), times.end());
    for (size_t i = 1; i < times.size(); ++i)
      if (times[i] - times[i - 1] < std::log(kClearRatio)) c.failure = "two branches have the same relaxation time";
  }

  // Factor by which the standard deviations are too small, even for the best candidate.
  double noise_factor() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Candidate& c : candidates_)
      if (c.failure.empty()) least = std::min(least, c.squares);
    const double n = result_.residuals;
    return least < n + 3 * std::sqrt(2 * n) ? 1 : std::sqrt(least / n);
  }

  // The smallest number of branches whose evidence cannot be distinguished from the best one.
  void choose(int first) {
    const double factor = noise_factor();
    double best = -std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < candidates_.size(); ++k) {
      const Candidate& c = candidates_[k];
      BranchTrial& trial = result_.trials.emplace_back(
          BranchTrial{.count = first + static_cast<int>(k), .failure = c.failure, .squares = c.squares});
      if (c.failure.empty()) best = std::max(best, trial.evidence = log_evidence(c, factor));
    }
    for (size_t k = 0; k < candidates_.size(); ++k)
      if (candidates_[k].failure.empty() && result_.trials[k].evidence >= best - kStrongEvidence)
        return describe(candidates_[k], factor);
    result_.failure = "no relaxation times were found: " + candidates_.front().failure;
  }

  void describe(const Candidate& c, double factor) {
    const auto interval = [&](size_t i) {
      const double width = kSigmas95 * factor * c.sigma[i];
      return Interval{std::exp(c.p[i] - width), std::exp(c.p[i] + width)};
    };
    result_.squares = c.squares;
    result_.noise_factor = factor;
    result_.scale = std::exp(c.p[0]);
    result_.scale_sigma = is_scale_known() ? 0 : factor * c.sigma[0];
    result_.scale_interval = is_scale_known() ? Interval{1, 1} : interval(0);
    std::vector<size_t> order;
    for (size_t i = 1; i < c.p.size(); i += 2) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return c.p[a + 1] < c.p[b + 1]; });
    double sum = 1;
    for (const size_t i : order) sum += std::exp(c.p[i]);
    for (const size_t i : order) {
      const double ratio = std::exp(c.p[i]), time = std::exp(c.p[i + 1]);
      result_.branches.push_back({ratio, time, ratio / sum, interval(i), interval(i + 1)});
      if (factor * std::max(c.sigma[i], c.sigma[i + 1]) > kUndeterminedLog || time > kFarOutside * range_.longest ||
          time < range_.shortest / kFarOutside)
        result_.undetermined = "the branch with the relaxation time " + three_digits(time) +
                               " s is not determined by the readings, which resolve " + three_digits(range_.shortest) +
                               " s to " + three_digits(range_.longest) + " s";
    }
    if (factor > 1)
      result_.warnings.push_back("|r|^2 is " + three_digits(c.squares / result_.residuals) +
                                 " per reading of the histories: branches do not explain them, or the standard "
                                 "deviations are too small; all intervals are " +
                                 three_digits(factor) + " times wider");
    result_.predictions = c.predictions;
    for (size_t h = 0; h < histories_.size(); ++h)
      for (HistoryCurve& curve : curves_of(body_, histories_[h], c.predictions[h]))
        result_.curves.push_back(std::move(curve));
  }

  const Experiment& body_;
  const std::vector<LoadHistory>& histories_;
  const ViscoelasticMaterial& material_;
  const RelaxationOptions& options_;
  TimeRange range_;
  std::vector<Candidate> candidates_;
  RelaxationFit result_;
};

}  // namespace

RelaxationFit fit_relaxation(const Experiment& body, const std::vector<LoadHistory>& histories,
                             const ViscoelasticMaterial& material, const RelaxationOptions& options) {
  return RelaxationFitter(body, histories, material, options).run();
}

}  // namespace aspic

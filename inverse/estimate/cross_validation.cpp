#include "estimate/cross_validation.h"

#include <algorithm>
#include <cmath>

#include "model/common_errors.h"
#include "model/condensed_readings.h"
#include "model/gauge.h"
#include "model/limits.h"

namespace aspic {
namespace {

// Adds squares of the measured components, see finish().
void add(const Vec3d& error, const Vec3d& sigma, double measured, ReadingErrors& errors) {
  errors.peak = std::max(errors.peak, measured);
  for (int k = 0; k < 3; ++k)
    if (is_measured(sigma, k)) errors.error += error[k] * error[k], errors.noise += sigma[k] * sigma[k];
  ++errors.count;
}

void add_case(const Experiment& experiment, const LoadCase& measured, const CasePrediction& predicted, HeldOut& h) {
  for (size_t i = 0; i < measured.positions.size(); ++i) {
    const MarkerReading& reading = measured.positions[i];
    if (reading.is_outlier) continue;
    const Vec3d error = predicted.markers[i] - reading.position;
    h.largest_error = std::max(h.largest_error, norm(error));
    add(error, reading.sigma, norm(reading.position - at_rest(experiment, experiment.markers[reading.marker])),
        h.positions);
  }
  if (measured.force)
    add(to_gauge(measured.gauge, predicted.wrench.force - *measured.force),
        gauge_sigma(measured.gauge, measured.force_sigma), norm(*measured.force), h.forces);
  if (measured.torque)
    add(to_gauge(measured.torque_gauge, predicted.wrench.torque - *measured.torque),
        gauge_sigma(measured.torque_gauge, measured.torque_sigma), norm(*measured.torque), h.torques);
}

void finish(HeldOut& h) {
  for (ReadingErrors* errors : {&h.positions, &h.forces, &h.torques})
    for (double* sum : {&errors->error, &errors->noise}) *sum = std::sqrt(*sum / std::max(errors->count, 1));
  h.ok = true;
}

// All cases at their fit, from which those without a group are fitted. J of a point serves parameters near it.
class FitOfAll : public LeastSquares {
 public:
  FitOfAll(const Corrected& experiment, const ParameterMap& map, std::span<const double> p,
           const CrossValidationOptions& chosen)
      : experiment_(experiment), condensed_(condensed(experiment)), map_(map), p_(p), chosen_(chosen) {}

  // Returns to the fit and leaves out a group, independently of groups before.
  void leave_out(const std::string& group) {
    if (!misfit_ || has_moved_) make_misfit();
    if (!x_.empty()) misfit_->set_state(x_);
    misfit_->use_cases([&](const LoadCase& c) { return c.group != group; });
    is_exact_ = false;
  }
  // Linearizes at every point from now on, until a group is left out.
  void be_exact() { is_exact_ = true; }
  // Equilibria of the cases of a group; empty: unknown.
  std::vector<double> equilibria(const std::string& group) const {
    if (x_.empty()) return {};
    return subset(experiment_, x_, [&](const LoadCase& c) { return c.group == group; });
  }

  int parameter_count() const override { return misfit_->parameter_count(); }
  int residual_count() const override { return misfit_->residual_count(); }
  bool evaluate(std::span<const double> p, std::span<double> r) override {
    if (!misfit_->evaluate(p, r)) return false;
    evaluated_.assign(p.begin(), p.end());
    return true;
  }
  bool linearize() override {
    if (!is_exact_ && !linear_p_.empty() && is_near(linear_p_)) return true;
    has_moved_ = true;
    linear_p_.clear();
    if (!misfit_->linearize()) return false;
    if (!experiment_.scan_gravity) linear_p_ = evaluated_;  // evaluations of scans discard J
    return true;
  }
  void multiply(std::span<const double> dp, std::span<double> dr) override { misfit_->multiply(dp, dr); }
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override {
    misfit_->multiply_transposed(w, pbar);
  }
  int nuisance_count() const override { return misfit_->nuisance_count(); }
  NuisancePrior nuisance_prior(int k) const override { return misfit_->nuisance_prior(k); }
  void nuisance(int k, std::span<double> dr) override { misfit_->nuisance(k, dr); }
  std::vector<std::pair<int, int>> residuals_by_case() const override { return misfit_->residuals_by_case(); }

 private:
  void make_misfit() {
    misfit_.emplace(condensed_, map_, chosen_.equilibrium);
    has_moved_ = false;
    linear_p_.clear();
    if (!has_equilibria_) return;
    if (!chosen_.start.empty()) misfit_->set_state(chosen_.start);
    std::vector<double> r(static_cast<size_t>(residual_count()));
    has_equilibria_ = evaluate(p_, r);
    if (!has_equilibria_) return make_misfit();
    x_ = misfit_->state();
    linearize();
    has_moved_ = false;
  }
  bool is_near(std::span<const double> p) const {
    double distance = 0;
    for (size_t i = 0; i < p.size(); ++i) distance = std::max(distance, std::abs(evaluated_[i] - p[i]));
    return distance <= kSettled;
  }

  const Corrected& experiment_;
  Condensed condensed_;
  const ParameterMap& map_;
  std::span<const double> p_;
  const CrossValidationOptions& chosen_;
  std::optional<Misfit> misfit_;
  bool has_equilibria_ = true;                 // at the fit
  bool is_exact_ = false, has_moved_ = false;  // has_moved_: J is not that of the fit
  std::vector<double> x_, evaluated_, linear_p_;
};

void predict(const Corrected& left_out, const ParameterMap& map, const EquilibriumOptions& options,
             std::span<const double> start, HeldOut& h) {
  Misfit misfit(left_out, map, options);
  if (!start.empty()) misfit.set_state(start);
  std::vector<double> r(misfit.residual_count());
  if (!misfit.evaluate(h.p, r)) {
    h.failure = "no equilibrium was found with the material of the other cases: " + misfit.failure();
    return;
  }
  for (size_t c = 0; c < left_out.cases.size(); ++c)
    add_case(left_out, left_out.cases[c], misfit.prediction(static_cast<int>(c)), h);
  finish(h);
}

struct HoldOut {
  const std::string& group;
  const ParameterMap& map;
  Regularizer& regularizer;
  const std::vector<double>& guess;
  const FitOptions& options;
  const CrossValidationOptions& chosen;
  FitOfAll& all;
};

// Fits the other groups and predicts this one.
HeldOut hold_out(const Corrected& experiment, const HoldOut& what) {
  HeldOut h{.group = what.group};
  const Corrected& whole = what.chosen.to_predict ? *what.chosen.to_predict : experiment;
  const Corrected left_out = subset(whole, [&](const LoadCase& c) { return c.group == h.group; });
  what.all.leave_out(h.group);
  WithUncertainLayers data(what.all);
  FitReport report = fit(data, what.regularizer, what.guess, what.options);
  if (report.status == Status::stuck || report.status == Status::no_descent) {
    what.all.be_exact();
    report = fit(data, what.regularizer, what.guess, what.options);
  }
  h.p = report.p;
  if (is_success(report.status) || report.status == Status::iteration_limit)
    predict(left_out, what.map, what.chosen.equilibrium, what.all.equilibria(h.group), h);
  else
    h.failure = "the fit to the other cases failed: " + report.message;
  return h;
}

double root_mean_square(const std::vector<HeldOut>& groups, ReadingErrors HeldOut::*kind) {
  double sum = 0;
  int count = 0;
  for (const HeldOut& h : groups)
    if (h.ok && (h.*kind).peak > 0) sum += (h.*kind).relative() * (h.*kind).relative(), ++count;
  return count > 0 ? std::sqrt(sum / count) : -1;
}

}  // namespace

std::vector<std::string> groups_of(const Experiment& experiment) {
  std::vector<std::string> groups;
  for (const LoadCase& c : experiment.cases)
    if (std::find(groups.begin(), groups.end(), c.group) == groups.end()) groups.push_back(c.group);
  return groups;
}

std::vector<double> subset(const Experiment& experiment, std::span<const double> state,
                           const std::function<bool(const LoadCase&)>& wanted) {
  const size_t size = state.size() / experiment.cases.size();
  std::vector<double> part;
  for (size_t c = 0; c < experiment.cases.size(); ++c) {
    const std::span<const double> own = state.subspan(c * size, size);
    if (wanted(experiment.cases[c])) part.insert(part.end(), own.begin(), own.end());
  }
  return part;
}

HeldOut compare(const Experiment& left_out, std::span<const CasePrediction> predicted) {
  HeldOut h{.group = left_out.cases.empty() ? "" : left_out.cases.front().group};
  for (size_t c = 0; c < left_out.cases.size(); ++c) add_case(left_out, left_out.cases[c], predicted[c], h);
  finish(h);
  return h;
}

CrossValidation cross_validate(const Corrected& experiment, const ParameterMap& map, Regularizer& regularizer,
                               const FitReport& fitted, const CrossValidationOptions& chosen) {
  CrossValidation result;
  const std::vector<std::string> groups = groups_of(experiment);
  if (groups.size() < 2) {
    result.warnings.push_back("nothing can be held out: all cases belong to one group (give each poke its own)");
    return result;
  }
  FitOptions options = chosen.fit;
  options.weight = fitted.weight;
  options.starts = 1;
  FitOfAll all(experiment, map, fitted.p, chosen);
  for (size_t g = 0; g < groups.size(); ++g) {
    if (chosen.observe) chosen.observe(static_cast<int>(g), static_cast<int>(groups.size()), groups[g]);
    if (options.stop.stopped()) break;
    const auto compute = [&] {
      return hold_out(experiment, {groups[g], map, regularizer, fitted.p, options, chosen, all});
    };
    std::optional<HeldOut> h = chosen.store ? chosen.store(static_cast<int>(g), groups[g], compute) : compute();
    if (!h) continue;
    if (!h->ok) result.warnings.push_back(h->group + " could not be predicted: " + h->failure);
    result.groups.push_back(std::move(*h));
  }
  result.position_error = root_mean_square(result.groups, &HeldOut::positions);
  result.force_error = root_mean_square(result.groups, &HeldOut::forces);
  result.torque_error = root_mean_square(result.groups, &HeldOut::torques);
  return result;
}

}  // namespace aspic

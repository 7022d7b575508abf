#include "pipeline/law_comparison.h"

#include <algorithm>
#include <cmath>

#include "math/eigen3.h"
#include "math/vectors.h"
#include "pipeline/fit_verdict.h"
#include "pipeline/fitted_values.h"
#include "pipeline/law_fits.h"

namespace aspic {
namespace {

constexpr double kReached = 0.95;  // fraction of the body; a convention

// Largest |principal stretch - 1| of a tet.
double strain_of(const TetMesh& mesh, std::span<const double> x, int t) {
  const Tet& tet = mesh.tets[static_cast<size_t>(t)];
  const auto at = [&](int v) { return Vec3d{{x[3 * size_t(v)], x[3 * size_t(v) + 1], x[3 * size_t(v) + 2]}}; };
  Mat3d rest, now;
  for (int j = 0; j < 3; ++j) {
    const Vec3d R = mesh.rest[static_cast<size_t>(tet[j + 1])] - mesh.rest[static_cast<size_t>(tet[0])];
    const Vec3d r = at(tet[j + 1]) - at(tet[0]);
    for (int i = 0; i < 3; ++i) rest(i, j) = R[i], now(i, j) = r[i];
  }
  const Mat3d F = now * inverse(rest);
  double largest = 0;
  const Vec3d squares = symmetric_eigen(transpose(F) * F).values;
  for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(std::sqrt(std::max(squares[i], 0.0)) - 1));
  return largest;
}

double strain_of_body(const TetMesh& mesh, std::span<const double> x) {
  std::vector<double> strains;
  for (int t = 0; t < mesh.tet_count(); ++t) strains.push_back(strain_of(mesh, x, t));
  const auto place = strains.begin() + static_cast<std::ptrdiff_t>(kReached * static_cast<double>(strains.size() - 1));
  std::nth_element(strains.begin(), place, strains.end());
  return *place;
}

class LawComparison {
 public:
  LawComparison(const DataSet& data, const FitPlan& plan, FitJobs& jobs, const FitCallbacks& callbacks)
      : data_(data),
        plan_(simplified(plan, data.experiment.mesh, &choice_.simplified)),
        jobs_(jobs),
        callbacks_(callbacks),
        fits_(data, plan_, jobs, callbacks) {}

  LawChoice run() {
    if (!fits_.run() || (jobs_.is_distributed() && !hold_out_all())) return choice_;
    for (const FittedLaw& law : fits_.laws()) {
      if (is_stopped()) return choice_;
      describe(law);
    }
    if (!is_stopped()) judge_laws(choice_);
    return choice_;
  }

 private:
  // Computes what describe() needs, before the uncertainties, which only one process computes.
  bool hold_out_all() {
    for (const FittedLaw& c : fits_.laws()) {
      if (!plan_.cross_validation || c.p.empty() || !c.failure.empty()) continue;
      FitModel model = fits_.model_of(c, c.plan.parameters);
      held_out(model, c);
    }
    return !is_stopped() && !jobs_.is_waiting();
  }

  void describe(const FittedLaw& c) {
    LawTrial& trial = choice_.trials.emplace_back();
    trial.law = c.law.name;
    trial.failure = c.failure;
    if (c.p.empty() && trial.failure.empty()) trial.failure = "no initial guess has an equilibrium";
    if (!trial.is_fitted()) return;
    FitModel model = fits_.model_of(c, c.plan.parameters);
    WithUncertainLayers about_fit(model.misfit);
    const Posterior posterior = aspic::posterior(about_fit, *model.prior, 1, {model.map, data_.experiment.mesh, c.p});
    if (!posterior.ok) {
      trial.failure = posterior.warnings.empty() ? "its uncertainty is unknown" : posterior.warnings.back();
      return;
    }
    trial.parameters = model.map.size();
    trial.residuals = model.misfit.residual_count();
    trial.information = posterior.gaussian->spectrum().d;
    for (double& d : trial.information) d *= posterior.applied_factor * posterior.applied_factor;
    add_squares(model, c, trial);
    for (const FittedQuantity& q : fitted_quantities(model.map, data_.experiment.mesh, c.p, &posterior))
      for (const ValueRow& row : q.rows) trial.values.push_back({q.name, q.unit, row.where, row.value, row.interval});
    hold_out(model, c, trial);
  }

  void add_squares(FitModel& model, const FittedLaw& c, LawTrial& trial) {
    std::vector<double> r(static_cast<size_t>(trial.residuals));
    if (!model.data().evaluate(c.p, r)) return;
    trial.squares = dot(r, r);
    trial.roughness = model.prior->value(c.p);
    for (size_t k = 0; k < fits_.simulated().fitted().cases.size(); ++k)
      choice_.strain = std::max(
          choice_.strain, strain_of_body(fits_.simulated().mesh(), model.misfit.prediction(static_cast<int>(k)).x));
  }

  void hold_out(FitModel& model, const FittedLaw& c, LawTrial& trial) {
    if (!plan_.cross_validation) return;
    const CrossValidation held_out = this->held_out(model, c);
    const PredictionErrors errors = all_groups(beyond_noise(data_, held_out.groups));
    trial.position_error = errors.position;
    trial.force_error = errors.force;
    for (const HeldOut& group : held_out.groups) trial.held_out.push_back(predicted(model, group));
  }

  CrossValidation held_out(FitModel& model, const FittedLaw& c) {
    const FitReport fitted{.p = c.p, .weight = 1};
    FitOptions options = plan_.fit;
    options.stop = StopToken([this] { return is_stopped(); });
    const auto observe = [&](int, int, const std::string& group) {
      if (callbacks_.begin) callbacks_.begin(FitStage::law, c.law.name + ": '" + group + "' is held out");
    };
    const HeldOutJobs jobs{jobs_, "law_" + c.law.name + "_held_out", c.plan, [this] { return is_stopped(); }};
    return cross_validate(fits_.simulated().fitted(), model.map, *model.prior, fitted,
                          {options, plan_.equilibrium, observe, nullptr, jobs.store(fits_.simulated().fitted(), fitted),
                           fits_.simulated().equilibria()});
  }

  PredictiveResiduals predicted(FitModel& model, const HeldOut& group) const {
    if (!group.ok) return {};
    const Corrected& all = fits_.simulated().fitted();
    const auto is_fitted = [&](const LoadCase& c) { return c.group != group.group; };
    const auto is_own = [&](const LoadCase& c) { return c.group == group.group; };
    const Corrected others = subset(all, is_fitted), own = subset(all, is_own);
    Misfit of_others(others, model.map, plan_.equilibrium), of_own(own, model.map, plan_.equilibrium);
    const std::vector<double> state = model.misfit.state();
    of_others.set_state(subset(all, state, is_fitted)), of_own.set_state(subset(all, state, is_own));
    WithUncertainLayers fitted(of_others), left_out(of_own);
    return predictive_residuals(fitted, left_out, *model.prior, group.p);
  }

  bool is_stopped() const { return callbacks_.stop.stopped(); }

  const DataSet& data_;
  LawChoice choice_;
  FitPlan plan_;
  FitJobs& jobs_;
  const FitCallbacks& callbacks_;
  LawFits fits_;
};

}  // namespace

LawChoice choose_law(const DataSet& data, const FitPlan& plan, FitJobs& jobs, const FitCallbacks& callbacks) {
  return LawComparison(data, plan, jobs, callbacks).run();
}

}  // namespace aspic

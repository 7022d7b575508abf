#include "capture/law_contest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "capture/fit_troubles.h"
#include "capture/fitted_values.h"
#include "capture/material_fit.h"
#include "fit/quantity.h"
#include "math/eigen3.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr int kMaxRegions = 8;        // regions with one value each, for the comparison
constexpr double kWellFitted = 2.25;  // |r|^2 per reading above which further initial guesses are tried
constexpr double kReached = 0.95;     // fraction of the body
constexpr char kReference[] = "neo_hookean";

// An own parameter of a law: prior mean and its standard deviation on the fitted scale, and initial guesses.
struct OwnParameter {
  std::string name;
  double mean, sigma;
  std::vector<double> guesses;
};

struct Law {
  std::string name;
  std::vector<OwnParameter> own;
  std::vector<std::pair<std::string, double>> known;
};

// Isotropic laws with at most two values besides E and nu. The priors span the published materials.
const std::vector<Law>& known_laws() {
  static const std::vector<Law> all = {{kReference, {}, {}},
                                       {"neo_hookean_isochoric", {}, {}},
                                       {"mooney_rivlin", {{"share", 0.5, 2, {0.5}}}, {}},
                                       {"yeoh", {{"b2", 0.1, 0.2, {0.1, 1}}, {"b3", 0.01, 2, {0.01, 0.1}}}, {}},
                                       {"gent", {{"limit", 10, 2, {10, 100, 2}}}, {}},
                                       {"fung", {{"b", 1, 2, {1, 0.1, 5}}}, {}},
                                       {"ogden", {{"alpha", 2, 0.2, {2.5, 8, -8}}}, {{"alpha_2", -2}, {"share_2", 0}}}};
  return all;
}

const Law& law_named(const std::string& name) {
  return *std::find_if(known_laws().begin(), known_laws().end(), [&](const Law& law) { return law.name == name; });
}

bool is_varying(const FitParameter& u) {
  return u.parameterization == Parameterization::tets || u.parameterization == Parameterization::handles;
}

int region_count(const TetMesh& mesh) {
  return static_cast<int>(std::set<int>(mesh.region.begin(), mesh.region.end()).size());
}

FitPlan simplified(FitPlan plan, const TetMesh& mesh, std::string& text) {
  const int regions = region_count(mesh);
  const bool has_regions = regions > 1 && regions <= kMaxRegions;
  for (FitParameter& u : plan.parameters) {
    if (!is_varying(u)) continue;
    u.parameterization = has_regions ? Parameterization::regions : Parameterization::uniform;
    u.handles = 0;
    text = has_regions ? "one value per region instead of a field" : "one value instead of a field";
  }
  plan.parts = 0;
  plan.fit.method = plan.fit.weight_rule = "auto";
  plan.fit.weight = -1;
  plan.fit.starts = 1;
  return plan;
}

FitPlan with_law(FitPlan plan, const Law& law) {
  plan.model = law.name;
  for (const OwnParameter& own : law.own)
    plan.parameters.push_back({.quantity = own.name,
                               .parameterization = Parameterization::uniform,
                               .handles = 0,
                               .guess = own.mean,
                               .prior_sigma = own.sigma});
  plan.known.insert(plan.known.end(), law.known.begin(), law.known.end());
  return plan;
}

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

// A law with its best parameters so far.
struct Contender {
  const Law& law;
  FitPlan plan;
  std::vector<double> p;  // empty: none yet
  double objective = std::numeric_limits<double>::infinity();
  std::vector<MaterialParameters> material;
  std::string failure;
};

class LawContest {
 public:
  LawContest(const DataSet& data, const FitPlan& plan, const FitCallbacks& callbacks)
      : data_(data),
        plan_(simplified(plan, data.experiment.mesh, choice_.simplified)),
        callbacks_(callbacks),
        simulated_(data.experiment, plan_) {}

  LawChoice run() {
    for (const Law& law : known_laws())
      contenders_.push_back({.law = law, .plan = with_law(plan_, law), .p = {}, .material = {}, .failure = {}});
    find_reference();
    take_off_mesh_errors(contenders_.front());
    for (Contender& contender : contenders_) fit(contender, "");
    if (is_stopped()) return choice_;
    if (plan_.mesh_errors) {
      take_off_mesh_errors(*std::min_element(contenders_.begin(), contenders_.end(),
                                             [](const auto& a, const auto& b) { return a.objective < b.objective; }));
      for (Contender& contender : contenders_) fit(contender, " with the mesh correction of the best one");
    }
    for (Contender& contender : contenders_) {
      if (is_stopped()) return choice_;
      describe(contender);
    }
    if (!is_stopped()) judge_laws(choice_);
    return choice_;
  }

 private:
  FitModel model_of(const Contender& c, std::vector<FitParameter> parameters) const {
    return {data_.experiment, simulated_.fitted(), c.plan, std::move(parameters), {kNoMemory, "", ""}};
  }

  // Finds moduli at small strains, the initial guess of all laws.
  void find_reference() {
    Contender& first = contenders_.front();
    for (const double factor : {1.0, 10.0, 100.0, 0.1}) {
      std::vector<FitParameter> parameters = first.plan.parameters;
      for (FitParameter& u : parameters)
        if (is_stiffness(u.quantity)) u.guess *= factor;
      FitModel model = model_of(first, parameters);
      if (minimize(first, model, model.map.guess()) || is_stopped()) return;
    }
  }

  std::vector<std::vector<double>> starts_of(const Contender& c) const {
    if (!c.p.empty()) return {c.p};
    size_t count = 1;
    for (const OwnParameter& own : c.law.own) count = std::max(count, own.guesses.size());
    std::vector<std::vector<double>> starts;
    for (size_t k = 0; k < count; ++k) {
      std::vector<FitParameter> parameters = c.plan.parameters;
      for (FitParameter& u : parameters)
        for (const OwnParameter& own : c.law.own)
          if (own.name == u.quantity) u.guess = own.guesses[std::min(k, own.guesses.size() - 1)];
      FitModel model = model_of(c, parameters);
      std::vector<double>& start = starts.emplace_back(model.map.guess().begin(), model.map.guess().end());
      const std::vector<double>& reference = contenders_.front().p;  // its parameters come first
      std::copy_n(reference.begin(), std::min(reference.size(), start.size()), start.begin());
    }
    return starts;
  }

  void fit(Contender& c, const std::string& how) {
    if (is_stopped()) return;
    if (callbacks_.begin) callbacks_.begin(FitStage::law, c.law.name + how);
    c.objective = std::numeric_limits<double>::infinity();
    for (const std::vector<double>& start : starts_of(c)) {
      FitModel model = model_of(c, c.plan.parameters);
      minimize(c, model, start);
      if (is_stopped() || 2 * c.objective < kWellFitted * model.misfit.residual_count()) return;
    }
  }

  // Keeps the result if it is better than the last one.
  bool minimize(Contender& c, FitModel& model, std::span<const double> start) {
    FitOptions options = plan_.fit;
    options.stop = StopToken([this] { return is_stopped(); });
    const auto observe = [&](const FitIteration& iteration, std::span<const double> p) {
      if (callbacks_.iterate) callbacks_.iterate(FitStage::law, iteration, p);
    };
    const FitReport report = aspic::fit(model.data(), *model.prior, start, options, observe);
    if (!is_success(report.status) && report.status != Status::iteration_limit) {
      if (c.p.empty()) c.failure = describe_failure(data_, report, model.misfit.failure());
      return false;
    }
    const double objective = report.misfit + report.weight * report.roughness;
    if (!(objective < c.objective)) return true;
    c.objective = objective;
    c.p = report.p;
    c.material = model.map.parameters(c.p);
    c.failure = describe_runaway(data_, c.material.front());
    return true;
  }

  void take_off_mesh_errors(const Contender& c) {
    if (!plan_.mesh_errors || c.material.empty() || is_stopped() || simulated_.is_too_large_for_mesh_errors()) return;
    if (callbacks_.begin) callbacks_.begin(FitStage::mesh_errors, "discretization error with " + c.law.name);
    simulated_.take_off_mesh_errors(c.plan, c.material);  // if this fails, the last correction remains
  }

  void describe(Contender& c) {
    LawTrial& trial = choice_.trials.emplace_back();
    trial.law = c.law.name;
    trial.failure = c.failure;
    if (c.p.empty() && trial.failure.empty()) trial.failure = "no initial guess has an equilibrium";
    if (!trial.is_fitted()) return;
    FitModel model = model_of(c, c.plan.parameters);
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

  void add_squares(FitModel& model, const Contender& c, LawTrial& trial) {
    std::vector<double> r(static_cast<size_t>(trial.residuals));
    if (!model.data().evaluate(c.p, r)) return;
    trial.squares = dot(r, r);
    trial.roughness = model.prior->value(c.p);
    for (size_t k = 0; k < simulated_.fitted().cases.size(); ++k)
      choice_.strain =
          std::max(choice_.strain, strain_of_body(simulated_.mesh(), model.misfit.prediction(static_cast<int>(k)).x));
  }

  void hold_out(FitModel& model, const Contender& c, LawTrial& trial) {
    if (!plan_.cross_validation) return;
    FitReport fitted{.p = c.p, .weight = 1};
    FitOptions options = plan_.fit;
    options.stop = StopToken([this] { return is_stopped(); });
    const auto observe = [&](int, int, const std::string& group) {
      if (callbacks_.begin) callbacks_.begin(FitStage::law, c.law.name + ": '" + group + "' is held out");
    };
    const CrossValidation held_out =
        cross_validate(simulated_.fitted(), model.map, *model.prior, fitted, {options, plan_.equilibrium, observe});
    trial.position_error = held_out.position_error;
    trial.force_error = held_out.force_error;
    for (const HeldOut& group : held_out.groups) trial.held_out.push_back(predicted(model, group));
  }

  PredictiveResiduals predicted(FitModel& model, const HeldOut& group) const {
    if (!group.ok) return {};
    const auto part = [&](bool is_seen) {
      return subset(simulated_.fitted(), [&](const LoadCase& c) { return (c.group != group.group) == is_seen; });
    };
    const Experiment others = part(true), own = part(false);
    Misfit of_others(others, model.map, plan_.equilibrium), of_own(own, model.map, plan_.equilibrium);
    WithUncertainLayers seen(of_others), left_out(of_own);
    return predictive_residuals(seen, left_out, *model.prior, group.p);
  }

  bool is_stopped() const { return callbacks_.stop.stopped(); }

  static const FitMemory kNoMemory;
  const DataSet& data_;
  LawChoice choice_;
  FitPlan plan_;
  const FitCallbacks& callbacks_;
  SimulatedData simulated_;
  std::vector<Contender> contenders_;
};

const FitMemory LawContest::kNoMemory = {};

}  // namespace

LawChoice choose_law(const DataSet& data, const FitPlan& plan, const FitCallbacks& callbacks) {
  return LawContest(data, plan, callbacks).run();
}

FitPlan plan_with_law(const FitPlan& plan, const LawChoice& choice) {
  const Law& law = law_named(choice.chosen < 0 ? kReference : choice.trials[static_cast<size_t>(choice.chosen)].law);
  FitPlan chosen = with_law(plan, law);
  if (choice.chosen < 0) return chosen;
  for (FitParameter& u : chosen.parameters)
    for (const LawValue& value : choice.trials[static_cast<size_t>(choice.chosen)].values)
      if (value.quantity == u.quantity && value.where == "everywhere") u.guess = value.value;
  for (FitParameter& u : chosen.parameters) u.prior_sigma = 0;
  return chosen;
}

}  // namespace aspic

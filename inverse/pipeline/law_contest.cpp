#include "pipeline/law_contest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "math/eigen3.h"
#include "math/vectors.h"
#include "model/quantity.h"
#include "pipeline/fit_troubles.h"
#include "pipeline/fit_verdict.h"
#include "pipeline/fitted_values.h"
#include "pipeline/material_fit.h"

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

constexpr int kNumbersOfIteration = 10;

std::array<double, kNumbersOfIteration> numbers_of(const FitIteration& i) {
  return {static_cast<double>(i.index),
          static_cast<double>(i.start),
          i.weight,
          i.misfit,
          i.roughness,
          i.objective,
          i.decrement,
          i.step,
          static_cast<double>(i.inner),
          static_cast<double>(i.trials)};
}

FitIteration iteration_of(const double* n) {
  return {.index = static_cast<int>(n[0]),
          .start = static_cast<int>(n[1]),
          .weight = n[2],
          .misfit = n[3],
          .roughness = n[4],
          .objective = n[5],
          .decrement = n[6],
          .step = n[7],
          .inner = static_cast<int>(n[8]),
          .trials = static_cast<int>(n[9])};
}

class LawContest {
 public:
  LawContest(const DataSet& data, const FitPlan& plan, FitJobs& jobs, const FitCallbacks& callbacks)
      : data_(data),
        plan_(simplified(plan, data.experiment.mesh, &choice_.simplified)),
        jobs_(jobs),
        callbacks_(callbacks),
        simulated_(data.experiment, plan_) {}

  LawChoice run() {
    for (const Law& law : known_laws())
      contenders_.push_back({.law = law, .plan = with_law(plan_, law), .p = {}, .material = {}, .failure = {}});
    if (!fit_all() || (jobs_.is_distributed() && !hold_out_all())) return choice_;
    for (Contender& contender : contenders_) {
      if (is_stopped()) return choice_;
      describe(contender);
    }
    if (!is_stopped()) judge_laws(choice_);
    return choice_;
  }

 private:
  // False: stopped, or results of jobs are missing.
  bool fit_all() {
    // All laws start from the moduli of the first one.
    run_job(contenders_.front(), "reference", JobKind::common, [&] { find_reference(); });
    subtract_mesh_errors(contenders_.front());
    for (Contender& c : contenders_) {
      const bool is_first = &c == &contenders_.front();
      run_job(c, "first", is_first ? JobKind::common : JobKind::independent, [&] { fit(c, ""); });
      if (is_first) reference_ = c.p;
    }
    if (is_stopped() || jobs_.is_waiting()) return false;
    if (!plan_.mesh_errors) return true;
    subtract_mesh_errors(*std::min_element(contenders_.begin(), contenders_.end(),
                                           [](const auto& a, const auto& b) { return a.objective < b.objective; }));
    for (Contender& c : contenders_)
      run_job(c, "second", JobKind::independent, [&] { fit(c, " with the mesh correction of the best one"); });
    return !is_stopped() && !jobs_.is_waiting();
  }

  // Computes what describe() needs, before the uncertainties, which only one process computes.
  bool hold_out_all() {
    for (const Contender& c : contenders_) {
      if (!plan_.cross_validation || c.p.empty() || !c.failure.empty()) continue;
      FitModel model = model_of(c, c.plan.parameters);
      held_out(model, c);
    }
    return !is_stopped() && !jobs_.is_waiting();
  }

  // Changes the contender by `action` or by the stored result of an earlier one, with the same iterations.
  void run_job(Contender& c, const std::string& stage, JobKind kind, const std::function<void()>& action) {
    if (is_stopped()) return;
    Fingerprint question;
    const std::string text = text_of(c.plan) + fingerprint_of(simulated_.fitted());
    question.add(text.data(), text.size());
    for (const std::vector<double>* p : {&c.p, &reference_}) question.add(p->data(), p->size() * sizeof(double));
    bool is_computed = false;
    const std::optional<JobResult> result =
        jobs_.result("law_" + c.law.name + "_" + stage, question, kind, [&]() -> std::optional<JobResult> {
          is_computed = true;
          iterations_.clear();
          action();
          return is_stopped() ? std::nullopt : std::optional(result_of(c));
        });
    if (result && !is_computed) restore(*result, c);
  }

  JobResult result_of(const Contender& c) const {
    JobResult result{{c.objective, static_cast<double>(c.p.size())}, c.failure};
    result.numbers.insert(result.numbers.end(), c.p.begin(), c.p.end());
    for (const FitIteration& i : iterations_)
      for (const double number : numbers_of(i)) result.numbers.push_back(number);
    return result;
  }

  void restore(const JobResult& result, Contender& c) {
    auto number = result.numbers.begin();
    c.objective = *number++;
    const auto count = static_cast<std::ptrdiff_t>(*number++);
    c.p.assign(number, number + count);
    number += count;
    c.failure = result.text;
    if (!c.p.empty()) c.material = model_of(c, c.plan.parameters).map.parameters(c.p);
    for (; number != result.numbers.end(); number += kNumbersOfIteration)
      if (callbacks_.iterate && !jobs_.is_waiting()) callbacks_.iterate(FitStage::law, iteration_of(&*number), c.p);
  }

  FitModel model_of(const Contender& c, std::vector<FitParameter> parameters) const {
    return {data_.experiment, simulated_, c.plan, std::move(parameters), {kNoMemory, "", ""}};
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
      // Its parameters come first.
      std::copy_n(reference_.begin(), std::min(reference_.size(), start.size()), start.begin());
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
      iterations_.push_back(iteration);
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

  void subtract_mesh_errors(const Contender& c) {
    if (!plan_.mesh_errors || c.material.empty() || is_stopped() || simulated_.is_too_large_for_mesh_errors()) return;
    if (callbacks_.begin) callbacks_.begin(FitStage::mesh_errors, "discretization error with " + c.law.name);
    simulated_.subtract_mesh_errors(c.plan, c.material);  // if this fails, the last correction remains
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
    const CrossValidation held_out = this->held_out(model, c);
    const PredictionErrors errors = all_groups(beyond_noise(data_, held_out.groups));
    trial.position_error = errors.position;
    trial.force_error = errors.force;
    for (const HeldOut& group : held_out.groups) trial.held_out.push_back(predicted(model, group));
  }

  CrossValidation held_out(FitModel& model, const Contender& c) {
    const FitReport fitted{.p = c.p, .weight = 1};
    FitOptions options = plan_.fit;
    options.stop = StopToken([this] { return is_stopped(); });
    const auto observe = [&](int, int, const std::string& group) {
      if (callbacks_.begin) callbacks_.begin(FitStage::law, c.law.name + ": '" + group + "' is held out");
    };
    const HeldOutJobs jobs{jobs_, "law_" + c.law.name + "_held_out", c.plan, [this] { return is_stopped(); }};
    return cross_validate(simulated_.fitted(), model.map, *model.prior, fitted,
                          {options, plan_.equilibrium, observe, nullptr, jobs.store(simulated_.fitted(), fitted),
                           simulated_.equilibria()});
  }

  PredictiveResiduals predicted(FitModel& model, const HeldOut& group) const {
    if (!group.ok) return {};
    const Experiment& all = simulated_.fitted();
    const auto is_seen = [&](const LoadCase& c) { return c.group != group.group; };
    const auto is_own = [&](const LoadCase& c) { return c.group == group.group; };
    const Experiment others = subset(all, is_seen), own = subset(all, is_own);
    Misfit of_others(others, model.map, plan_.equilibrium), of_own(own, model.map, plan_.equilibrium);
    const std::vector<double> state = model.misfit.state();
    of_others.set_state(subset(all, state, is_seen)), of_own.set_state(subset(all, state, is_own));
    WithUncertainLayers seen(of_others), left_out(of_own);
    return predictive_residuals(seen, left_out, *model.prior, group.p);
  }

  bool is_stopped() const { return callbacks_.stop.stopped(); }

  static const FitMemory kNoMemory;
  const DataSet& data_;
  LawChoice choice_;
  FitPlan plan_;
  FitJobs& jobs_;
  const FitCallbacks& callbacks_;
  SimulatedData simulated_;
  std::vector<Contender> contenders_;
  std::vector<double> reference_;         // parameters of the first law, from which the others start
  std::vector<FitIteration> iterations_;  // of the job that is being computed
};

const FitMemory LawContest::kNoMemory = {};

}  // namespace

FitPlan simplified(FitPlan plan, const TetMesh& mesh, std::string* what) {
  const int regions = region_count(mesh);
  const bool has_regions = regions > 1 && regions <= kMaxRegions;
  for (FitParameter& u : plan.parameters) {
    if (!is_varying(u)) continue;
    u.parameterization = has_regions ? Parameterization::regions : Parameterization::uniform;
    u.handles = 0;
    if (what) *what = has_regions ? "one value per region instead of a field" : "one value instead of a field";
  }
  plan.parts = 0;
  plan.fit.method = plan.fit.weight_rule = "auto";
  plan.fit.weight = -1;
  plan.fit.starts = 1;
  return plan;
}

LawChoice choose_law(const DataSet& data, const FitPlan& plan, FitJobs& jobs, const FitCallbacks& callbacks) {
  return LawContest(data, plan, jobs, callbacks).run();
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

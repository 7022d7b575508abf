#include "pipeline/material_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimate/law_errors.h"
#include "model/condensed_readings.h"
#include "model/quantity.h"
#include "pipeline/fit_troubles.h"
#include "pipeline/fit_verdict.h"

namespace aspic {
namespace {

constexpr int kPasses = 8;
constexpr double kSettled = 0.02;       // relative change of a value; errors of the mesh change as much
constexpr double kSettledNext = 0.002;  // that of the next pass, if changes shrink by the same factor again
constexpr double kSettledCorrection = 0.02;
constexpr double kSettledField = 0.03;  // root mean square of more than kFewValues, whose noise is larger
constexpr size_t kFewValues = 50;
// Initial guesses to try if the first is so soft that the loads crush the body.
constexpr double kStiffer[] = {1, 10, 100, 0.1};

std::vector<FitParameter> stiffer(std::vector<FitParameter> parameters, double factor) {
  for (FitParameter& u : parameters)
    if (is_stiffness(u.quantity)) u.guess *= factor;
  return parameters;
}

std::string suffix(double factor) {
  if (factor == 1) return "";
  return factor > 1 ? "_stiffer" + std::to_string(std::lround(factor)) : "_softer";
}

bool is_many(const std::vector<double>& p) { return p.size() > kFewValues; }

// Largest change of a few values. Among many values, single ones are determined less accurately than fits converge.
double change_between(const std::vector<double>& before, const std::vector<double>& after) {
  double largest = 0, squares = 0;
  for (size_t i = 0; i < before.size(); ++i) {
    const double change = std::abs(after[i] - before[i]);
    largest = std::max(largest, change), squares += change * change;
  }
  return is_many(after) ? std::sqrt(squares / static_cast<double>(after.size())) : largest;
}

double change_of_stiffness(const std::vector<MaterialParameters>& before,
                           const std::vector<MaterialParameters>& after) {
  double largest = 0;
  for (size_t t = 0; t < after.size(); ++t)
    largest = std::max(largest, std::abs(std::log(after[t].lame.mu / before[t].lame.mu)));
  return largest;
}

bool has_failed(const FitReport& report) { return report.p.empty() || report.status == Status::undefined; }
bool is_over(const FitReport& report) { return is_success(report.status) || report.status == Status::iteration_limit; }

}  // namespace

FitModel::FitModel(const Experiment& data, const SimulatedData& simulated, const FitPlan& plan,
                   std::vector<FitParameter> parameters, const StoredModel& stored)
    : map(data.mesh, plan.model, known_parameters(plan, data), std::move(parameters)),
      prior(make_regularizer(data.mesh, map, plan.regularizer)),
      is_condensed(!plan.robust && has_dense_readings(simulated.fitted())),
      fitted(is_condensed ? condensed(simulated.fitted()) : simulated.fitted()),
      misfit(fitted, map, plan.equilibrium),
      simulated_(simulated),
      equilibrium_(plan.equilibrium) {
  if (const std::vector<double> x = simulated.equilibria(); !x.empty()) misfit.set_state(x);
  const FitMemory& memory = stored.memory;
  if (!memory.folder.empty()) {
    const ModelState state{[this] { return misfit.state(); },
                           [this](std::span<const double> x) { misfit.set_state(x); }};
    journal.emplace(misfit, state, memory.folder / (memory.prefix + stored.name), stored.fingerprint, memory.start);
  }
  with_layers.emplace(recorded());
}

Misfit& FitModel::of_all_readings() {
  if (!is_condensed) return misfit;
  whole_.emplace(simulated_.fitted(), map, equilibrium_);
  whole_->set_state(misfit.state());
  return *whole_;
}

MaterialFit::MaterialFit(const DataSet& data, const FitPlan& plan, const FitMemory& memory,
                         const FitCallbacks& callbacks)
    : data_(data),
      plan_(completed(plan, data.experiment)),
      memory_(memory),
      callbacks_(callbacks),
      simulated_(data.experiment, plan_),
      jobs_(memory.jobs ? *memory.jobs : all_jobs_) {
  if (!memory.folder.empty()) fingerprint_ = fingerprint_of(data.experiment) + "\n" + text_of(plan_);
  outcome_.plan = plan_;
  outcome_.simulated_tets = simulated_.mesh().tet_count();
}

FitOutcome MaterialFit::run() {
  if (fits_fibres(plan_) && !find_fibres()) return std::move(outcome_);
  if (is_field() || has_model_errors() || has_corrections()) {
    if (!fit_single_values("uniform")) return std::move(outcome_);
    // Without a field, fit_fields() repeats this fit.
    const bool is_repeated = !is_field() && !has_corrections();
    if (learn_model_errors() && !is_repeated && !fit_single_values("uniform_corrected")) return std::move(outcome_);
    if (!is_field()) outcome_.uniform.reset();
  }
  fit_fields();
  return std::move(outcome_);
}

bool MaterialFit::is_field() const {
  return std::any_of(plan_.parameters.begin(), plan_.parameters.end(),
                     [](const FitParameter& u) { return u.parameterization != Parameterization::uniform; });
}

bool MaterialFit::has_many_values() const {
  return std::any_of(plan_.parameters.begin(), plan_.parameters.end(), [](const FitParameter& u) {
    return u.parameterization == Parameterization::tets || u.parameterization == Parameterization::handles;
  });
}

// One value per quantity explains most of the data and is the initial guess of fields.
bool MaterialFit::fit_single_values(const std::string& name) {
  begin(FitStage::uniform, "for the whole body");
  FitOptions options = plan_.fit;
  options.method = options.weight_rule = "auto";
  options.weight = -1;
  for (const double factor : kStiffer) {
    FitModel model(data_.experiment, simulated_, plan_, stiffer(single_values(plan_.parameters), factor),
                   {memory_, name + suffix(factor), fingerprint_});
    const FitReport report = fit_stage(FitStage::uniform, model, options);
    outcome_.uniform = outcome_.report = report;
    if (has_failed(report)) {
      outcome_.failure = describe_failure(data_, report, model.misfit.failure());
      continue;
    }
    if (!has_single_values(model, report)) return false;
    break;
  }
  if (!outcome_.failure.empty()) return false;
  if (!is_field()) use_corrections();  // one value explains a field worse than wrong corrections do
  return true;
}

bool MaterialFit::has_single_values(FitModel& model, const FitReport& report) {
  adopt_values(model.map, report.p, plan_);
  material_ = model.map.parameters(report.p);
  outcome_.failure = describe_runaway(data_, material_.front());
  if (!outcome_.failure.empty()) return false;
  if (report.status != Status::interrupted) {
    correct_data(model, report.p);
    if (model.journal) model.journal->catch_up();
    simulated_.start_from(model.misfit.state());
    if (!is_field() && p_of_errors_.empty()) p_of_errors_ = report.p;
    return true;
  }
  describe(model, report.p);
  return false;
}

bool MaterialFit::has_model_errors() const { return plan_.mesh_errors || plan_.law_errors; }

bool MaterialFit::learn_model_errors() {
  if (plan_.law_errors) add_law_errors();
  if (plan_.mesh_errors) subtract_mesh_errors();
  return has_model_errors() && !is_stopped();
}

void MaterialFit::add_law_errors() {
  if (is_stopped()) return;
  begin(FitStage::mesh_errors, "differences between laws");
  const std::string failure = simulated_.add_law_errors(plan_, material_);
  if (failure.empty()) return;
  add_warnings({"standard deviations do NOT include the choice of the law: with another one " + failure});
  plan_.law_errors = false;
}

void MaterialFit::subtract_mesh_errors() {
  if (is_stopped()) return;
  if (simulated_.is_too_large_for_mesh_errors()) {
    add_warnings({"the discretization error was NOT computed: the simulated mesh has " +
                  std::to_string(simulated_.mesh().tet_count()) + " tets, and " +
                  std::to_string(SimulatedData::kTooFine) +
                  " are the maximum; the material includes this error (use a coarser mesh, or a smaller "
                  "option refine)"});
    plan_.mesh_errors = false;
    return;
  }
  begin(FitStage::mesh_errors, "discretization error, by a mesh of eight times as many tets");
  const std::string failure = simulated_.subtract_mesh_errors(plan_, material_);
  if (!failure.empty()) {
    add_warnings({"the discretization error was NOT computed: on the finer mesh " + failure});
    plan_.mesh_errors = false;
    return;
  }
  outcome_.has_mesh_errors = true;
  outcome_.mesh_error = simulated_.mesh_error();
}

void MaterialFit::fit_until_mesh_errors_settle(std::optional<FitModel>& model) {
  const bool is_one_value = !outcome_.against_field.empty();
  const std::string stage = is_one_value ? "one_value" : "fit";
  outcome_.mesh_errors_settle = true;
  std::vector<double> start, before = std::exchange(p_of_errors_, {});
  double last_change = 0;
  FitOptions options = plan_.fit;
  for (int pass = 0;; ++pass) {
    const std::string name = pass == 0 ? stage : stage + "_corrected" + std::to_string(pass);
    model.emplace(data_.experiment, simulated_, plan_, plan_.parameters, StoredModel{memory_, name, fingerprint_});
    outcome_.report = fit_stage(is_one_value ? FitStage::uniform : FitStage::field, *model, options, start);
    const std::vector<double>& p = outcome_.report.p;
    if ((!has_model_errors() && !has_corrections()) || !is_success(outcome_.report.status)) return;
    const double change = change_between(before, p), corrections = correct_data(*model, p);
    const bool has_settled_next = !is_many(p) && change * change < kSettledNext * last_change;
    if (!before.empty() && (has_settled_next || change < (is_many(p) ? kSettledField : kSettled)) &&
        corrections < kSettledCorrection)
      return;
    if (pass == kPasses) {
      outcome_.mesh_errors_settle = false;
      return add_warnings({"corrections of the data and material do not converge: after " + std::to_string(kPasses) +
                           " rounds it still changes by " + std::to_string(change) +
                           " (of log E); refine the mesh (option refine)"});
    }
    options.weight = outcome_.report.weight;
    const std::vector<MaterialParameters> last_material = std::exchange(material_, model->map.parameters(p));
    last_change = before.empty() ? change_of_stiffness(last_material, material_) : change;
    start = before = p;
    model.reset();
    use_corrections();
    learn_model_errors();  // otherwise the last errors remain
  }
}

void MaterialFit::fit_fields() {
  const size_t warnings = outcome_.warnings.size();
  begin(FitStage::field, "");
  fit_and_describe();
  if (!has_many_values() || outcome_.interrupted || !outcome_.has_material() || !is_over(outcome_.report)) return;
  std::vector<FitReason> reasons = reasons_against_field(data_, outcome_);
  if (reasons.empty()) return;
  outcome_.warnings.resize(warnings);
  fall_back(std::move(reasons));
}

void MaterialFit::fall_back(std::vector<FitReason> reasons) {
  outcome_.against_field = std::move(reasons);
  outcome_.uniform.reset();
  outcome_.posterior.reset();
  outcome_.parts.reset();
  outcome_.held_out.reset();
  outcome_.held_out_of_one_value.reset();
  outcome_.cases.clear();
  plan_.parameters = outcome_.plan.parameters = single_values(plan_.parameters);
  plan_.fit.method = plan_.fit.weight_rule = "auto";
  plan_.fit.weight = -1;
  begin(FitStage::uniform, "for the whole body, because the data do not support a field");
  fit_and_describe();
}

void MaterialFit::fit_and_describe() {
  fit_until_mesh_errors_settle(last_);
  FitModel& model = *last_;
  const FitReport& report = outcome_.report;
  if (has_failed(report) || report.status == Status::no_descent) {
    outcome_.failure = describe_failure(data_, report, model.misfit.failure());
    return;
  }
  outcome_.failure = describe_runaway(data_, model.map.parameters(report.p).front());
  if (!outcome_.failure.empty()) return;
  if (!is_over(report)) return describe(model, report.p);
  if (jobs_.is_distributed()) {
    if (plan_.cross_validation) hold_out_groups(model);  // first, because its jobs need none of the stages below
    if (outcome_.interrupted) return;
  }
  learn_uncertainty(model);
  const std::vector<double> p = divided(model);
  describe(model, p);
  predict_left_out(model.map, p);
  if (!outcome_.interrupted) cross_validate_groups(model);
}

FitReport MaterialFit::fit_stage(FitStage which, FitModel& model, const FitOptions& options,
                                 const std::vector<double>& start) {
  outcome_.parameter_count = model.map.size();
  outcome_.residuals = model.misfit.reading_count();
  const auto observe = [&](const FitIteration& iteration, std::span<const double> p) {
    if (callbacks_.iterate) callbacks_.iterate(which, iteration, p);
  };
  FitOptions stoppable = options;
  stoppable.stop = StopToken([&] {
    if (!is_stopped()) return false;
    if (model.journal) model.journal->stop_writing();  // a resumed fit does not repeat later evaluations
    return true;
  });
  FitReport report = fit(model.data(), *model.prior, start.empty() ? model.map.guess() : start, stoppable, observe);
  outcome_.counts = model.misfit.counts();
  return report;
}

void MaterialFit::begin(FitStage stage, const std::string& what) {
  if (callbacks_.begin) callbacks_.begin(stage, what);
}

bool MaterialFit::is_stopped() {
  if (callbacks_.stop.stopped()) outcome_.interrupted = true;
  return outcome_.interrupted;
}

void MaterialFit::add_warnings(const std::vector<std::string>& more) {
  outcome_.warnings.insert(outcome_.warnings.end(), more.begin(), more.end());
}

}  // namespace aspic

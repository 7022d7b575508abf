#include <algorithm>
#include <cmath>
#include <utility>

#include "model/limits.h"
#include "pipeline/fit_stages.h"
#include "pipeline/fit_troubles.h"
#include "pipeline/fit_verdict.h"

namespace aspic {
namespace {

constexpr double kSettledField = 0.03;  // root mean square of many values, whose fits are less accurate. Chosen
bool is_many(const std::vector<double>& p) { return p.size() > kFewParameters; }

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

bool is_over(const FitReport& report) { return is_success(report.status) || report.status == Status::iteration_limit; }

// Repeats the fit until the discretization error no longer changes with the material.
void fit_until_mesh_errors_settle(FitState& state) {
  const bool is_one_value = !state.outcome.against_field.empty();
  const std::string stage = is_one_value ? "one_value" : "fit";
  state.outcome.mesh_errors_settle = true;
  std::vector<double> start, before = std::exchange(state.p_of_errors, {});
  double last_change = 0;
  FitOptions options = state.plan.fit;
  for (int pass = 0;; ++pass) {
    const std::string name = pass == 0 ? stage : stage + "_corrected" + std::to_string(pass);
    state.model.emplace(state.data.experiment, state.simulated, state.plan, state.plan.parameters,
                        StoredModel{state.memory, name, state.fingerprint});
    state.outcome.report =
        fit_model(state, is_one_value ? FitStage::uniform : FitStage::field, *state.model, options, start);
    const std::vector<double>& p = state.outcome.report.p;
    if ((!state.has_model_errors() && !state.has_corrections()) || !is_success(state.outcome.report.status)) return;
    const double change = change_between(before, p), corrections = state.estimate_corrections(*state.model, p);
    // If changes shrink by the same factor again, the next one is a tenth of what counts as settled.
    const bool has_settled_next = !is_many(p) && change * change < kSettled / 10 * last_change;
    if (!before.empty() && (has_settled_next || change < (is_many(p) ? kSettledField : kSettled)) &&
        corrections < kSettled)
      return;
    if (pass == kFixedPointPasses) {
      state.outcome.mesh_errors_settle = false;
      return state.warn("corrections of the data and material do not converge: after " +
                        std::to_string(kFixedPointPasses) + " rounds it still changes by " + std::to_string(change) +
                        " (of log E); refine the mesh (option refine)");
    }
    options.weight = state.outcome.report.weight;
    const std::vector<MaterialParameters> last_material = std::exchange(state.material, state.model->map.parameters(p));
    last_change = before.empty() ? change_of_stiffness(last_material, state.material) : change;
    start = before = p;
    state.model.reset();
    state.apply_corrections();
    correct_model_errors(state);  // otherwise the last errors remain
  }
}

void fit_and_describe(FitState& state) {
  fit_until_mesh_errors_settle(state);
  FitModel& model = *state.model;
  const FitReport& report = state.outcome.report;
  if (!report.has_material() || report.status == Status::no_descent) {
    state.outcome.failure = describe_failure(state.data, report, model.misfit.failure());
    return;
  }
  state.outcome.failure = describe_runaway(state.data, model.map.parameters(report.p).front());
  if (!state.outcome.failure.empty()) return;
  if (!is_over(report)) return describe(state, model, report.p);
  if (state.jobs.is_distributed()) {
    if (state.plan.cross_validation)
      compute_held_out_jobs(state);  // first, because its jobs need none of the stages below
    if (state.outcome.interrupted) return;
  }
  quantify_uncertainty(state);
  describe(state, model, divided_into_parts(state));
  predict_left_out(state);
  if (!state.outcome.interrupted) cross_validate_groups(state);
}

// Replaces an unsupported field by one value; stores the reasons.
void fall_back(FitState& state, std::vector<FitReason> reasons) {
  state.outcome.against_field = std::move(reasons);
  state.outcome.uniform.reset();
  state.outcome.posterior.reset();
  state.outcome.parts.reset();
  state.outcome.held_out.reset();
  state.outcome.held_out_of_one_value.reset();
  state.outcome.cases.clear();
  state.plan.parameters = state.outcome.plan.parameters = single_values(state.plan.parameters);
  state.plan.fit = for_single_values(state.plan.fit);
  state.begin(FitStage::uniform, "for the whole body, because the data do not support a field");
  fit_and_describe(state);
}

}  // namespace

void fit_fields(FitState& state) {
  const size_t warnings = state.outcome.warnings.size();
  state.begin(FitStage::field, "");
  fit_and_describe(state);
  if (!has_many_values(state.plan) || state.outcome.interrupted || !state.outcome.has_material() ||
      !is_over(state.outcome.report))
    return;
  std::vector<FitReason> reasons = reasons_against_field(state.data, state.outcome);
  if (reasons.empty()) return;
  state.outcome.warnings.resize(warnings);
  fall_back(state, std::move(reasons));
}

}  // namespace aspic

#include "pipeline/law_fits.h"

#include <algorithm>
#include <array>

#include "model/limits.h"
#include "pipeline/fit_troubles.h"

namespace aspic {
namespace {

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

JobResult job_result_of(const FittedLaw& c, const std::vector<FitIteration>& iterations) {
  JobResult result{{c.objective, static_cast<double>(c.p.size())}, c.failure};
  result.numbers.insert(result.numbers.end(), c.p.begin(), c.p.end());
  for (const FitIteration& i : iterations)
    for (const double number : numbers_of(i)) result.numbers.push_back(number);
  return result;
}

}  // namespace

LawFits::LawFits(const DataSet& data, const FitPlan& plan, FitJobs& jobs, const FitCallbacks& callbacks)
    : data_(data), plan_(plan), jobs_(jobs), callbacks_(callbacks), simulated_(data.experiment, plan_) {}

bool LawFits::run() {
  for (const Law& law : compared_laws())
    laws_.push_back({.law = law, .plan = with_law(plan_, law), .p = {}, .material = {}, .failure = {}});
  // All laws start from the moduli of the first one.
  run_job(laws_.front(), "reference", JobKind::common, [&] { find_reference(); });
  subtract_mesh_errors(laws_.front());
  for (FittedLaw& c : laws_) {
    const bool is_first = &c == &laws_.front();
    run_job(c, "first", is_first ? JobKind::common : JobKind::independent, [&] { fit(c, ""); });
    if (is_first) reference_ = c.p;
  }
  if (is_stopped() || jobs_.is_waiting()) return false;
  if (!plan_.mesh_errors) return true;
  subtract_mesh_errors(*std::min_element(laws_.begin(), laws_.end(),
                                         [](const auto& a, const auto& b) { return a.objective < b.objective; }));
  for (FittedLaw& c : laws_)
    run_job(c, "second", JobKind::independent, [&] { fit(c, " with the mesh correction of the best one"); });
  return !is_stopped() && !jobs_.is_waiting();
}

void LawFits::run_job(FittedLaw& c, const std::string& stage, JobKind kind, const std::function<void()>& action) {
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
        return is_stopped() ? std::nullopt : std::optional(job_result_of(c, iterations_));
      });
  if (result && !is_computed) restore(*result, c);
}

void LawFits::restore(const JobResult& result, FittedLaw& c) {
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

FitModel LawFits::model_of(const FittedLaw& c, std::vector<FitParameter> parameters) const {
  return {data_.experiment, simulated_, c.plan, std::move(parameters), {{}, "", ""}};
}

void LawFits::find_reference() {
  FittedLaw& first = laws_.front();
  for (const double factor : kGuessFactors) {
    FitModel model = model_of(first, stiffer(first.plan.parameters, factor));
    if (minimize(first, model, model.map.guess()) || is_stopped()) return;
  }
}

std::vector<std::vector<double>> LawFits::starts_of(const FittedLaw& c) const {
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

void LawFits::fit(FittedLaw& c, const std::string& how) {
  if (is_stopped()) return;
  if (callbacks_.begin) callbacks_.begin(FitStage::law, c.law.name + how);
  c.objective = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& start : starts_of(c)) {
    FitModel model = model_of(c, c.plan.parameters);
    minimize(c, model, start);
    if (is_stopped() || 2 * c.objective < kTooManySquares * model.misfit.residual_count()) return;
  }
}

bool LawFits::minimize(FittedLaw& c, FitModel& model, std::span<const double> start) {
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

void LawFits::subtract_mesh_errors(const FittedLaw& c) {
  if (!plan_.mesh_errors || c.material.empty() || is_stopped() || is_too_large_for_mesh_errors(simulated_.mesh()))
    return;
  if (callbacks_.begin) callbacks_.begin(FitStage::mesh_errors, "discretization error with " + c.law.name);
  simulated_.subtract_mesh_errors(c.plan, c.material);  // if this fails, the last correction remains
}

}  // namespace aspic

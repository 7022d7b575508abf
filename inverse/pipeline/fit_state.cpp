#include "pipeline/fit_state.h"

#include <utility>

namespace aspic {

FitState::FitState(const DataSet& given, const FitPlan& wanted, const FitMemory& kept, const FitCallbacks& reports)
    : data(given),
      memory(kept),
      callbacks(reports),
      jobs(kept.jobs ? *kept.jobs : all_jobs),
      plan(completed(wanted, given.experiment)),
      simulated(given.experiment, plan) {
  if (!memory.folder.empty()) fingerprint = fingerprint_of(data.experiment) + "\n" + text_of(plan);
  outcome.plan = plan;
  outcome.simulated_tets = simulated.mesh().tet_count();
}

FitModel FitState::model_of(const FitPlan& trial, std::vector<FitParameter> parameters, const std::string& name) const {
  return {data.experiment, simulated, trial, std::move(parameters), {memory, name, fingerprint}};
}

bool FitState::is_stopped() {
  if (callbacks.stop.stopped()) outcome.interrupted = true;
  return outcome.interrupted;
}

double FitState::estimate_corrections(FitModel& of, std::span<const double> at) {
  return has_corrections() ? corrections.estimate(of, at, simulated, plan.robust) : 0;
}

void FitState::apply_corrections() {
  if (has_corrections()) corrections.apply(simulated);
}

void FitState::begin(FitStage stage, const std::string& what) const {
  if (callbacks.begin) callbacks.begin(stage, what);
}

FitReport fit_model(FitState& state, FitStage stage, FitModel& model, const FitOptions& options,
                    const std::vector<double>& start) {
  state.outcome.parameter_count = model.map.size();
  state.outcome.residuals = model.misfit.reading_count();
  const auto observe = [&](const FitIteration& iteration, std::span<const double> p) {
    if (state.callbacks.iterate) state.callbacks.iterate(stage, iteration, p);
  };
  FitOptions stoppable = options;
  stoppable.stop = StopToken([&] {
    if (!state.is_stopped()) return false;
    if (model.journal) model.journal->stop_writing();  // a resumed fit does not repeat later evaluations
    return true;
  });
  FitReport report = fit(model.data(), *model.prior, start.empty() ? model.map.guess() : start, stoppable, observe);
  state.outcome.counts = model.misfit.counts();
  return report;
}

}  // namespace aspic

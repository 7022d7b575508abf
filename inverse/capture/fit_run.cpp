#include "capture/fit_run.h"

#include "capture/law_contest.h"
#include "capture/material_fit.h"
#include "capture/relaxation.h"

namespace aspic {

namespace {

FitOutcome fit_with_chosen_law(const DataSet& data, const FitPlan& plan, const FitMemory& memory,
                               const FitCallbacks& callbacks) {
  FitJobs all;
  FitJobs& jobs = memory.jobs ? *memory.jobs : all;
  LawChoice choice = choose_law(data, plan, jobs, callbacks);
  FitOutcome outcome;
  if (callbacks.stop.stopped() || jobs.is_waiting()) {
    outcome.plan = plan;
    outcome.interrupted = true;
    outcome.failure = "stopped before a law was chosen; --resume continues the comparison";
  } else {
    outcome = fit_material(data, plan_with_law(plan, choice), memory, callbacks);
  }
  outcome.law_choice = std::move(choice);
  return outcome;
}

}  // namespace

FitOutcome fit_material(const DataSet& data, const FitPlan& plan, const FitMemory& memory,
                        const FitCallbacks& callbacks) {
  if (plan.model == kAutoLaw) return fit_with_chosen_law(data, completed(plan, data.experiment), memory, callbacks);
  FitOutcome outcome = MaterialFit(data, plan, memory, callbacks).run();
  if (outcome.posterior) outcome.posterior->gaussian.reset();  // refers to the prior, which no longer exists
  const bool has_branches = !data.histories.empty() && outcome.plan.branches >= 0;
  if (has_branches && outcome.has_material() && !outcome.interrupted) add_relaxation(data, callbacks, outcome);
  return outcome;
}

}  // namespace aspic

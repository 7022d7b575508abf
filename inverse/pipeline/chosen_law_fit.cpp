#include "pipeline/chosen_law_fit.h"

#include <map>

#include "base/formatted.h"
#include "pipeline/compared_laws.h"
#include "pipeline/fit_verdict.h"
#include "pipeline/law_comparison.h"

namespace aspic {
namespace {

class ChosenLawFit {
 public:
  ChosenLawFit(const DataSet& data, const FitPlan& plan, const FitMemory& memory, const FitCallbacks& callbacks)
      : data_(data), plan_(plan), memory_(memory), callbacks_(callbacks), jobs_(memory.jobs ? *memory.jobs : all_) {}

  FitOutcome run() {
    choice_ = choose_law(data_, plan_, jobs_, callbacks_);
    if (is_stopped()) {
      FitOutcome outcome;
      outcome.plan = plan_;
      outcome.interrupted = true;
      outcome.failure = "stopped before a law was chosen; --resume continues the comparison";
      return finished(std::move(outcome));
    }
    if (choice_.chosen < 0) return finished(fitted(plan_with_law(plan_, choice_), ""));
    for (;;) {
      const int law = choice_.chosen;
      const bool is_known = materials_.contains(law);
      if (!is_known) materials_[law] = material();
      FitOutcome& outcome = materials_[law];
      if (is_known || outcome.interrupted || is_supported(outcome)) return finished(std::move(outcome));
      judge_laws(choice_);
      if (choice_.chosen < 0) return finished(std::move(outcome));
    }
  }

 private:
  LawTrial& trial() { return choice_.trials[static_cast<size_t>(choice_.chosen)]; }

  bool is_stopped() const { return callbacks_.stop.stopped() || jobs_.is_waiting(); }

  // The material as requested, with the chosen law.
  FitOutcome material() {
    const bool is_first = materials_.empty();
    if (!is_first && callbacks_.begin) callbacks_.begin(FitStage::law, trial().law + ", because a verdict was bad");
    return fitted(plan_with_law(plan_, choice_), is_first ? "" : trial().law + "_");
  }

  FitOutcome fitted(const FitPlan& plan, const std::string& prefix) {
    FitMemory memory = memory_;
    memory.prefix = prefix;
    return fit_material(data_, plan, memory, callbacks_);
  }

  // Whether the verdict of the chosen law is good, or bad only because of a field. Otherwise notes the reason.
  bool is_supported(FitOutcome& outcome) {
    std::string against = reason_against(outcome);
    if (against.empty()) return true;
    if (!choice_.simplified.empty() && !outcome.relaxation) {
      if (callbacks_.begin) callbacks_.begin(FitStage::law, trial().law + " with " + choice_.simplified);
      const FitPlan simple = simplified(plan_with_law(plan_, choice_), data_.experiment.mesh);
      const FitOutcome few_values = fitted(simple, trial().law + "_simplified_");
      if (few_values.interrupted) outcome.interrupted = true;
      if (outcome.interrupted) return true;
      against = reason_against(few_values);
    }
    if (against.empty()) return true;
    (outcome.has_material() ? trial().against : trial().failure) = against;
    return false;
  }

  std::string reason_against(const FitOutcome& outcome) const {
    if (!outcome.has_material()) return outcome.failure;
    for (const FitReason& reason : verdict(data_, outcome).reasons)
      if (reason.name != "linear_tets") return reason.text;  // that of all laws
    return "";
  }

  FitOutcome finished(FitOutcome outcome) {
    if (outcome.relaxation && outcome.relaxation->is_ok() && outcome.relaxation->scale != 1)
      choice_.text +=
          " The values of the comparison do not contain the factor of the stiffness that histories imply, " +
          three_digits(outcome.relaxation->scale) + ".";
    outcome.law_choice = std::move(choice_);
    return outcome;
  }

  const DataSet& data_;
  const FitPlan& plan_;
  const FitMemory& memory_;
  const FitCallbacks& callbacks_;
  FitJobs all_;
  FitJobs& jobs_;
  LawChoice choice_;
  std::map<int, FitOutcome> materials_;  // by the index of the trial
};

}  // namespace

FitOutcome fit_with_chosen_law(const DataSet& data, const FitPlan& plan, const FitMemory& memory,
                               const FitCallbacks& callbacks) {
  return ChosenLawFit(data, plan, memory, callbacks).run();
}

}  // namespace aspic

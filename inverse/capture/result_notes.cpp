#include "capture/result_notes.h"

#include "base/formatted.h"

namespace aspic {
namespace {

std::string percent_text(double part) { return part < 0 ? "-" : three_digits(100 * part) + " %"; }

std::string note_of(const LawTrial& trial) {
  if (!trial.is_fitted()) return "Law " + trial.law + ": " + trial.verdict + ".";
  std::string values;
  for (const LawValue& v : trial.values)
    values += (values.empty() ? "" : ", ") + v.quantity + (v.where == "everywhere" ? " " : " in " + v.where + " ") +
              six_digits(v.value) + (v.unit.empty() ? "" : " " + v.unit);
  return "Law " + trial.law + ": " + trial.verdict + "; " + values + "; |r|^2 " +
         three_digits(trial.squares / trial.residuals) + " per reading; log evidence " +
         formatted("%.2f", -trial.evidence_loss) + " and held-out log probability " +
         formatted("%.2f", -trial.held_out_loss) + " relative to the best; held-out errors " +
         percent_text(trial.position_error) + " (positions) and " + percent_text(trial.force_error) + " (forces).";
}

std::string note_of(const FittedBranch& branch) {
  return "Relaxation time " + three_digits(branch.time) + " s (95 %: " + three_digits(branch.time_interval.lower) +
         " s to " + three_digits(branch.time_interval.upper) + " s), shear modulus " + three_digits(branch.ratio) +
         " times that of the material (95 %: " + three_digits(branch.ratio_interval.lower) + " to " +
         three_digits(branch.ratio_interval.upper) + "), " + three_digits(100 * branch.fraction) +
         " % of that for fast loads.";
}

}  // namespace

std::vector<std::string> result_notes(const FitOutcome& outcome) {
  std::vector<std::string> notes;
  if (outcome.law_choice) {
    notes.push_back(outcome.law_choice->text);
    for (const LawTrial& trial : outcome.law_choice->trials) notes.push_back(note_of(trial));
  }
  if (outcome.relaxation && outcome.relaxation->is_ok()) {
    const RelaxationFit& fit = *outcome.relaxation;
    notes.push_back("Histories: |r|^2 is " + three_digits(fit.squares / fit.residuals) + " per reading of " +
                    std::to_string(fit.residuals) + "; relaxation.svg shows them.");
    for (const FittedBranch& branch : fit.branches) notes.push_back(note_of(branch));
  }
  return notes;
}

}  // namespace aspic

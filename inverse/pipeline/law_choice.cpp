#include "pipeline/law_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/formatted.h"
#include "model/limits.h"

namespace aspic {
namespace {

double informed(const LawTrial& trial) {
  double sum = 0;
  for (const double d : trial.information) sum += d / (1 + d);
  return sum;
}

// Factor by which the standard deviations are too small, even for the law with the smallest |r|^2. Within the scatter
// of chi^2 it is 1.
double noise_factor(const std::vector<LawTrial>& trials) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const LawTrial& trial : trials) {
    if (!trial.is_fitted()) continue;
    const double free = std::max(trial.residuals - informed(trial), 1.0);
    const bool is_explained = trial.squares < trial.residuals + 3 * std::sqrt(2.0 * trial.residuals);
    smallest = std::min(smallest, is_explained ? 1.0 : trial.squares / free);
  }
  return std::isfinite(smallest) ? std::sqrt(std::max(smallest, 1.0)) : 1.0;
}

// Laplace's approximation, up to a constant that all laws share.
double log_evidence(const LawTrial& trial, double factor) {
  double determinant = 0;
  for (const double d : trial.information) determinant += std::log1p(d / (factor * factor));
  return -trial.squares / (2 * factor * factor) - trial.roughness - determinant / 2;
}

double held_out_log_probability(const LawTrial& trial, double factor) {
  double sum = 0;
  for (const PredictiveResiduals& group : trial.held_out) sum += group.log_probability(factor);
  return sum;
}

template <class Score>
const LawTrial* best_by(const std::vector<LawTrial>& trials, const Score& score) {
  const LawTrial* best = nullptr;
  for (const LawTrial& trial : trials)
    if (trial.is_fitted() && (!best || score(trial) > score(*best))) best = &trial;
  return best;
}

bool is_simpler(const LawTrial& a, const LawTrial& b) {
  if (a.parameters != b.parameters) return a.parameters < b.parameters;
  return a.evidence_loss < b.evidence_loss;
}

void add_losses(LawChoice& choice) {
  const double factor = choice.noise_factor;
  const auto evidence = [&](const LawTrial& t) { return log_evidence(t, factor); };
  const auto held_out = [&](const LawTrial& t) { return held_out_log_probability(t, factor); };
  const LawTrial *likeliest = best_by(choice.trials, evidence), *predictor = best_by(choice.trials, held_out);
  for (LawTrial& trial : choice.trials) {
    if (!trial.is_fitted()) continue;
    trial.evidence_loss = evidence(*likeliest) - evidence(trial);
    trial.held_out_loss = held_out(*predictor) - held_out(trial);
  }
}

// Laws to choose from: those without a bad verdict if there are any.
bool is_candidate(const LawTrial& trial, const LawChoice& choice) {
  return choice.has_supported() ? trial.is_supported() : trial.is_fitted();
}

double least_loss(const LawChoice& choice, double LawTrial::*loss) {
  double least = std::numeric_limits<double>::infinity();
  for (const LawTrial& trial : choice.trials)
    if (is_candidate(trial, choice)) least = std::min(least, trial.*loss);
  return least;
}

// Losses are NaN if no law predicts all groups.
bool predicts_as_well(const LawTrial& trial, const LawChoice& choice) {
  return !(trial.held_out_loss > least_loss(choice, &LawTrial::held_out_loss) + kStrongEvidence);
}

// Marks the candidates that predict held-out groups as well as the best one and, among these, have about the best
// evidence.
void mark_best(LawChoice& choice) {
  const auto is_predictor = [&](const LawTrial& t) { return is_candidate(t, choice) && predicts_as_well(t, choice); };
  double least = std::numeric_limits<double>::infinity();
  for (const LawTrial& trial : choice.trials)
    if (is_predictor(trial)) least = std::min(least, trial.evidence_loss);
  for (LawTrial& trial : choice.trials)
    trial.is_as_good = is_predictor(trial) && trial.evidence_loss <= least + kStrongEvidence;
}

std::string verdict_of(const LawTrial& trial, const LawChoice& choice) {
  const LawTrial& chosen = choice.trials[static_cast<size_t>(choice.chosen)];
  if (!trial.is_fitted()) return "failed: " + trial.failure;
  if (&trial == &chosen) return trial.is_supported() ? "chosen" : "chosen, but its verdict is bad: " + trial.against;
  if (!trial.is_supported()) return "its verdict is bad: " + trial.against;
  const int more = trial.parameters - chosen.parameters;
  if (trial.is_as_good && more == 0) return "not distinguished from the chosen law, with as many values";
  if (trial.is_as_good)
    return "not distinguished from the chosen law, with " + std::to_string(more) + " more value" +
           (more > 1 ? "s" : "");
  if (!predicts_as_well(trial, choice)) return "predicts held-out groups worse";
  return "less probable";
}

std::string enumerated(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

std::string about_bad_verdicts(const LawChoice& choice) {
  if (!choice.has_supported()) return "No law has a good verdict: do not rely on any of them. ";
  std::string text;
  for (const LawTrial& trial : choice.trials)
    if (trial.is_fitted() && !trial.is_supported())
      text += "By these figures alone " + trial.law + " would be preferred, but its verdict is bad: " + trial.against +
              ". ";
  return text;
}

std::string conclusion(const LawChoice& choice) {
  const LawTrial& chosen = choice.trials[static_cast<size_t>(choice.chosen)];
  std::vector<std::string> equal, worse;
  for (const LawTrial& trial : choice.trials) {
    if (&trial == &chosen || !is_candidate(trial, choice)) continue;
    (trial.is_as_good ? equal : worse).push_back(trial.law);
  }
  const std::string strains = "strains reach " + three_digits(100 * choice.strain) + " %";
  std::string text;
  if (!equal.empty())
    text = "The data do not distinguish " + chosen.law + " from " + enumerated(equal) + " (" + strains + "). ";
  if (!worse.empty())
    text += chosen.law + (worse.size() == 1 ? " is better than " : " is better than each of ") + enumerated(worse) +
            (equal.empty() ? " (" + strains + "). " : ". ");
  text += about_bad_verdicts(choice);
  if (choice.noise_factor > 1)
    text += "No law explains the readings: their standard deviations count as " + three_digits(choice.noise_factor) +
            " times larger. ";
  if (!choice.simplified.empty()) text += "The laws were compared with " + choice.simplified + ". ";
  if (chosen.held_out.empty()) text += "No group was held out. ";
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace

bool LawChoice::has_supported() const {
  return std::any_of(trials.begin(), trials.end(), [](const LawTrial& t) { return t.is_supported(); });
}

void judge_laws(LawChoice& choice) {
  choice.noise_factor = noise_factor(choice.trials);
  choice.chosen = -1;
  if (std::none_of(choice.trials.begin(), choice.trials.end(), [](const LawTrial& t) { return t.is_fitted(); })) {
    for (LawTrial& trial : choice.trials) trial.verdict = "failed: " + trial.failure;
    choice.text = "No law could be fitted.";
    return;
  }
  add_losses(choice);
  mark_best(choice);
  for (size_t i = 0; i < choice.trials.size(); ++i)
    if (choice.trials[i].is_as_good &&
        (choice.chosen < 0 || is_simpler(choice.trials[i], choice.trials[static_cast<size_t>(choice.chosen)])))
      choice.chosen = static_cast<int>(i);
  for (LawTrial& trial : choice.trials) trial.verdict = verdict_of(trial, choice);
  choice.text = conclusion(choice);
}

}  // namespace aspic

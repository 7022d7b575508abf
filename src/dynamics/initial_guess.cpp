#include "dynamics/initial_guess.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "contact/barrier.h"
#include "dynamics/advance_boundary.h"
#include "dynamics/guesser.h"
#include "dynamics/integrator.h"

namespace aspic {

// In the order of InitialGuess.
constexpr std::string_view kInitialGuessNames[] = {"none",         "best",           "zero",       "current",
                                                   "extrapolated", "last_increment", "accelerated"};

std::string_view to_string(InitialGuess guess) { return kInitialGuessNames[static_cast<size_t>(guess)]; }

namespace {

constexpr InitialGuess kChoices[] = {InitialGuess::best,           InitialGuess::zero,
                                     InitialGuess::current,        InitialGuess::extrapolated,
                                     InitialGuess::last_increment, InitialGuess::accelerated};
// Candidates of `best` after `current`, in order.
constexpr InitialGuess kAhead[] = {InitialGuess::extrapolated, InitialGuess::last_increment, InitialGuess::accelerated};

}  // namespace

std::vector<std::string> initial_guess_names() {
  std::vector<std::string> names;
  for (const InitialGuess guess : kChoices) names.emplace_back(to_string(guess));
  return names;
}

InitialGuess initial_guess_named(const std::string& name) {
  for (const InitialGuess guess : kChoices)
    if (to_string(guess) == name) return guess;
  throw InvalidInput("initial_guess = '" + name + "' is unknown" + suggestion(name, initial_guess_names()));
}

bool Guesser::propose(const StepTools& tools, InitialGuess candidate, const GuessContext& known) {
  trial_.assign(known.q.begin(), known.q.end());
  if (candidate == InitialGuess::zero) {
    const std::vector<Vec3d>& X = tools.model.mesh.rest;
    for (size_t i = 0; i < trial_.size(); ++i) trial_[i] = i / 3 < X.size() ? X[i / 3][static_cast<int>(i % 3)] : 0;
  } else if (candidate == InitialGuess::extrapolated) {
    if (known.ahead == 0) return false;
    for (size_t i = 0; i < trial_.size(); ++i) trial_[i] += known.ahead * known.qdot[i];
  } else if (candidate == InitialGuess::last_increment) {
    if (!tools.previous) return false;
    const State &last = *tools.previous, &start = tools.start;
    const double part = known.ahead > 0 ? known.ahead / (start.time - last.time) : 1;
    for (size_t i = 0; i < trial_.size(); ++i) trial_[i] += part * (start.q[i] - last.q[i]);
  } else if (candidate == InitialGuess::accelerated) {
    if (!tools.previous || known.beta == 0) return false;
    const State &last = *tools.previous, &start = tools.start;
    const double part = known.beta * known.beta / (start.time - last.time);
    for (size_t i = 0; i < trial_.size(); ++i) trial_[i] = known.predicted[i] + part * (start.qdot[i] - last.qdot[i]);
  }
  tools.pins.place(known.time, trial_);
  return true;
}

// Shortens the path from `from` to the candidate before bodies touch.
void Guesser::stop_at_contact(const StepTools& tools, std::span<const double> from) {
  if (!tools.model.contact) return;
  path_.resize(trial_.size());
  for (size_t i = 0; i < path_.size(); ++i) path_[i] = trial_[i] - from[i];
  const double step = tools.E.max_step(from, path_);
  if (step >= 1) return;
  for (size_t i = 0; i < path_.size(); ++i) trial_[i] = from[i] + step * path_[i];
}

Guess Guesser::guess(const StepTools& tools, InitialGuess requested, const GuessContext& known, std::span<double> q,
                     MinimizeReport& work) {
  const bool is_other = requested != InitialGuess::best && requested != InitialGuess::current && !tools.model.contact;
  if (is_other && propose(tools, requested, known)) {
    const Evaluation value = tools.E.evaluate(trial_);
    ++work.values;
    if (std::isfinite(value.value)) {
      std::copy(trial_.begin(), trial_.end(), q.begin());
      return {requested, value};
    }
  }

  // Bodies that move with the obstacles need no continuation.
  for (const InitialGuess candidate : kAhead) {
    if (!tools.model.contact || !tools.model.contact->has_moving_obstacle()) break;
    if ((requested != InitialGuess::best && requested != candidate) || !propose(tools, candidate, known)) continue;
    if (!is_free(tools, {known.q, trial_, tools.obstacle_start, known.time})) continue;
    const Evaluation value = tools.E.evaluate(trial_);
    ++work.values;
    if (!std::isfinite(value.value)) continue;
    std::copy(trial_.begin(), trial_.end(), q.begin());
    return {candidate, value};
  }

  std::copy(known.q.begin(), known.q.end(), q.begin());
  Guess best = {InitialGuess::current, advance_boundary(tools, known.time, known.q, q, work)};
  if (requested == InitialGuess::current) return best;
  if (tools.model.contact && !std::isfinite(best.value.value))
    return best;  // pins are at the end of the last feasible path
  for (const InitialGuess candidate : kAhead) {
    if (candidate == InitialGuess::last_increment && !known.tries_last_increment) continue;
    if (tools.model.contact && requested != InitialGuess::best && requested != candidate) continue;
    if (!propose(tools, candidate, known)) continue;
    stop_at_contact(tools, q);
    const Evaluation value = tools.E.evaluate(trial_);
    ++work.values;
    // Skips a body at rest. The comparison is false for NaN.
    if (!(candidate == InitialGuess::extrapolated ? value.value <= best.value.value : value.value < best.value.value))
      continue;
    std::copy(trial_.begin(), trial_.end(), q.begin());
    best = {candidate, value};
  }
  return best;
}

}  // namespace aspic

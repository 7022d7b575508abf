// Computes the initial guess of a minimization.
#pragma once
#include <span>
#include <vector>

#include "dynamics/initial_guess.h"
#include "optimize/minimize.h"

namespace aspic {

struct StepTools;

// Input of an initial guess.
struct GuessContext {
  std::span<const double> q, qdot;         // latest positions and velocities
  double ahead = 0;                        // time from these to the end of the stage [s]; 0 in statics
  double time = 0;                         // time at the end of the stage [s]
  std::span<const double> predicted = {};  // q~ of the stage
  double beta = 0;                         // beta of the stage, which ends at q~ + beta^2 acc [s]; 0 in statics
  bool tries_last_increment = true;        // `best` includes it; false if it equals the extrapolated guess
};

struct Guess {
  InitialGuess used = InitialGuess::current;
  Evaluation value;  // E at the guess
};

class Guesser {  // owns the scratch vectors
 public:
  // Writes the initial guess to `q` and returns its kind. Pinned vertices are at their positions at `known.time`. If
  // the requested guess has infinite energy, uses the best one. If all have, moves the pins in substeps (see
  // advance_boundary.h). Adds the evaluations to `work`.
  Guess guess(const StepTools& tools, InitialGuess requested, const GuessContext& known, std::span<double> q,
              MinimizeReport& work);

 private:
  // Writes the candidate to trial_. Returns false if it does not exist.
  bool propose(const StepTools& tools, InitialGuess candidate, const GuessContext& known);

  void stop_at_contact(const StepTools& tools, std::span<const double> from);

  std::vector<double> trial_, path_;
};

}  // namespace aspic

// Computes the initial guess of a step's minimization.
#pragma once
#include <span>
#include <vector>

#include "dynamics/initial_guess.h"
#include "optimize/minimize.h"

namespace aspic {

struct StepTools;

// The data from which an initial guess is computed.
struct GuessContext {
  std::span<const double> q, qdot;         // the latest positions and velocities
  double ahead = 0;                        // from them to the minimization's time [s]; 0 in statics
  double time = 0;                         // of the minimization [s]
  std::span<const double> predicted = {};  // q~ of the stage
  double beta = 0;                         // of the stage, whose end is q~ + beta^2 acc [s]; 0 in statics
  bool tries_last_increment = true;        // `best` does; not where it is the extrapolated guess
};

struct Guess {
  InitialGuess used = InitialGuess::current;
  Evaluation value;  // of E there
};

class Guesser {  // holds the scratch vectors
 public:
  // Writes the initial guess to `q` and returns its kind. Pinned vertices are at their positions at `known.time`. If
  // the wanted guess has infinite energy, the best one is used; if all have, the pins move in substeps (see lead_pins).
  // Adds the evaluations to `work`.
  Guess guess(const StepTools& tools, InitialGuess wanted, const GuessContext& known, std::span<double> q,
              MinimizeReport& work);

 private:
  // Writes the candidate to trial_. Returns false if it does not exist.
  bool propose(const StepTools& tools, InitialGuess candidate, const GuessContext& known);

  void stop_at_contact(const StepTools& tools, std::span<const double> from);

  std::vector<double> trial_, path_;
};

}  // namespace aspic

// Adaptive time steps by step doubling. A step of length h consists of substeps of length h / 2^k. Each pair of
// substeps is also computed as one substep of twice the length. Their difference, divided by 2^order - 1, estimates the
// error of the pair, whose result is kept. Substeps start at multiples of their length, so the grid does not depend on
// rounding or restarts.
#pragma once
#include <vector>

#include "dynamics/integrator.h"
#include "dynamics/ledger.h"

namespace aspic {

class AdaptiveStep {
 public:
  // `tolerance`: maximum error per step of length h, |dq| + (length of the substep) |dv| of a vertex relative to the
  // diagonal of its body at rest. Substeps get a proportional share. `remembers`: keeps the start of the previous
  // substep.
  AdaptiveStep(const Model& model, double tolerance, bool remembers);

  // Computes the step, adds it to the ledger and counts its substeps in the report. If the smallest substep failed or
  // was inaccurate, the status is not a success and `end` is invalid.
  StepSolve advance(Integrator& integrator, const StepTools& whole, Ledger& ledger, State& end, StepReport& report);

  // The next substep has the length h / 2^level. A restart needs this value.
  int level() const { return level_; }
  void set_level(double level);                        // throws InvalidInput for an invalid level
  const State& previous() const { return previous_; }  // start of the last substep

 private:
  struct Substep {
    State end;
    StepForces forces;
    StepSolve solve;
  };
  enum class Verdict { accepted, rejected, interrupted };

  struct Pair {  // two substeps, in ticks from the start of the step
    int first, size;
  };

  Verdict attempt(Integrator& integrator, const StepTools& whole, Pair pair);
  bool solve_substep(Integrator& integrator, const StepTools& tools, Substep& substep);
  void keep(Integrator& integrator, const StepTools& whole, Pair pair, Ledger& ledger, StepReport& report);
  double error(const Pins& pins, double h) const;  // error of the pair relative to the tolerance

  const Model& model_;
  double tolerance_;
  bool remembers_;
  std::vector<double> size_;  // size of each body [m]
  int level_ = 0;

  State now_, previous_;
  bool has_previous_ = false;
  Substep whole_, first_, second_;
  bool has_whole_ = false;  // the first half of a rejected pair is `whole_` of the next attempt
  double error_ = 0;
  Status failure_ = Status::converged;  // status of the last attempt
  StepSolve total_;
};

}  // namespace aspic

// A step of length h in parts of h / 2^k, as long as an error estimate allows: a part is taken once whole and once in
// halves, whose difference, divided by 2^order - 1, estimates the error of the halves, which are kept. Parts begin at
// multiples of their length, so the grid does not depend on rounding and a restart meets the same one.
#pragma once
#include <vector>

#include "dynamics/integrator.h"
#include "dynamics/ledger.h"

namespace aspic {

class AdaptiveStep {
 public:
  // `tolerance`: the error that a step of length h may add, |dq| + (length of the part) |dv| of a vertex relative to
  // the diagonal of its body at rest; a part may add its share.
  AdaptiveStep(const Model& model, double tolerance, bool remembers /* where the part before started */);

  // Takes the step, adds it to the ledger and counts its parts in the report. A status that is no success says that
  // the smallest part failed, or was inaccurate: there is nothing to go on from.
  StepSolve advance(Integrator& integrator, const StepTools& whole, Ledger& ledger, State& end, StepReport& report);

  // The length that the next part is tried with, h / 2^level: what a restart needs.
  int level() const { return level_; }
  void set_level(double level);  // as a checkpoint holds it; throws InvalidInput for one that there is not
  const State& previous() const { return previous_; }  // where the last part started

 private:
  struct Part {  // a piece of the step that was taken
    State end;
    StepForces forces;
    StepSolve solve;
  };
  enum class Verdict { accepted, rejected, interrupted };

  Verdict attempt(Integrator& integrator, const StepTools& whole, int first, int size);
  bool take(Integrator& integrator, const StepTools& tools, Part& part);
  void keep(Integrator& integrator, const StepTools& whole, Ledger& ledger, int first, int size, StepReport& report);
  double error(const Pins& pins, double h) const;  // of the halves, as a multiple of the tolerance

  const Model& model_;
  double tolerance_;
  bool remembers_;
  std::vector<double> size_;  // of each body [m]
  int level_ = 0;

  State now_, previous_;
  bool has_previous_ = false;
  Part whole_, first_, second_;
  bool knows_whole_ = false;  // the first half of a rejected part is the whole of the next
  double error_ = 0;
  Status failure_ = Status::converged;  // of the last attempt
  StepSolve total_;
};

}  // namespace aspic

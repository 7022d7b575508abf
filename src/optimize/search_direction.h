// Search directions: the open slot "d = ?" of the minimization loop.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/stop_token.h"
#include "optimize/objective.h"
#include "optimize/work.h"

namespace aspic {

struct DirectionReport : Work {
  int projected_elements = 0;    // with modified Hessians
  bool projected = false;        // a modified Hessian replaced the exact one
  bool kept = false;             // the Hessian of an earlier iteration was reused
  bool truncated = false;        // the linear solve ended at a direction of negative curvature
  bool stopped = false;          // the stop token ended it early
  double stoppable_seconds = 0;  // time of the part that a stop token can end, by the clock of its deadline
  double hessian_seconds = 0, factorize_seconds = 0, solve_seconds = 0;  // wall time
};

// The accuracy of inner linear solves: the relative residual lies between `enough`, which suffices for the end of the
// minimization, and `loosest` [Kelley 1995, eq. 6.20].
struct InnerAccuracy {
  double loosest = 0.1;
  double enough = 0;
  std::optional<double> value = {};  // E(x), if known
};

// Where a direction is computed. x and the gradient g hold 3 numbers per block row.
struct Iterate {
  Objective& E;
  std::span<const double> x, g;
  InnerAccuracy accuracy = {};
  StopToken stop = {};  // iterative solves end there and return their iterate as d
};

class SearchDirection {
 public:
  virtual ~SearchDirection() = default;
  virtual std::string_view name() const = 0;
  virtual std::string description() const {
    return std::string(name());
  }  // with its choices and their reasons, for logs

  // Starts a minimization: drops everything kept from the last one.
  virtual void begin() {}
  // Writes the direction, 3 numbers per block row, to d. Returns false if no descent direction was found.
  virtual bool compute(const Iterate& at, std::span<double> d, DirectionReport& report) = 0;
  // Called if there was no direction, or no step along it decreases E. Returns true if a more cautious direction
  // exists: compute() is then called again.
  virtual bool retreat() { return false; }

  // Returns whether x + d estimates the minimizer, so that |d| estimates the distance to it.
  virtual bool estimates_minimiser() const { return false; }
};

}  // namespace aspic

// Search directions for the minimization loop.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/stop_token.h"
#include "optimize/objective.h"
#include "optimize/work.h"

namespace aspic {

// Work and properties of one direction.
struct DirectionReport : Work {
  int projected_elements = 0;    // number of elements with modified Hessians
  bool projected = false;        // a modified Hessian replaced the exact one
  bool kept = false;             // the Hessian of an earlier iteration was reused
  bool truncated = false;        // the linear solve ended at a direction of negative curvature
  bool stopped = false;          // the stop token ended it early
  double stoppable_seconds = 0;  // duration of the phases that poll the stop token, by the clock of its deadline
  double hessian_seconds = 0, factorize_seconds = 0, solve_seconds = 0;  // wall time
};

// Bounds of the relative residual of inner linear solves [Kelley 1995, eq. 6.20].
struct InnerAccuracy {
  double loosest = 0.1;              // upper bound
  double enough = 0;                 // sufficient for the last iteration
  std::optional<double> value = {};  // E(x), if known
};

// Input of a direction. x and the gradient g have 3 entries per block row.
struct Iterate {
  Objective& E;
  std::span<const double> x, g;
  InnerAccuracy accuracy = {};
  StopToken stop = {};  // iterative solves end there and return their iterate as d
};

class SearchDirection {
 public:
  virtual ~SearchDirection() = default;
  virtual std::string_view name() const = 0;  // as in minimizer_names()
  // Returns the method and its choices with reasons, for logs.
  virtual std::string description() const { return std::string(name()); }

  // Starts a minimization. Discards all data of the last one.
  virtual void begin() {}
  // Called when E has changed a little between two directions. Discards data that depend on the difference.
  virtual void note_change() { begin(); }
  // Writes the direction d, 3 entries per block row. Returns false if no descent direction was found.
  virtual bool compute(const Iterate& at, std::span<double> d, DirectionReport& report) = 0;
  // Called if compute() failed or no step along d decreases E. Returns whether a more cautious direction exists;
  // compute() is then called again.
  virtual bool fall_back() { return false; }

  // Returns whether x + d estimates the minimizer, so that |d| estimates the distance to it.
  virtual bool estimates_minimizer() const { return false; }
};

}  // namespace aspic

// Where to go next: the open slot "d = ?" of the minimisation loop.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/deadline.h"
#include "optimize/objective.h"
#include "optimize/work.h"

namespace aspic {

struct DirectionReport : Work {
  int projected_elements = 0;    // whose Hessians were made definite
  bool projected = false;        // a projected Hessian was used where the exact one was wanted
  bool kept = false;             // the Hessian of an iteration before served once more
  bool truncated = false;        // the linear solve ended at a direction of negative curvature
  bool stopped = false;          // the deadline passed
  double stoppable_seconds = 0;  // by the deadline's clock, of what could have been stopped
  double hessian_seconds = 0, factorize_seconds = 0, solve_seconds = 0;  // wall time
};

// What the minimiser asks and knows. Relative residuals between which an inner solve may choose: as loose as the method
// bears, and no tighter than is enough for the end of the minimisation [Kelley 1995, eq. 6.20].
struct InnerAccuracy {
  double loosest = 0.1;
  double enough = 0;
  Deadline deadline = {};            // of the computation: a solve that can be stopped by then is, and d is what it has
  std::optional<double> value = {};  // E(x), where steps are judged by E
};

class SearchDirection {
 public:
  virtual ~SearchDirection() = default;
  virtual std::string_view name() const = 0;
  virtual std::string description() const { return std::string(name()); }  // with what it decided, and why

  // A minimisation begins: forget the last one.
  virtual void begin() {}
  // Writes d; false when no descent direction could be found. Inner solves need be no more exact than
  // `accuracy` says.
  virtual bool compute(Objective& E, std::span<const double> x, std::span<const double> g,
                       const InnerAccuracy& accuracy, std::span<double> d, DirectionReport& report) = 0;
  // The last direction was of no use: none was found, or no step along it decreases E. True: compute again, there is a
  // more cautious way.
  virtual bool retreat() { return false; }

  // Whether x + d estimates the minimiser, so that the size of d tells how far it is.
  virtual bool estimates_minimiser() const { return false; }
};

}  // namespace aspic

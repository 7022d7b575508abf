// Samples E around an iterate for plots: along the search direction, and in a plane that contains it.
#pragma once
#include <vector>

#include "optimize/minimize.h"

namespace aspic {

struct CurvePoint {
  double alpha = 0;
  double value = 0;           // E(x + alpha d); +inf where undefined or beyond the largest step
  double model = 0;           // E + alpha g.d + alpha^2/2 d'Hd with the exact Hessian H
  double textbook_bound = 0;  // E + c alpha g.d: bound of the sufficient decrease
  double slide_bound = 0;     // E + c g.d
};

// Samples E along d from slightly behind x to slightly beyond the longest trial, with additional samples around an
// accepted step that is much shorter. alpha ascends. `c`: sufficient decrease; samples >= 2. Polls `stop` before every
// sample and returns an empty vector if it stops.
std::vector<CurvePoint> curve_along(const LiveIteration& iteration, double c, int samples = 101,
                                    const StopToken& stop = {});

// A point x + s d + t v in the plane of d and v. v is orthogonal to d, of the same length, and the component of -g, or
// of H g if d is parallel to g.
struct SlicePoint {
  double s = 0, t = 0;
  double value = 0;         // E; +inf where undefined or blocked
  double model = 0;         // quadratic model of E at x
  bool is_blocked = false;  // the straight path from x is infeasible
};

// Returns the largest alpha up to `last` for which the path from x to x + alpha d is feasible; infinity: all of them.
double largest_step(const LiveIteration& iteration, double last);

struct Slice {
  int columns = 0, rows = 0;      // samples along s and along t
  std::vector<SlicePoint> point;  // columns x rows, s fastest
  std::vector<double> across;     // v
};

// Samples s in [-0.5, 1.5] and t in [-1, 1]. Polls `stop` before every sample and returns no points if it stops.
Slice slice_through(const LiveIteration& iteration, int samples = 41, const StopToken& stop = {});

}  // namespace aspic

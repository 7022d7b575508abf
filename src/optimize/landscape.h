// E around an iterate, to be looked at: along the direction of a step, and over a plane through it.
#pragma once
#include <functional>
#include <vector>

#include "optimize/minimize.h"

namespace aspic {

struct CurvePoint {
  double alpha = 0;
  double value = 0;           // E(x + alpha d); +inf where undefined
  double model = 0;           // E + alpha g.d + alpha^2/2 d'Hd with the exact Hessian H
  double textbook_bound = 0;  // E + c alpha g.d: the sufficient decrease
  double slide_bound = 0;     // E + c g.d
};

// E along d, from a little behind x to a little beyond the longest trial, closer around an accepted step that is much
// shorter; alpha ascends. `c` is the sufficient decrease. At least two samples. Empty when `stop`, polled before every
// sample, stops.
std::vector<CurvePoint> curve_along(const LiveIteration& iteration, double c, int samples = 101,
                                    const StopToken& stop = {});

// The plane x + s d + t v: v has the length of d and lies across it, in the direction of -g; where d is along g, in
// that of H g.
struct SlicePoint {
  double s = 0, t = 0;
  double value = 0;  // E; +inf where undefined
  double model = 0;  // its quadratic model at x
};

struct Slice {
  int columns = 0, rows = 0;      // samples along s and along t
  std::vector<SlicePoint> point;  // columns x rows, s fastest
  std::vector<double> across;     // v
};

// s in [-0.5, 1.5], t in [-1, 1]. Without points when `stop`, polled before every sample, stops.
Slice slice_through(const LiveIteration& iteration, int samples = 41, const StopToken& stop = {});

}  // namespace aspic

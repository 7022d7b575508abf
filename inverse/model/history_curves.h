// Readings of histories beside the fit, as curves over time for tables and pictures.
#pragma once
#include <string>
#include <vector>

#include "model/load_history.h"

namespace aspic {

struct HistoryPoint {
  double time = 0;                             // [s]
  double measured = 0, sigma = 0, fitted = 0;  // in the unit of the curve
};

// A component of the force, or the motion of a marker along its largest measured displacement.
struct HistoryCurve {
  std::string history;  // its name
  std::string reading;  // "force", "force x", "motion"
  std::string unit;     // "N", "m"
  int marker = -1;      // < 0: none
  std::vector<HistoryPoint> points;
};

inline constexpr size_t kMarkersWithCurve = 3;  // per history: those with the largest motions

// The curves of the forces, then those of markers. `prediction`: of the same history.
std::vector<HistoryCurve> curves_of(const Experiment& body, const LoadHistory& history,
                                    const HistoryPrediction& prediction);

}  // namespace aspic

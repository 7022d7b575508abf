// Functions of time from values at ascending times.
#pragma once
#include <algorithm>
#include <vector>

namespace aspic {

// Linear between the times, constant before and after. There is at least one time.
template <class T>
struct PiecewiseLinear {
  std::vector<double> times;
  std::vector<T> values;  // one per time

  T at(double time) const {
    const size_t next = std::upper_bound(times.begin(), times.end(), time) - times.begin();
    if (next == 0) return values.front();
    if (next == times.size()) return values.back();
    const double s = (time - times[next - 1]) / (times[next] - times[next - 1]);
    return (1 - s) * values[next - 1] + s * values[next];
  }
};

}  // namespace aspic

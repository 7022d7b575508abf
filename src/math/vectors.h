// Vectors of any length as spans of doubles. Sums are bit-reproducible for any number of threads.
#pragma once
#include <span>
#include <vector>

#include "math/small.h"

namespace aspic {

// Returns the i-th of consecutive vectors of 3 entries.
inline Vec3d vec_at(std::span<const double> x, int i) {
  const size_t k = 3 * static_cast<size_t>(i);
  return {{x[k], x[k + 1], x[k + 2]}};
}
inline void set_vec(const Vec3d& value, int i, std::span<double> x) {
  for (int r = 0; r < 3; ++r) x[3 * static_cast<size_t>(i) + r] = value[r];
}
inline void add_vec(const Vec3d& value, int i, std::span<double> x) {
  for (int r = 0; r < 3; ++r) x[3 * static_cast<size_t>(i) + r] += value[r];
}

double dot(std::span<const double> x, std::span<const double> y);  // requires equal sizes
double squared_norm(std::span<const double> x);
double norm(std::span<const double> x);     // Euclidean
double max_abs(std::span<const double> x);  // largest absolute value; NaN if an entry is NaN, 0 if empty
void add_scaled(double s, std::span<const double> x, std::span<double> y);  // y += s x; requires equal sizes
double median(std::vector<double> values);  // mean of the middle two if the count is even; 0 if empty

}  // namespace aspic

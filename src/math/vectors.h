// Vectors of any length as spans of doubles. Sums are bit-reproducible for any number of threads.
#pragma once
#include <span>
#include <vector>

namespace aspic {

double dot(std::span<const double> x, std::span<const double> y);  // requires equal sizes
double squared_norm(std::span<const double> x);
double norm(std::span<const double> x);     // Euclidean
double max_abs(std::span<const double> x);  // largest absolute value; NaN if an entry is NaN, 0 without entries
void add_scaled(double s, std::span<const double> x, std::span<double> y);  // y += s x; requires equal sizes
double median(std::vector<double> values);  // mean of the middle two if the count is even; 0 without values

}  // namespace aspic

// Storage of dense matrices, lower triangles and trapezoids.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace aspic {

// Column-major, read-only. Entry (i, j) is data[i + j * stride].
struct ConstMatrix {
  const double* data;
  std::ptrdiff_t stride;
  int rows, columns;

  ConstMatrix columns_from(int first, int count) const { return {data + first * stride, stride, rows, count}; }
};

// Column-major. Either all columns have `rows` entries, or strips of kStrip columns begin at their own diagonal, which
// needs little more than half the memory of a square.
struct LowerMatrix {
  static constexpr int kStrip = 96;

  double* data;
  std::ptrdiff_t rows;
  bool in_strips = false;

  std::ptrdiff_t stride(int column) const { return in_strips ? rows - column / kStrip * kStrip : rows; }
  double* column(int j) const {  // entry (i, j) is column(j)[i]
    if (!in_strips) return data + j * rows;
    const std::ptrdiff_t strip = j / kStrip, first = strip * kStrip;
    return data + first * rows - kStrip * kStrip * (strip * (strip - 1) / 2) + (j - first) * (rows - first) - first;
  }
  static std::int64_t size_in_strips(std::int64_t rows) {
    std::int64_t size = 0;
    for (std::int64_t j = 0; j < rows; j += kStrip) size += std::min<std::int64_t>(kStrip, rows - j) * (rows - j);
    return size;
  }
};

}  // namespace aspic

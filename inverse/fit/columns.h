// Tall matrices: a few hundred columns with many rows.
#pragma once
#include <span>
#include <vector>

#include "math/vectors.h"

namespace aspic {

class Columns {
 public:
  Columns() = default;
  explicit Columns(int rows, int count = 0) : rows_(rows), values_(static_cast<size_t>(rows) * count) {}

  int rows() const { return rows_; }
  int count() const { return rows_ > 0 ? static_cast<int>(values_.size() / rows_) : 0; }
  std::span<double> operator[](int j) { return {values_.data() + static_cast<size_t>(rows_) * j, size_t(rows_)}; }
  std::span<const double> operator[](int j) const {
    return {values_.data() + static_cast<size_t>(rows_) * j, size_t(rows_)};
  }
  void push_back(std::span<const double> column) { values_.insert(values_.end(), column.begin(), column.end()); }

 private:
  int rows_ = 0;
  std::vector<double> values_;  // column-major
};

std::vector<double> product_transposed(const Columns& A, std::span<const double> v);               // A' v
std::vector<double> product_transposed(const Columns& A, const Columns& B);                        // A' B, column-major
void add_product(const Columns& A, std::span<const double> c, double scale, std::span<double> y);  // y += scale A c
// A C, where C has A.count() rows and `count` columns, column-major.
Columns product(const Columns& A, std::span<const double> C, int count);

}  // namespace aspic

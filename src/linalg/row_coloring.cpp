#include "linalg/row_coloring.h"

namespace aspic {

std::vector<std::vector<int>> color_rows(const BlockPattern& pattern) {
  std::vector<std::vector<int>> rows_of_color;
  std::vector<int> color_of_row(pattern.rows(), -1), taken_by;  // per colour, the last row that may not have it
  for (int row = 0; row < pattern.rows(); ++row) {
    const auto take = [&](int neighbour) {
      if (color_of_row[neighbour] >= 0) taken_by[color_of_row[neighbour]] = row;
    };
    for (int64_t s = pattern.row_start[row]; s < pattern.diagonal(row); ++s) take(pattern.column[s]);
    size_t color = 0;
    while (color < taken_by.size() && taken_by[color] == row) ++color;
    if (color == taken_by.size()) {
      rows_of_color.emplace_back();
      taken_by.push_back(-1);
    }
    color_of_row[row] = static_cast<int>(color);
    rows_of_color[color].push_back(row);
  }
  return rows_of_color;
}

}  // namespace aspic

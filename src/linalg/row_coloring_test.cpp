#include "linalg/row_coloring.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "linalg/matrices_test.h"

namespace aspic {
namespace {

TEST(RowColoring, ColorsOfNeighborsDiffer) {
  Couplings couplings;  // a grid of 7 x 5 rows with diagonals one way
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 5; ++j) {
      if (i > 0) couplings.emplace_back(5 * i + j, 5 * (i - 1) + j);
      if (j > 0) couplings.emplace_back(5 * i + j, 5 * i + j - 1);
      if (i > 0 && j > 0) couplings.emplace_back(5 * i + j, 5 * (i - 1) + j - 1);
    }
  const BlockPattern pattern = make_pattern(35, couplings);
  const auto colors = color_rows(pattern);
  EXPECT_GE(colors.size(), 3u);  // there are triangles
  EXPECT_LE(colors.size(), 4u);  // a row has at most three neighbors before it
  std::vector<int> color_of_row(35, -1);
  for (size_t color = 0; color < colors.size(); ++color) {
    EXPECT_TRUE(std::is_sorted(colors[color].begin(), colors[color].end()));
    for (const int row : colors[color]) {
      EXPECT_EQ(color_of_row[row], -1);
      color_of_row[row] = static_cast<int>(color);
    }
  }
  EXPECT_EQ(std::count(color_of_row.begin(), color_of_row.end(), -1), 0);
  for (const auto& [i, j] : couplings) EXPECT_NE(color_of_row[i], color_of_row[j]);
}

TEST(RowColoring, RowsWithoutNeighborsShareOneColor) { EXPECT_EQ(color_rows(make_pattern(4, {})).size(), 1u); }

}  // namespace
}  // namespace aspic

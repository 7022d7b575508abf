// Colors of the rows of a symmetric matrix: rows of one color have no block in common, so that unknowns of one color
// may change at the same time. Colors are worked through in order, so results do not depend on the threads.
#pragma once
#include <vector>

#include "linalg/block_sparse.h"

namespace aspic {

// Greedy: each row, in order, takes the first color that none of its neighbors has. Rows of a color ascend.
std::vector<std::vector<int>> color_rows(const BlockPattern& pattern);

}  // namespace aspic

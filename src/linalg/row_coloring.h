// Colours of the rows of a symmetric matrix: rows of one colour have no block in common, so that unknowns of one colour
// may change at the same time. Colours are worked through in order, so results do not depend on the threads.
#pragma once
#include <vector>

#include "linalg/block_sparse.h"

namespace aspic {

// Greedy: each row, in order, takes the first colour that none of its neighbours has. Rows of a colour ascend.
std::vector<std::vector<int>> color_rows(const BlockPattern& pattern);

}  // namespace aspic

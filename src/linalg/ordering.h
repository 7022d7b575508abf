// Fill-reducing elimination orders.
#pragma once
#include <vector>

#include "linalg/block_sparse.h"

namespace aspic {

// Returns the order of elimination: order[k] is the k-th row. Uses nested dissection (METIS) on the graph of the
// blocks, or approximate minimum degree if the graph is tiny or METIS fails.
std::vector<int> fill_reducing_order(const BlockPattern& pattern);
std::vector<int> minimum_degree_order(const BlockPattern& pattern);

}  // namespace aspic

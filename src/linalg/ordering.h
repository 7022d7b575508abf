// An elimination order with little fill.
#pragma once
#include <vector>

#include "linalg/block_sparse.h"

namespace aspic {

// order[k] is the row to eliminate k-th. Nested dissection (METIS) on the graph of the blocks; approximate minimum
// degree where the graph is tiny or METIS fails.
std::vector<int> fill_reducing_order(const BlockPattern& pattern);
std::vector<int> minimum_degree_order(const BlockPattern& pattern);

}  // namespace aspic

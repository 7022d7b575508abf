// Fill-reducing elimination orders.
#pragma once
#include <vector>

#include "linalg/block_sparse.h"

namespace aspic {

// Returns the order of elimination: order[k] is the k-th row. Uses nested dissection on the graph of the blocks, or
// approximate minimum degree if the graph is tiny or the dissection fails. The dissection is that of METIS; in builds
// without METIS it is geometric_order(), for patterns with rest positions and where it has less fill.
std::vector<int> fill_reducing_order(const BlockPattern& pattern);
std::vector<int> minimum_degree_order(const BlockPattern& pattern);
std::vector<int> geometric_order(const BlockPattern& pattern);  // requires rest positions

}  // namespace aspic

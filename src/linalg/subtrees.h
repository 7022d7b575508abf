// Schedule of a multifrontal factorization: subtrees of the elimination tree, each on one thread, then the tree above
// them with shared dense work. It depends on the tree alone, so the factor is bit-reproducible for any number of
// threads.
#pragma once
#include <cstdint>
#include <vector>

#include "linalg/elimination.h"

namespace aspic {

struct Subtrees {
  struct Task {  // the supernodes [first, last): whole subtrees
    int first, last;
    double flops;
    int rows, columns;  // rows of the largest front, columns of the widest panel
  };
  std::vector<Task> tasks;            // in descending order of flops
  std::vector<int> top;               // all other supernodes, children before parents
  int top_rows = 0, top_columns = 0;  // rows of the largest front of `top`, columns of its widest panel
  std::vector<int64_t> panel_start;   // offset of each supernode's panel; tasks are kReadAhead apart
  int64_t panels = 0;                 // [doubles]
  std::vector<int64_t> update_start;  // offset of each supernode's update matrix in the workspace
  int64_t workspace = 0;              // [doubles]
};

Subtrees make_subtrees(const Supernodes& supernodes);

}  // namespace aspic

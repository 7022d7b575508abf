// Which part of a multifrontal factorization runs where: subtrees of the elimination tree, each on one thread, then the
// tree above them, whose dense work is shared. It depends on the tree alone, so the bits of the factor do too.
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
  std::vector<Task> tasks;            // the longest first
  std::vector<int> top;               // all other supernodes, children before parents
  int top_rows = 0, top_columns = 0;  // rows of its largest front, columns of its widest panel
  std::vector<int64_t> panel_start;   // offset of each supernode's panel; tasks are kReadAhead apart
  int64_t panels = 0;                 // [doubles]
  std::vector<int64_t> update_start;  // where each supernode's update matrix lies in the workspace
  int64_t workspace = 0;              // [doubles]
};

Subtrees make_subtrees(const Supernodes& supernodes);

}  // namespace aspic

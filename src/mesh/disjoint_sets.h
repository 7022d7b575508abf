// Disjoint sets of integers (union-find), each represented by its smallest element.
#pragma once
#include <numeric>
#include <utility>
#include <vector>

namespace aspic {

class DisjointSets {
 public:
  explicit DisjointSets(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  int find(int i) {  // returns the smallest element of the set of i
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) {
    a = find(a), b = find(b);
    if (a > b) std::swap(a, b);
    parent_[b] = a;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace aspic

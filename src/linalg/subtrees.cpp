#include "linalg/subtrees.h"

#include <algorithm>
#include <array>

namespace aspic {
namespace {

constexpr double kShares = 16;          // no subtree has more than this part of the work
constexpr double kSmallestShare = 1e6;  // flops; some 20 us of one core

std::vector<double> subtree_flops(const Supernodes& s) {
  std::vector<double> flops(s.count(), 0.0);
  for (int k = 0; k < s.count(); ++k) {
    flops[k] += factor_flops(3 * s.width(k), 3 * s.below(k));
    if (s.parent[k] >= 0) flops[s.parent[k]] += flops[k];
  }
  return flops;
}

// Update matrices wait for their parents on two stacks, by the parity of their depth in the tree: a supernode's matrix
// grows on one while those of its children are on top of the other. So none is ever moved.
class Layout {
 public:
  explicit Layout(const Supernodes& s) : s_(s), depth_(s.count(), 0), children_(s.count(), 0) {
    for (int k = s.count() - 1; k >= 0; --k)
      if (s.parent[k] >= 0) depth_[k] = depth_[s.parent[k]] + 1;
  }

  // Gives the matrices of these supernodes, which ascend, places in a region of their own.
  void add_region(const std::vector<int>& supernodes, Subtrees& result) {
    std::array<int64_t, 2> end{}, peak{};
    for (const int k : supernodes) {
      const int stack = depth_[k] % 2;
      result.update_start[k] = end[stack];
      end[stack] += size(k);
      peak[stack] = std::max(peak[stack], end[stack]);
      end[1 - stack] -= children_[k];
      // A matrix that waits for a parent in another region stays.
      if (const int p = s_.parent[k]; p >= 0 && std::binary_search(supernodes.begin(), supernodes.end(), p))
        children_[p] += size(k);
    }
    for (const int k : supernodes) result.update_start[k] += result.workspace + (depth_[k] % 2 ? peak[0] : 0);
    result.workspace += peak[0] + peak[1];
  }

 private:
  int64_t size(int k) const { return 9 * static_cast<int64_t>(s_.below(k)) * s_.below(k); }

  const Supernodes& s_;
  std::vector<int> depth_;
  std::vector<int64_t> children_;  // doubles of the children's matrices in the same region
};

// Neighbouring subtrees share a task while they are small.
std::vector<Subtrees::Task> cut_tasks(const Supernodes& s, const std::vector<double>& flops, double limit) {
  std::vector<Subtrees::Task> tasks;
  int begin = 0;
  bool extend = false;  // the last task, which ends where this subtree begins
  for (int k = 0; k < s.count(); ++k) {
    if (flops[k] > limit) {
      extend = false;
      begin = k + 1;
      continue;
    }
    if (s.parent[k] >= 0 && flops[s.parent[k]] <= limit) continue;  // not the root of a subtree
    if (extend && tasks.back().flops + flops[k] <= limit) {
      tasks.back().last = k + 1;
      tasks.back().flops += flops[k];
    } else {
      tasks.push_back({begin, k + 1, flops[k], 0, 0});
    }
    extend = true;
    begin = k + 1;
  }
  return tasks;
}

}  // namespace

Subtrees make_subtrees(const Supernodes& s) {
  const std::vector<double> flops = subtree_flops(s);
  const double limit = std::max(s.cost.flops / kShares, kSmallestShare);
  Subtrees result;
  result.tasks = cut_tasks(s, flops, limit);
  result.update_start.assign(s.count(), 0);
  Layout layout(s);
  std::vector<int> members;
  for (Subtrees::Task& task : result.tasks) {
    members.clear();
    for (int k = task.first; k < task.last; ++k) {
      members.push_back(k);
      task.rows = std::max(task.rows, 3 * (s.width(k) + s.below(k)));
      task.columns = std::max(task.columns, 3 * s.width(k));
    }
    layout.add_region(members, result);
  }
  for (int k = 0; k < s.count(); ++k) {
    if (flops[k] <= limit) continue;
    result.top.push_back(k);
    result.top_rows = std::max(result.top_rows, 3 * (s.width(k) + s.below(k)));
    result.top_columns = std::max(result.top_columns, 3 * s.width(k));
  }
  layout.add_region(result.top, result);
  std::stable_sort(result.tasks.begin(), result.tasks.end(),
                   [](const auto& a, const auto& b) { return a.flops > b.flops; });
  return result;
}

}  // namespace aspic

#include "linalg/subtrees.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "linalg/dense_cholesky.h"

namespace aspic {
namespace {

constexpr double kShares = 16;          // no subtree has more than 1 / kShares of the work
constexpr double kSmallestShare = 1e6;  // flops; about 20 us on one core

std::vector<double> subtree_flops(const Supernodes& s) {
  std::vector<double> flops(s.count(), 0.0);
  for (int k = 0; k < s.count(); ++k) {
    flops[k] += factor_flops(3 * s.width(k), 3 * s.below(k));
    if (s.parent[k] >= 0) flops[s.parent[k]] += flops[k];
  }
  return flops;
}

// Update matrices are stored until their parents need them, on two stacks selected by the parity of their depth in the
// tree: a supernode's matrix grows on one stack while those of its children are on top of the other, so no matrix is
// moved. Each task has its own two stacks. Its results for the top are stored separately, and the stacks of the top
// reuse the memory of the tasks.
class Layout {
 public:
  Layout(const Supernodes& s, const std::vector<bool>& in_top)
      : s_(s), in_top_(in_top), depth_(s.count(), 0), children_(s.count(), 0), start_(s.count(), 0) {
    for (int k = s.count() - 1; k >= 0; --k)
      if (s.parent[k] >= 0) depth_[k] = depth_[s.parent[k]] + 1;
    for (int k = 0; k < s.count(); ++k)
      if (is_kept(k)) start_[k] = kept_, kept_ += size(k);
    end_ = kept_;
  }

  void add_task(const Subtrees::Task& task) {
    std::vector<int> members(task.last - task.first);
    std::iota(members.begin(), members.end(), task.first);
    end_ += assign_offsets(members, end_);
  }
  void add_top(const std::vector<int>& top) { end_ = std::max(end_, kept_ + assign_offsets(top, kept_)); }

  int64_t workspace() const { return end_; }
  std::vector<int64_t>& start() { return start_; }

 private:
  bool is_kept(int k) const { return !in_top_[k] && s_.parent[k] >= 0 && in_top_[s_.parent[k]]; }
  int64_t size(int k) const { return LowerMatrix::size_in_strips(3 * static_cast<int64_t>(s_.below(k))); }

  // Assigns offsets from `begin` to the matrices of ascending supernodes. Returns the size of the memory they occupy.
  int64_t assign_offsets(const std::vector<int>& supernodes, int64_t begin) {
    std::array<int64_t, 2> end{}, peak{};
    for (const int k : supernodes) {
      const int stack = depth_[k] % 2;
      end[1 - stack] -= children_[k];
      if (is_kept(k)) continue;
      start_[k] = end[stack];
      end[stack] += size(k);
      peak[stack] = std::max(peak[stack], end[stack]);
      if (s_.parent[k] >= 0) children_[s_.parent[k]] += size(k);
    }
    for (const int k : supernodes)
      if (!is_kept(k)) start_[k] += begin + (depth_[k] % 2 ? peak[0] : 0);
    return peak[0] + peak[1];
  }

  const Supernodes& s_;
  const std::vector<bool>& in_top_;
  std::vector<int> depth_;
  std::vector<int64_t> children_;  // size of the children's matrices on a stack [doubles]
  std::vector<int64_t> start_;
  int64_t kept_ = 0, end_ = 0;
};

// Returns the tasks. Adjacent small subtrees share one.
std::vector<Subtrees::Task> cut_tasks(const Supernodes& s, const std::vector<double>& flops, double limit) {
  std::vector<Subtrees::Task> tasks;
  int begin = 0;
  bool extend = false;  // whether the last task ends where this subtree begins
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

// Leaves gaps between the panels of different tasks, because the kernels read slightly past a panel while another task
// may write there.
void place_panels(const Supernodes& s, Subtrees& result) {
  result.panel_start.assign(s.value_start.begin(), s.value_start.end() - 1);
  int64_t gaps = 0;
  auto task = result.tasks.begin();
  for (int k = 0; k < s.count(); ++k) {
    result.panel_start[k] += gaps;
    if (task == result.tasks.end() || k + 1 != task->last) continue;
    gaps += kReadAhead;
    ++task;
  }
  result.panels = s.value_start.back() + gaps + kReadAhead;
}

}  // namespace

Subtrees make_subtrees(const Supernodes& s) {
  const std::vector<double> flops = subtree_flops(s);
  const double limit = std::max(s.cost.flops / kShares, kSmallestShare);
  Subtrees result;
  result.tasks = cut_tasks(s, flops, limit);
  std::vector<bool> in_top(s.count());
  for (int k = 0; k < s.count(); ++k) {
    in_top[k] = flops[k] > limit;
    if (!in_top[k]) continue;
    result.top.push_back(k);
    result.top_rows = std::max(result.top_rows, 3 * (s.width(k) + s.below(k)));
    result.top_columns = std::max(result.top_columns, 3 * s.width(k));
  }
  Layout layout(s, in_top);
  for (Subtrees::Task& task : result.tasks) {
    for (int k = task.first; k < task.last; ++k) {
      task.rows = std::max(task.rows, 3 * (s.width(k) + s.below(k)));
      task.columns = std::max(task.columns, 3 * s.width(k));
    }
    layout.add_task(task);
  }
  layout.add_top(result.top);
  place_panels(s, result);
  result.workspace = layout.workspace();
  result.update_start = std::move(layout.start());
  std::stable_sort(result.tasks.begin(), result.tasks.end(),
                   [](const auto& a, const auto& b) { return a.flops > b.flops; });
  return result;
}

}  // namespace aspic

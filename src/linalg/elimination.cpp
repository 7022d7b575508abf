#include "linalg/elimination.h"

#include <algorithm>
#include <numeric>

#include "base/check.h"

namespace aspic {
namespace {

// Calls visit(k) for each earlier column k that shares a block with column j, in the order of elimination.
template <class Visit>
void for_each_earlier(const BlockPattern& p, const std::vector<int>& order, const std::vector<int>& position, int j,
                      Visit visit) {
  const int row = order[j];
  for (int64_t s = p.row_start[row]; s < p.diagonal(row); ++s)
    if (const int k = position[p.column[s]]; k < j) visit(k);
  for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1]; ++u)
    if (const int k = position[p.upper_row[u]]; k < j) visit(k);
}

std::vector<int> inverse_of(const std::vector<int>& order) {
  std::vector<int> position(order.size());
  for (size_t k = 0; k < order.size(); ++k) position[order[k]] = static_cast<int>(k);
  return position;
}

// parent[j] is the first row below the diagonal of column j of L [Liu 1990]. Compresses the paths to the ancestors.
std::vector<int> elimination_tree(const BlockPattern& p, const std::vector<int>& order,
                                  const std::vector<int>& position) {
  const int n = static_cast<int>(order.size());
  std::vector<int> parent(n, -1), ancestor(n, -1);
  for (int j = 0; j < n; ++j)
    for_each_earlier(p, order, position, j, [&](int k) {
      while (k != -1 && k < j) {
        const int next = ancestor[k];
        ancestor[k] = j;
        if (next == -1) parent[k] = j;
        k = next;
      }
    });
  return parent;
}

// Orders children before parents and each subtree contiguously.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> child(n, -1), sibling(n, -1), result, stack;
  for (int j = n - 1; j >= 0; --j)
    if (parent[j] >= 0) sibling[j] = child[parent[j]], child[parent[j]] = j;
  result.reserve(n);
  for (int root = 0; root < n; ++root) {
    if (parent[root] >= 0) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int j = stack.back(), c = child[j];
      if (c < 0) {
        result.push_back(j);
        stack.pop_back();
      } else {
        child[j] = sibling[c];
        stack.push_back(c);
      }
    }
  }
  return result;
}

// Counts the entries of each column of L, diagonal included. Row j of L is the part of the tree between its earlier
// neighbors and j.
std::vector<int> column_counts(const BlockPattern& p, const std::vector<int>& order, const std::vector<int>& position,
                               const std::vector<int>& parent) {
  const int n = static_cast<int>(order.size());
  std::vector<int> count(n, 1), seen(n, -1);
  for (int j = 0; j < n; ++j) {
    seen[j] = j;
    for_each_earlier(p, order, position, j, [&](int k) {
      for (; seen[k] != j; k = parent[k]) ++count[k], seen[k] = j;
    });
  }
  return count;
}

// Number of entries of a trapezoid of `width` columns with `below` rows under its triangle.
double trapezoid(double width, double below) { return width * (width + 1) / 2 + width * below; }

// Returns whether merging adjacent supernodes pays: it stores zeros but makes larger dense blocks. The thresholds are
// those of CHOLMOD's relaxed supernodes, in blocks of 3 [Chen et al. 2008].
bool worth_merging(int width, double zeros, double entries) {
  if (width <= 2) return true;
  const double share = zeros / entries;
  return share < (width <= 6 ? 0.8 : width <= 16 ? 0.1 : 0.05);
}

// Returns the first columns of the supernodes, followed by the number of columns.
std::vector<int> relaxed_supernodes(const std::vector<int>& parent, const std::vector<int>& count) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> children(n, 0);
  for (const int p : parent)
    if (p >= 0) ++children[p];
  std::vector<int> fundamental;
  for (int j = 0; j < n; ++j)
    if (j == 0 || parent[j - 1] != j || count[j - 1] != count[j] + 1 || children[j] != 1) fundamental.push_back(j);
  fundamental.push_back(n);

  struct Merged {
    int first;
    double entries;  // structural nonzeros of L
  };
  const auto entries_of = [&](int first, int last) {
    return std::accumulate(count.begin() + first, count.begin() + last, 0.0);
  };
  std::vector<Merged> merged;
  for (size_t f = 0; f + 1 < fundamental.size(); ++f) {
    Merged top{fundamental[f], entries_of(fundamental[f], fundamental[f + 1])};
    const int last = fundamental[f + 1];
    // The last child's columns directly precede this column. After merging it, merging its own last child may pay, too.
    while (!merged.empty() && parent[top.first - 1] >= top.first && parent[top.first - 1] < last) {
      const Merged& child = merged.back();
      const double stored = trapezoid(last - child.first, count[last - 1] - 1), entries = child.entries + top.entries;
      if (!worth_merging(last - child.first, stored - entries, stored)) break;
      top = {child.first, entries};
      merged.pop_back();
    }
    merged.push_back(top);
  }
  std::vector<int> first;
  first.reserve(merged.size() + 1);
  for (const Merged& m : merged) first.push_back(m.first);
  first.push_back(n);
  return first;
}

// Computes sizes and costs. The rows below a supernode are those below its last column.
void set_sizes(Supernodes& s, const std::vector<int>& parent, const std::vector<int>& count) {
  const int supernodes = s.count(), columns = s.first.back();
  std::vector<int> supernode_of(columns);
  for (int k = 0; k < supernodes; ++k) std::fill(&supernode_of[s.first[k]], &supernode_of[s.first[k]] + s.width(k), k);
  s.parent.assign(supernodes, -1);
  s.row_start.assign(supernodes + 1, 0);
  s.value_start.assign(supernodes + 1, 0);
  for (int k = 0; k < supernodes; ++k) {
    const int last = s.first[k + 1] - 1;
    if (parent[last] >= 0) s.parent[k] = supernode_of[parent[last]];
    s.row_start[k + 1] = s.row_start[k] + count[last] - 1;
    const int64_t width = 3 * s.width(k), below = 3 * (count[last] - 1);
    s.value_start[k + 1] = s.value_start[k] + width * (width + below);
    s.cost.flops += factor_flops(width, below);
  }
  s.cost.nnz = s.value_start.back();
}

// Finds the place of each row in the parent's front. Both lists ascend, and the parent's rows contain the child's.
void relate_to_parent(Supernodes& s, int k) {
  const int parent = s.parent[k];
  if (parent < 0) return;
  const int width = s.width(parent), *rows = s.row.data() + s.row_start[parent];
  int64_t below = 0;
  for (int64_t i = s.row_start[k]; i < s.row_start[k + 1]; ++i) {
    if (s.row[i] < s.first[parent + 1]) {
      s.in_parent[i] = s.row[i] - s.first[parent];
    } else {
      while (rows[below] != s.row[i]) ++below;
      s.in_parent[i] = width + static_cast<int>(below);
    }
  }
  for (int64_t i = s.row_start[k + 1] - 1, end = s.row_start[k + 1]; i >= s.row_start[k]; --i) {
    if (i + 1 < end && s.in_parent[i + 1] != s.in_parent[i] + 1) end = i + 1;
    s.run_end[i] = static_cast<int>(end - s.row_start[k]);
  }
}

}  // namespace

double factor_flops(int64_t columns, int64_t below) {
  double flops = 0;
  for (int64_t c = 0; c < columns; ++c) {
    const double length = static_cast<double>(columns + below - c);
    flops += length * length;
  }
  return flops;
}

Supernodes find_supernodes(const BlockPattern& pattern, std::vector<int> order) {
  ASPIC_CHECK(static_cast<int>(order.size()) == pattern.rows());
  Supernodes s;
  s.order = std::move(order);
  s.position = inverse_of(s.order);
  const std::vector<int> rank = postorder(elimination_tree(pattern, s.order, s.position));
  std::vector<int> reordered(rank.size());
  for (size_t k = 0; k < rank.size(); ++k) reordered[k] = s.order[rank[k]];
  s.order = std::move(reordered);
  s.position = inverse_of(s.order);
  const std::vector<int> parent = elimination_tree(pattern, s.order, s.position);
  const std::vector<int> count = column_counts(pattern, s.order, s.position, parent);
  s.first = s.order.empty() ? std::vector<int>{0} : relaxed_supernodes(parent, count);
  set_sizes(s, parent, count);
  return s;
}

void list_rows(const BlockPattern& pattern, Supernodes& s) {
  s.row.resize(s.row_start.back());
  std::vector<int> seen(s.order.size(), -1), child(s.count(), -1), sibling(s.count(), -1);
  for (int k = 0; k < s.count(); ++k) {
    const int end = s.first[k + 1];
    int* const begin = s.row.data() + s.row_start[k];
    int* out = begin;
    const auto take = [&](int row) {
      if (row >= end && seen[row] != k) seen[row] = k, *out++ = row;
    };
    for (int j = s.first[k]; j < end; ++j) {
      const int r = s.order[j];
      for (int64_t b = pattern.row_start[r]; b < pattern.diagonal(r); ++b) take(s.position[pattern.column[b]]);
      for (int64_t u = pattern.upper_start[r]; u < pattern.upper_start[r + 1]; ++u)
        take(s.position[pattern.upper_row[u]]);
    }
    for (int c = child[k]; c >= 0; c = sibling[c])
      for (int64_t i = s.row_start[c]; i < s.row_start[c + 1]; ++i) take(s.row[i]);
    ASPIC_CHECK(out - begin == s.below(k));
    std::sort(begin, out);
    if (s.parent[k] >= 0) sibling[k] = child[s.parent[k]], child[s.parent[k]] = k;
  }
  s.in_parent.resize(s.row.size());
  s.run_end.resize(s.row.size());
  for (int k = 0; k < s.count(); ++k) relate_to_parent(s, k);
}

}  // namespace aspic

#include "linalg/cholesky_cost.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace aspic {
namespace {

template <class Visit>
void for_each_neighbor(const BlockPattern& p, int row, Visit visit) {
  for (int64_t s = p.row_start[row]; s < p.diagonal(row); ++s) visit(p.column[s]);
  for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1]; ++u) visit(p.upper_row[u]);
}

// Breadth-first search from queue[begin]. Appends the reached rows to the queue and returns the number of levels.
int search(const BlockPattern& p, std::vector<int>& queue, size_t begin, std::vector<int>& mark, int color) {
  mark[queue[begin]] = color;
  int levels = 0;
  for (size_t head = begin, level_end = queue.size(); head < queue.size(); level_end = queue.size(), ++levels)
    for (; head < level_end; ++head)
      for_each_neighbor(p, queue[head], [&](int row) {
        if (mark[row] != color) mark[row] = color, queue.push_back(row);
      });
  return levels;
}

}  // namespace

// Cost of a component of n rows with s rows per breadth-first level: 150 n^2 flops if compact, 390 n s^1.5 if slender,
// and 100 n s^0.5 entries of L. The constants fit exact nested-dissection counts of boxes of 1 000 to 1 000 000
// vertices and a beam within a factor of two.
CostPrediction predict_cholesky(const BlockPattern& pattern) {
  CostPrediction cost;
  std::vector<int> mark(pattern.rows(), 0), queue;
  queue.reserve(pattern.rows());
  for (int start = 0; start < pattern.rows(); ++start) {
    if (mark[start] != 0) continue;
    const size_t begin = queue.size();
    queue.push_back(start);
    search(pattern, queue, begin, mark, 1);
    const int far = queue.back();  // a search from the far end covers the whole length of a slender body
    queue.resize(begin);
    queue.push_back(far);
    const int levels = search(pattern, queue, begin, mark, 2);
    const double n = static_cast<double>(queue.size() - begin), s = n / levels;
    cost.flops += std::min(150 * n * n, 390 * n * std::pow(s, 1.5));
    cost.entries += 100 * n * std::sqrt(s);
  }
  return cost;
}

}  // namespace aspic

#include "linalg/ordering.h"

#ifdef ASPIC_METIS
#include <metis.h>
#endif

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <limits>
#include <mutex>
#include <numeric>

#include "linalg/elimination.h"

namespace aspic {
namespace {

constexpr int kTiny = 200;  // rows; below, minimum degree has as little fill and is faster

bool is_permutation(const std::vector<int>& order) {
  std::vector<char> seen(order.size(), 0);
  for (const int row : order) {
    if (row < 0 || row >= static_cast<int>(order.size()) || seen[row]) return false;
    seen[row] = 1;
  }
  return true;
}

#ifdef ASPIC_METIS
std::vector<int> nested_dissection_order(const BlockPattern& pattern) {
  if (2 * pattern.block_count() >= std::numeric_limits<idx_t>::max()) return {};
  idx_t rows = pattern.rows();
  std::vector<idx_t> start(rows + 1, 0), neighbor;
  neighbor.reserve(2 * (pattern.block_count() - rows));
  for (idx_t row = 0; row < rows; ++row) {
    for (int64_t s = pattern.row_start[row]; s < pattern.diagonal(row); ++s) neighbor.push_back(pattern.column[s]);
    for (int64_t u = pattern.upper_start[row]; u < pattern.upper_start[row + 1]; ++u)
      neighbor.push_back(pattern.upper_row[u]);
    start[row + 1] = static_cast<idx_t>(neighbor.size());
  }
  std::vector<idx_t> order(rows), position(rows);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = 1;  // the same order in every run
  static std::mutex metis;         // METIS uses rand(), whose state all threads share
  const std::lock_guard lock(metis);
  const int status =
      METIS_NodeND(&rows, start.data(), neighbor.data(), nullptr, options, order.data(), position.data());
  if (status != METIS_OK) return {};
  return {order.begin(), order.end()};
}
#else
// Long thin bodies have less fill by minimum degree.
std::vector<int> nested_dissection_order(const BlockPattern& pattern) {
  if (static_cast<int>(pattern.rest_position.size()) != pattern.rows()) return {};
  std::vector<int> order = geometric_order(pattern);
  const auto flops = [&](const std::vector<int>& o) { return find_supernodes(pattern, o).cost.flops; };
  return flops(order) < flops(minimum_degree_order(pattern)) ? order : std::vector<int>{};
}
#endif

}  // namespace

std::vector<int> minimum_degree_order(const BlockPattern& pattern) {
  const int rows = pattern.rows();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(2 * pattern.block_count());
  for (int row = 0; row < rows; ++row)
    for (int64_t s = pattern.row_start[row]; s < pattern.row_start[row + 1]; ++s) {
      entries.emplace_back(row, pattern.column[s], 1.0);
      entries.emplace_back(pattern.column[s], row, 1.0);
    }
  Eigen::SparseMatrix<double> graph(rows, rows);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(graph, permutation);
  const int* first = permutation.indices().data();
  return {first, first + rows};
}

std::vector<int> fill_reducing_order(const BlockPattern& pattern) {
  const int rows = pattern.rows();
  std::vector<int> order;
  if (pattern.block_count() == rows) {  // edge case that neither library handles well
    order.resize(rows);
    std::iota(order.begin(), order.end(), 0);
    return order;
  }
  if (rows >= kTiny) order = nested_dissection_order(pattern);
  if (static_cast<int>(order.size()) != rows || !is_permutation(order)) order = minimum_degree_order(pattern);
  return order;
}

}  // namespace aspic

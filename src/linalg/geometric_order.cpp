// Nested dissection [George 1973] by planes: the median plane along a coordinate axis halves the vertices, and those of
// one half that are coupled to the other half separate them.
#include <algorithm>
#include <numeric>

#include "base/check.h"
#include "linalg/ordering.h"

namespace aspic {
namespace {

constexpr size_t kLeaf = 40;  // rows that are not dissected further

struct Cut {
  std::vector<int> first, second, separator;
};

class Dissection {
 public:
  explicit Dissection(const BlockPattern& pattern) : pattern_(pattern), half_(pattern.rows(), kNone) {}

  std::vector<int> order() {
    std::vector<int> all(pattern_.rows());
    std::iota(all.begin(), all.end(), 0);
    dissect(std::move(all));
    return std::move(order_);
  }

 private:
  static constexpr int kNone = -1;

  // Eliminates the halves first, then what separates them.
  void dissect(std::vector<int> rows) {
    if (rows.size() <= kLeaf) return append(rows);
    Cut best = cut(rows, 0, 0);
    for (int k = 1; k < 6; ++k)
      if (Cut other = cut(rows, k / 2, k % 2); other.separator.size() < best.separator.size()) best = std::move(other);
    dissect(std::move(best.first));
    dissect(std::move(best.second));
    append(best.separator);
  }

  // Takes the separator from the half `from`.
  Cut cut(std::vector<int>& rows, int axis, int from) {
    const auto is_before = [&](int a, int b) {
      const double x = pattern_.rest_position[a][axis], y = pattern_.rest_position[b][axis];
      return x != y ? x < y : a < b;
    };
    const auto middle = rows.begin() + static_cast<std::ptrdiff_t>(rows.size() / 2);
    std::nth_element(rows.begin(), middle, rows.end(), is_before);
    for (auto row = rows.begin(); row != rows.end(); ++row) half_[*row] = row < middle ? 0 : 1;
    Cut result;
    for (const int row : rows) {
      const bool separates = half_[row] == from && touches(row, 1 - from);
      (separates ? result.separator : half_[row] == 0 ? result.first : result.second).push_back(row);
    }
    for (const int row : rows) half_[row] = kNone;
    return result;
  }

  bool touches(int row, int half) const {
    const auto is_there = [&](int other) { return half_[other] == half; };
    const auto lower = pattern_.column.begin(), upper = pattern_.upper_row.begin();
    return std::any_of(lower + pattern_.row_start[row], lower + pattern_.diagonal(row), is_there) ||
           std::any_of(upper + pattern_.upper_start[row], upper + pattern_.upper_start[row + 1], is_there);
  }

  void append(std::vector<int>& rows) {
    std::sort(rows.begin(), rows.end());  // the order within is that of the mesh
    order_.insert(order_.end(), rows.begin(), rows.end());
  }

  const BlockPattern& pattern_;
  std::vector<int> half_;  // of each row of the present cut
  std::vector<int> order_;
};

}  // namespace

std::vector<int> geometric_order(const BlockPattern& pattern) {
  ASPIC_CHECK(static_cast<int>(pattern.rest_position.size()) == pattern.rows());
  return Dissection(pattern).order();
}

}  // namespace aspic

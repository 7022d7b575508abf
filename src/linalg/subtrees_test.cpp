#include "linalg/subtrees.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "linalg/lower_matrix.h"
#include "linalg/matrices_test.h"
#include "linalg/ordering.h"

namespace aspic {
namespace {

using namespace test;

Supernodes supernodes_of(const Matrix& H) { return find_supernodes(*H.pattern, fill_reducing_order(*H.pattern)); }

int64_t update_size(const Supernodes& s, int k) { return LowerMatrix::size_in_strips(3 * int64_t{s.below(k)}); }

struct Place {
  int64_t begin, end;
};

bool overlap(const Place& a, const Place& b) { return a.begin < b.end && b.begin < a.end; }

Place place(const Supernodes& s, const Subtrees& t, int k) {
  return {t.update_start[k], t.update_start[k] + update_size(s, k)};
}

TEST(Subtrees, HoldEachSupernodeOnceInWholeSubtrees) {
  const Matrix H = spring_lattice({.nx = 24, .ny = 10, .nz = 10});
  const Supernodes s = supernodes_of(H);
  const Subtrees t = make_subtrees(s);
  EXPECT_GE(t.tasks.size(), 4U);
  std::vector<int> task_of(s.count(), -1), seen(s.count(), 0);
  for (size_t i = 0; i < t.tasks.size(); ++i)
    for (int k = t.tasks[i].first; k < t.tasks[i].last; ++k) ++seen[k], task_of[k] = static_cast<int>(i);
  for (const int k : t.top) ++seen[k];
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), s.count());
  for (int k = 0; k < s.count(); ++k)
    if (s.parent[k] >= 0 && task_of[s.parent[k]] >= 0) {
      EXPECT_EQ(task_of[k], task_of[s.parent[k]]);
    }
  EXPECT_TRUE(std::is_sorted(t.top.begin(), t.top.end()));
}

TEST(Subtrees, AreOneTaskForSmallMatrix) {
  const Subtrees t = make_subtrees(supernodes_of(spring_lattice({.nx = 3, .ny = 3, .nz = 3})));
  EXPECT_EQ(t.tasks.size(), 1U);
  EXPECT_TRUE(t.top.empty());
}

TEST(Subtrees, ShareTasksForManyBodies) {
  Couplings couplings;
  for (int i = 0; i + 1 < 6000; i += 2) couplings.emplace_back(i, i + 1);
  const Subtrees t = make_subtrees(supernodes_of(random_dominant(6000, couplings, 1)));
  EXPECT_LE(t.tasks.size(), 20U);
  EXPECT_TRUE(t.top.empty());
}

// Replays a factorization. Tasks may run concurrently, so the live memory of a task must be disjoint from all memory
// that another task ever uses.
TEST(Subtrees, LiveUpdateMatricesDoNotOverlap) {
  const Supernodes s = supernodes_of(spring_lattice({.nx = 16, .ny = 10, .nz = 10}));
  const Subtrees t = make_subtrees(s);
  std::vector<int> waiting;
  const auto visit = [&](int k) {
    const Place own = place(s, t, k);
    EXPECT_LE(own.end, t.workspace);
    for (const int other : waiting) EXPECT_FALSE(overlap(own, place(s, t, other))) << k << ' ' << other;
    std::erase_if(waiting, [&](int other) { return s.parent[other] == k; });
    if (s.parent[k] >= 0) waiting.push_back(k);
  };
  for (const Subtrees::Task& task : t.tasks)
    for (int k = task.first; k < task.last; ++k) visit(k);
  for (const int k : t.top) visit(k);
  for (const Subtrees::Task& a : t.tasks)
    for (const Subtrees::Task& b : t.tasks)
      for (int i = a.first; i < a.last && &a != &b; ++i)
        for (int j = b.first; j < b.last; ++j) ASSERT_FALSE(overlap(place(s, t, i), place(s, t, j)));
}

TEST(LowerMatrix, StripsHoldEachEntryOnce) {
  for (const int n : {1, 3, 95, 96, 97, 300}) {
    std::vector<double> storage(LowerMatrix::size_in_strips(n), 0.0);
    const LowerMatrix A{storage.data(), n, true};
    for (int j = 0; j < n; ++j)
      for (int i = j; i < n; ++i) {
        const std::ptrdiff_t at = A.column(j) + i - storage.data();
        ASSERT_TRUE(0 <= at && at < static_cast<std::ptrdiff_t>(storage.size()));
        EXPECT_EQ(storage[at]++, 0);
      }
  }
}

}  // namespace
}  // namespace aspic

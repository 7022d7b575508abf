#include "ranks/rank_memory.h"

#include <gmock/gmock.h>

#include "base/error.h"

namespace aspic::distributed {
namespace {

TEST(RankMemory, NearlyHalvesWhenRanksDouble) {
  const double two = bytes_per_rank({1e7, 2, false}), four = bytes_per_rank({1e7, 4, false});
  EXPECT_GT(four / two, 0.5);
  EXPECT_LT(four / two, 0.55);
}

TEST(RankMemory, NamesWhatFits) {
  const MemoryNeed need{1e6, 2, true};
  const double with_jacobi = bytes_per_rank({1e6, 2, false});
  EXPECT_NO_THROW(require_memory(need, 2, 2.001 * bytes_per_rank(need)));
  try {
    require_memory(need, 2, 2.001 * with_jacobi);
    FAIL();
  } catch (const InvalidInput& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("solver.linear = \"block_jacobi\""));
  }
}

}  // namespace
}  // namespace aspic::distributed

// Runs the unit tests on all ranks; each rank makes the same calls.
#include <gtest/gtest.h>

#include "ranks/guarded.h"
#include "ranks/mpi_ranks.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  return aspic::distributed::guarded([] {
    const int failed = RUN_ALL_TESTS();
    return aspic::distributed::largest_of_ranks(failed);
  });
}

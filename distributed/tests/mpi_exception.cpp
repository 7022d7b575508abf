// Throws an exception on the last rank while the other ranks wait for it.
#include <cstdio>
#include <stdexcept>
#include <string>

#include "base/error.h"
#include "ranks/guarded.h"
#include "ranks/mpi_ranks.h"

int main(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  return aspic::distributed::guarded([&] {
    const int rank = aspic::distributed::rank_of_this_process();
    if (rank + 1 == aspic::distributed::rank_count()) {
      if (kind == "input") throw aspic::InvalidInput("mesh.msh:7: a test");
      throw std::runtime_error("a test");
    }
    std::printf("%d\n", aspic::distributed::largest_of_ranks(rank));  // waits
    return 0;
  });
}

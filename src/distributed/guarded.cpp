#include "distributed/guarded.h"

#include <mpi.h>

#include <cstdio>
#include <exception>
#include <string>

#include "base/error.h"
#include "distributed/mpi_ranks.h"
#include "distributed/petsc_solver.h"

namespace aspic::distributed {
namespace {

constexpr int kInternalError = 1, kBadInput = 2;

// Other ranks may wait for this one, so MPI ends them.
int end_all(int code, const char* what) {
  std::fprintf(stderr, "error: %s (rank %d)\n", what, rank_of_this_process());
  std::fflush(stderr);
  MPI_Abort(MPI_COMM_WORLD, code);
  return code;
}

}  // namespace

int guarded(const std::function<int()>& body) {
  try {
    const PetscSession session;
    try {
      return body();
    } catch (const InvalidInput& e) {
      return end_all(kBadInput, e.what());
    } catch (const std::exception& e) {
      return end_all(kInternalError, e.what());
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: MPI or PETSc cannot start: %s\n", e.what());
    return kInternalError;
  }
}

bool succeeds_on(int rank, const std::function<void()>& body) {
  int has_failed = 0;
  if (rank == rank_of_this_process()) {
    try {
      body();
    } catch (const InvalidInput& e) {
      std::fprintf(stderr, "error: %s\n", e.what());
      has_failed = 1;
    }
  }
  return largest_of_ranks(has_failed) == 0;
}

}  // namespace aspic::distributed

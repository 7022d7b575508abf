#include "ranks/guarded.h"

#include <mpi.h>

#include <cstdio>
#include <exception>
#include <string>

#include "base/error.h"
#include "dynamics/simulation_checks.h"
#include "ranks/exchange.h"
#include "ranks/mpi_ranks.h"
#include "ranks/petsc_solver.h"

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
    } catch (const Refused&) {
      return kBadInput;
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

void all_succeed(const std::function<void()>& body) {
  std::string error;
  double rank_of_error = -rank_count();  // minus the rank, so that the largest is the first
  try {
    body();
  } catch (const InvalidInput& e) {
    error = e.what();
    rank_of_error = -rank_of_this_process();
    const bool is_about_start = dynamic_cast<const BadInitialState*>(&e) != nullptr;
    if (is_about_start) rank_of_error += rank_count();
  }
  const double own = rank_of_error;
  max_over_ranks({&rank_of_error, 1});
  if (rank_of_error == -rank_count()) return;
  if (own == rank_of_error) std::fprintf(stderr, "error: %s\n", error.c_str());
  throw Refused();
}

void succeeds_on(int rank, const std::function<void()>& body) {
  all_succeed([&] {
    if (rank == rank_of_this_process()) body();
  });
}

}  // namespace aspic::distributed

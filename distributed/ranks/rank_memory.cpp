#include "ranks/rank_memory.h"

#include <mpi.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/formatted.h"

namespace aspic::distributed {
namespace {

// Measured on beams of 12,825 and 93,912 vertices, see cluster.md.
constexpr double kProcess = 50e6;          // libraries and MPI [bytes]
constexpr double kWithMultigrid = 11'000;  // per own vertex [bytes]
constexpr double kWithJacobi = 7'000;      // per own vertex [bytes]
constexpr double kPerGhost = 2'500;        // [bytes]
// Factor of the coarse matrix, of dissected cubes of pieces [bytes]. Measured for the pieces of CoarseSpace.
constexpr double kFactor = 14'000, kPieceSize = 45, kMaxPieces = 800;

double coarse_bytes(const MemoryNeed& need) {
  if (!need.has_multigrid || need.ranks == 1) return 0;
  return kFactor * std::pow(std::min(kMaxPieces, need.ranks + need.vertices / kPieceSize), 4.0 / 3);
}

}  // namespace

double bytes_per_rank(const MemoryNeed& need) {
  const double own = need.vertices / need.ranks;
  const double ghosts = need.ranks > 1 ? std::min(need.vertices - own, 7 * std::pow(own, 2.0 / 3)) : 0;
  return kProcess + (need.has_multigrid ? kWithMultigrid : kWithJacobi) * own + kPerGhost * ghosts + coarse_bytes(need);
}

void require_memory(const MemoryNeed& need, int ranks_here, double available) {
  const double bytes = bytes_per_rank(need);
  if (bytes * ranks_here <= available) return;
  MemoryNeed cheaper = need;
  cheaper.has_multigrid = false;
  const double with_jacobi = bytes_per_rank(cheaper);
  std::string remedy = "use more machines, or a coarser mesh";
  if (need.has_multigrid && with_jacobi * ranks_here <= available)
    remedy += formatted(", or solver.linear = \"block_jacobi\", which needs %.3g GB per rank", with_jacobi / 1e9);
  throw InvalidInput(
      formatted("%.0f vertices on %d ranks need about %.3g GB per rank, %.3g GB for the %d ranks of this machine; %.3g "
                "GB are free; ",
                need.vertices, need.ranks, bytes / 1e9, bytes * ranks_here / 1e9, ranks_here, available / 1e9) +
      remedy);
}

int ranks_on_this_machine() {
  MPI_Comm here = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
  int count = 1;
  MPI_Comm_size(here, &count);
  MPI_Comm_free(&here);
  return count;
}

}  // namespace aspic::distributed

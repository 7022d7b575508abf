#include "ranks/mpi_ranks.h"

#include <mpi.h>

#include "ranks/message_size.h"
#include "ranks/rank_parts.h"

// MPI aborts the program after an error by default, so return values need no check.
namespace aspic::distributed {
std::vector<double> MpiRanks::gather(std::span<const double> own) const {
  const int count = message_size(own.size());
  std::vector<double> all(own.size() * share_.ranks());
  MPI_Allgather(own.data(), count, MPI_DOUBLE, all.data(), count, MPI_DOUBLE, MPI_COMM_WORLD);
  ++halo_.traffic().all.reductions;
  return all;
}

std::vector<int> MpiRanks::parts(const TetMesh& mesh, std::span<const double> modulus) const {
  return parts_of_ranks(mesh, share_, halo_, modulus);
}

int rank_of_this_process() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int rank_count() {
  int count = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  return count;
}

int largest_of_ranks(int own) {
  int largest = own;
  MPI_Allreduce(&own, &largest, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return largest;
}

void broadcast(std::span<double> values) {
  MPI_Bcast(values.data(), message_size(values.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
}

}  // namespace aspic::distributed

#include "distributed/mpi_ranks.h"

#include <mpi.h>

#include "dynamics/stiffness_parts.h"

// MPI aborts the program after an error by default, so return values need no check.
namespace aspic::distributed {
namespace {

struct Pieces {
  std::vector<int> count, start;  // of each rank
};

Pieces pieces(const MeshShare& share, int components) {
  Pieces all;
  for (int r = 0; r < share.ranks(); ++r) {
    all.count.push_back(components * (share.cut[r + 1] - share.cut[r]));
    all.start.push_back(components * share.cut[r]);
  }
  return all;
}

}  // namespace

std::vector<double> MpiRanks::gather(std::span<const double> own) const {
  const int count = static_cast<int>(own.size());
  std::vector<double> all(own.size() * share_.ranks());
  MPI_Allgather(own.data(), count, MPI_DOUBLE, all.data(), count, MPI_DOUBLE, MPI_COMM_WORLD);
  return all;
}

std::vector<int> MpiRanks::parts(std::span<const double> modulus) const {
  const Pieces all = pieces(share_, 1);
  std::vector<double> whole(whole_.rest.size());
  MPI_Allgatherv(modulus.data(), share_.own(), MPI_DOUBLE, whole.data(), all.count.data(), all.start.data(), MPI_DOUBLE,
                 MPI_COMM_WORLD);
  const std::vector<int> part = parts_of(whole_, whole);
  std::vector<int> local;
  for (const int v : share_.vertex) local.push_back(part[v]);
  return local;
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

std::vector<double> gather_vertices(const MeshShare& share, std::span<const double> local, int components) {
  const Pieces all = pieces(share, components);
  std::vector<double> whole(share.rank == 0 ? components * static_cast<size_t>(share.cut.back()) : 0);
  MPI_Gatherv(local.data(), components * share.own(), MPI_DOUBLE, whole.data(), all.count.data(), all.start.data(),
              MPI_DOUBLE, 0, MPI_COMM_WORLD);
  return whole;
}

void broadcast(std::span<double> values) {
  MPI_Bcast(values.data(), static_cast<int>(values.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
}

}  // namespace aspic::distributed

#include "ranks/halo.h"

#include <mpi.h>

#include <algorithm>

#include "ranks/message_size.h"

namespace aspic::distributed {

Halo::Halo(const MeshShare& share) {
  const int ranks = share.ranks();
  std::vector<int> wanted(ranks, 0), asked(ranks, 0);
  int owner = 0;
  std::vector<int> first(ranks, 0);
  for (int v = share.own(); v < static_cast<int>(share.vertex.size()); ++v) {
    while (share.vertex[v] >= share.cut[owner + 1]) ++owner;  // ghosts ascend
    if (wanted[owner]++ == 0) first[owner] = v;
  }
  MPI_Alltoall(wanted.data(), 1, MPI_INT, asked.data(), 1, MPI_INT, MPI_COMM_WORLD);
  std::vector<MPI_Request> requests;
  for (int r = 0; r < ranks; ++r)
    if (wanted[r] > 0 || asked[r] > 0) neighbors_.push_back({r, std::vector<int>(asked[r]), first[r], wanted[r]});
  size_t sent = 0;
  for (Neighbor& n : neighbors_) {
    MPI_Irecv(n.sent.data(), message_size(n.sent.size()), MPI_INT, n.rank, 0, MPI_COMM_WORLD, &requests.emplace_back());
    MPI_Isend(share.vertex.data() + n.first_ghost, n.ghost_count, MPI_INT, n.rank, 0, MPI_COMM_WORLD,
              &requests.emplace_back());
    sent += n.sent.size();
  }
  MPI_Waitall(message_size(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  for (Neighbor& n : neighbors_)
    for (int& v : n.sent) v -= share.first();
  buffer_.resize(3 * sent);
}

void Halo::update(std::span<double> x) {
  std::vector<MPI_Request> requests;
  requests.reserve(2 * neighbors_.size());
  double* to_send = buffer_.data();
  for (const Neighbor& n : neighbors_) {
    MPI_Irecv(x.data() + 3 * static_cast<size_t>(n.first_ghost), 3 * n.ghost_count, MPI_DOUBLE, n.rank, 0,
              MPI_COMM_WORLD, &requests.emplace_back());
    double* end = to_send;
    for (const int v : n.sent) end = std::copy_n(x.data() + 3 * static_cast<size_t>(v), 3, end);
    MPI_Isend(to_send, message_size(static_cast<size_t>(end - to_send)), MPI_DOUBLE, n.rank, 0, MPI_COMM_WORLD,
              &requests.emplace_back());
    to_send = end;
  }
  MPI_Waitall(message_size(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  traffic_.all += {static_cast<double>(neighbors_.size()), static_cast<double>(buffer_.size() * sizeof(double)), 0};
}

}  // namespace aspic::distributed

#include "ranks/user_order.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "base/hash.h"
#include "dynamics/state.h"
#include "ranks/exchange.h"
#include "ranks/mpi_ranks.h"

namespace aspic::distributed {
namespace {

using Triple = std::array<double, 3>;

// Returns the triples at `from` in this order.
std::vector<Triple> gathered(std::span<const double> values, const std::vector<int>& from) {
  std::vector<Triple> result;
  result.reserve(from.size());
  for (const int i : from) {
    const double* x = &values[3 * static_cast<size_t>(i)];
    result.push_back({x[0], x[1], x[2]});
  }
  return result;
}

// The reverse.
std::vector<double> spread(const std::vector<Triple>& triples, const std::vector<int>& to) {
  std::vector<double> values(3 * triples.size());
  for (size_t i = 0; i < to.size(); ++i)
    std::copy(triples[i].begin(), triples[i].end(), &values[3 * static_cast<size_t>(to[i])]);
  return values;
}

}  // namespace

UserOrder::UserOrder(const MeshShare& share)
    : first_(share.first()), all_(share.cut.back()), sent_(share.own()), sent_counts_(share.ranks(), 0) {
  std::iota(sent_.begin(), sent_.end(), 0);
  std::sort(sent_.begin(), sent_.end(), [&](int a, int b) { return share.user_vertex[a] < share.user_vertex[b]; });
  std::vector<int> users;
  int rank = 0;
  for (const int v : sent_) {
    const int user = share.user_vertex[v];
    while (user >= share.cut[rank + 1]) ++rank;
    ++sent_counts_[rank];
    users.push_back(user);
  }
  Received<int> received = exchange<int>(users, sent_counts_);
  slice_ = std::move(received.values);
  slice_counts_ = std::move(received.counts);
  for (int& v : slice_) v -= first_;
}

std::vector<double> UserOrder::to_user(std::span<const double> own) const {
  return spread(exchange<Triple>(gathered(own, sent_), sent_counts_).values, slice_);
}

std::vector<double> UserOrder::from_user(std::span<const double> slice) const {
  return spread(exchange<Triple>(gathered(slice, slice_), slice_counts_).values, sent_);
}

std::uint64_t hash_of_slices(std::span<const double> q, std::span<const double> qdot) {
  const int rank = rank_of_this_process(), ranks = rank_count();
  std::uint64_t hash = Fnv1a::kBasis;
  const auto receive = [&](int from) {
    const std::string bytes = receive_bytes(from);
    std::memcpy(&hash, bytes.data(), sizeof(hash));
  };
  const auto send = [&](int to) { send_bytes(to, {reinterpret_cast<const char*>(&hash), sizeof(hash)}); };
  for (const std::span<const double>& values : {q, qdot}) {
    if (rank > 0) receive(rank - 1);
    hash = continued_hash(hash, values);
    if (ranks > 1) send((rank + 1) % ranks);
    if (rank == 0 && ranks > 1) receive(ranks - 1);
  }
  const std::string last = broadcast_text({reinterpret_cast<const char*>(&hash), sizeof(hash)});
  std::memcpy(&hash, last.data(), sizeof(hash));
  return hash;
}

}  // namespace aspic::distributed

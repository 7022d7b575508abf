#include "ranks/exchange.h"

#include <mpi.h>

#include <algorithm>

#include "ranks/message_size.h"
#include "ranks/mpi_ranks.h"

namespace aspic::distributed {
namespace {

constexpr size_t kWord = 4, kChunk = size_t{1} << 30;  // [bytes]

int words(size_t elements, size_t width) { return message_size(elements * width / kWord); }

}  // namespace

std::vector<int> exchange_counts(std::span<const int> to_send) {
  std::vector<int> received(to_send.size());
  MPI_Alltoall(to_send.data(), 1, MPI_INT, received.data(), 1, MPI_INT, MPI_COMM_WORLD);
  return received;
}

void exchange_blocks(const void* to_send, const Blocks& sent, void* received, const Blocks& expected) {
  std::vector<MPI_Request> requests;
  auto* in = static_cast<char*>(received);
  const auto* out = static_cast<const char*>(to_send);
  const int ranks = static_cast<int>(sent.counts.size());
  for (int r = 0; r < ranks; ++r) {
    const size_t count = expected.counts[r];
    if (count > 0)
      MPI_Irecv(in, words(count, expected.width), MPI_INT32_T, r, 1, MPI_COMM_WORLD, &requests.emplace_back());
    in += count * expected.width;
  }
  for (int r = 0; r < ranks; ++r) {
    const size_t count = sent.counts[r];
    if (count > 0)
      MPI_Isend(out, words(count, sent.width), MPI_INT32_T, r, 1, MPI_COMM_WORLD, &requests.emplace_back());
    out += count * sent.width;
  }
  MPI_Waitall(message_size(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

void send_bytes(int to, std::string_view bytes) {
  const std::int64_t size = static_cast<std::int64_t>(bytes.size());
  MPI_Send(&size, 1, MPI_INT64_T, to, 2, MPI_COMM_WORLD);
  for (size_t begin = 0; begin < bytes.size(); begin += kChunk)
    MPI_Send(bytes.data() + begin, message_size(std::min(kChunk, bytes.size() - begin)), MPI_BYTE, to, 2,
             MPI_COMM_WORLD);
}

std::string receive_bytes(int from) {
  std::int64_t size = 0;
  MPI_Recv(&size, 1, MPI_INT64_T, from, 2, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  std::string bytes(static_cast<size_t>(size), '\0');
  for (size_t begin = 0; begin < bytes.size(); begin += kChunk)
    MPI_Recv(bytes.data() + begin, message_size(std::min(kChunk, bytes.size() - begin)), MPI_BYTE, from, 2,
             MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return bytes;
}

std::string broadcast_text(std::string text) {
  int size = message_size(text.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, MPI_COMM_WORLD);
  text.resize(static_cast<size_t>(size));
  MPI_Bcast(text.data(), size, MPI_BYTE, 0, MPI_COMM_WORLD);
  return text;
}

std::vector<std::string> gather_texts(std::string_view text) {
  const int own = message_size(text.size());
  std::vector<int> counts(rank_count()), starts;
  MPI_Allgather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, MPI_COMM_WORLD);
  size_t all = 0;
  for (const int count : counts) starts.push_back(message_size(all)), all += static_cast<size_t>(count);
  std::string joined(all, '\0');
  MPI_Allgatherv(text.data(), own, MPI_BYTE, joined.data(), counts.data(), starts.data(), MPI_BYTE, MPI_COMM_WORLD);
  std::vector<std::string> texts;
  for (size_t r = 0; r < counts.size(); ++r) texts.push_back(joined.substr(starts[r], counts[r]));
  return texts;
}

void sum_over_ranks(std::span<std::int64_t> values) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), message_size(values.size()), MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
}

void max_over_ranks(std::span<double> values) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), message_size(values.size()), MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
}

std::int64_t sum_before(std::int64_t own) {
  std::int64_t before = 0;
  MPI_Exscan(&own, &before, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  return rank_of_this_process() == 0 ? 0 : before;
}

void wait_for_all() { MPI_Barrier(MPI_COMM_WORLD); }

}  // namespace aspic::distributed

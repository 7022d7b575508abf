// Messages of arrays between all ranks. Every function is collective.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace aspic::distributed {

// What a rank received from all ranks, one rank after the other.
template <class T>
struct Received {
  std::vector<T> values;
  std::vector<int> counts;  // from each rank
};

// Returns the numbers of elements that the ranks will send to this one, given those it will send to them.
std::vector<int> exchange_counts(std::span<const int> to_send);
// Copies blocks of bytes between ranks. Counts are of elements of `width` bytes, a multiple of 4.
struct Blocks {
  std::span<const int> counts;
  size_t width;
};
void exchange_blocks(const void* to_send, const Blocks& sent, void* received, const Blocks& expected);

// Sends the values, which are grouped by rank, and returns those of the other ranks. `counts`: for each rank.
template <class T>
Received<T> exchange(std::span<const T> values, std::span<const int> counts) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);
  Received<T> received;
  received.counts = exchange_counts(counts);
  received.values.resize(std::accumulate(received.counts.begin(), received.counts.end(), size_t{0}));
  exchange_blocks(values.data(), {counts, sizeof(T)}, received.values.data(), {received.counts, sizeof(T)});
  return received;
}

// Each rank calls one of them for the other rank. Only those two ranks take part.
void send_bytes(int to, std::string_view bytes);
std::string receive_bytes(int from);

std::string broadcast_text(std::string text);                  // of rank 0
std::vector<std::string> gather_texts(std::string_view text);  // of all ranks, on all ranks
// Returns the values of all ranks, one rank after the other, on all ranks.
template <class T>
std::vector<T> gather_all(const std::vector<T>& own) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> all;
  for (const std::string& bytes : gather_texts({reinterpret_cast<const char*>(own.data()), own.size() * sizeof(T)})) {
    const size_t begin = all.size();
    all.resize(begin + bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(all.data() + begin, bytes.data(), bytes.size());
  }
  return all;
}
void sum_over_ranks(std::span<std::int64_t> values);  // replaces them by their sums
void max_over_ranks(std::span<double> values);        // replaces them by their maxima
std::int64_t sum_before(std::int64_t own);            // sum of the values of smaller ranks
void wait_for_all();

}  // namespace aspic::distributed

#include "ranks/rank_checkpoint.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "base/error.h"
#include "io/input_file.h"
#include "ranks/exchange.h"
#include "ranks/guarded.h"
#include "ranks/mpi_ranks.h"
#include "ranks/shared_file.h"

namespace aspic::distributed {
namespace {

namespace fs = std::filesystem;

// A part of an array of the file: numbers that rank 0 has, or slices of all ranks.
struct Section {
  std::vector<double> values;  // of this rank; those of rank 0 come first in the file
  std::uint64_t before = 0;    // doubles of smaller ranks
  std::uint64_t count = 0;     // of all ranks
};

struct SlicedArray {
  std::string name;
  std::vector<Section> sections;
};

Section of_rank_0(std::vector<double> values) {
  if (rank_of_this_process() > 0) values.clear();
  Section section{std::move(values), 0, 0};
  std::int64_t count = static_cast<std::int64_t>(section.values.size());
  sum_over_ranks({&count, 1});
  section.count = static_cast<std::uint64_t>(count);
  return section;
}

Section sliced(const std::vector<double>& local, const UserOrder& order) {
  return {order.to_user(local), 3 * static_cast<std::uint64_t>(order.first()),
          3 * static_cast<std::uint64_t>(order.all())};
}

std::vector<SlicedArray> arrays_of(const Simulation::Snapshot& local, const UserOrder& order,
                                   const std::vector<double>& frame_times) {
  std::vector<SlicedArray> arrays;
  const auto add_state = [&](const std::string& prefix, const State& state) {
    arrays.push_back({prefix + "q", {sliced(state.q, order)}});
    arrays.push_back({prefix + "qdot", {sliced(state.qdot, order)}});
    arrays.push_back({prefix + "time", {of_rank_0({state.time})}});
  };
  add_state("", local.state);
  add_state("start_", local.start);
  SlicedArray history{"history", {}};
  if (local.previous)
    history.sections = {of_rank_0({local.level, local.previous->time}), sliced(local.previous->q, order),
                        sliced(local.previous->qdot, order)};
  arrays.push_back(std::move(history));
  arrays.push_back({"outside_work", {of_rank_0({local.outside_work})}});
  arrays.push_back({"frame_times", {of_rank_0(frame_times)}});
  return arrays;
}

struct Checked {
  std::uint32_t checksum;
  std::uint64_t bytes;
};

// Writes the numbers of the arrays; returns the checksums of the sections of all ranks, rank by rank.
std::vector<Checked> write_numbers(const SharedFile& file, const std::vector<SlicedArray>& arrays,
                                   const CheckpointLayout& layout) {
  std::vector<Checked> own;
  for (size_t k = 0; k < arrays.size(); ++k) {
    std::uint64_t position = layout.arrays[k].position;
    for (const Section& section : arrays[k].sections) {
      const size_t bytes = section.values.size() * sizeof(double);
      file.write_all(position + section.before * sizeof(double), section.values.data(), bytes);
      own.push_back({checkpoint_checksum(section.values.data(), bytes), bytes});
      position += section.count * sizeof(double);
    }
  }
  return gather_all(own);
}

// Returns the checksum of the file up to its checksum.
std::uint32_t joined(const std::vector<Checked>& all, const std::vector<SlicedArray>& arrays,
                     const CheckpointLayout& layout) {
  const size_t ranks = static_cast<size_t>(rank_count()), sections = all.size() / ranks;
  std::uint32_t sum = checkpoint_checksum(nullptr, 0);
  size_t section = 0;
  for (size_t k = 0; k < arrays.size(); ++k) {
    const std::string& before = layout.arrays[k].before;
    sum = joined_checksum(sum, checkpoint_checksum(before.data(), before.size()), before.size());
    for (size_t s = 0; s < arrays[k].sections.size(); ++s, ++section)
      for (size_t rank = 0; rank < ranks; ++rank) {
        const Checked& part = all[rank * sections + section];
        if (part.bytes > 0) sum = joined_checksum(sum, part.checksum, part.bytes);
      }
  }
  return sum;
}

// Reads doubles of a file.
std::vector<double> read_doubles(const fs::path& path, std::uint64_t position, std::uint64_t count) {
  std::ifstream file = open_input(path);
  std::vector<double> values(count);
  file.seekg(static_cast<std::streamoff>(position));
  if (count > 0 && !file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(8 * count)))
    throw InvalidInput(path.string() + ": cannot be read");
  return values;
}

// The checksum of a slice of the file.
Checked check_slice(const fs::path& path, std::uint64_t size) {
  const auto rank = static_cast<std::uint64_t>(rank_of_this_process()),
             ranks = static_cast<std::uint64_t>(rank_count());
  const std::uint64_t begin = size / ranks * rank, end = rank + 1 == ranks ? size : size / ranks * (rank + 1);
  std::ifstream file = open_input(path);
  file.seekg(static_cast<std::streamoff>(begin));
  constexpr std::uint64_t kChunk = std::uint64_t{1} << 24;
  std::string bytes;
  std::uint32_t sum = checkpoint_checksum(nullptr, 0);
  for (std::uint64_t at = begin; at < end; at += bytes.size()) {
    bytes.resize(std::min(kChunk, end - at));
    if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
      throw InvalidInput(path.string() + ": cannot be read");
    sum = joined_checksum(sum, checkpoint_checksum(bytes.data(), bytes.size()), bytes.size());
  }
  return {sum, end - begin};
}

// Returns why the file is no complete checkpoint; empty: it is one. Collective.
std::string defect_of(const fs::path& path, CheckpointLayout& layout) {
  std::string error;
  Checked own{};
  std::uint32_t stored = 0;
  try {
    layout = read_checkpoint_layout(path);
    own = check_slice(path, layout.size - sizeof(stored));
    std::ifstream file = open_input(path);
    file.seekg(static_cast<std::streamoff>(layout.size - sizeof(stored)));
    file.read(reinterpret_cast<char*>(&stored), sizeof(stored));
  } catch (const InvalidInput& e) {
    error = e.what();
  }
  for (const std::string& other : gather_texts(error))
    if (!other.empty()) return other;
  std::uint32_t sum = checkpoint_checksum(nullptr, 0);
  for (const Checked& part : gather_all(std::vector<Checked>{own}))
    sum = joined_checksum(sum, part.checksum, part.bytes);
  return sum == stored ? "" : path.string() + ": is damaged: its checksum is wrong";
}

class Reader {
 public:
  Reader(const fs::path& path, const CheckpointLayout& layout, const UserOrder& order)
      : path_(path), layout_(layout), order_(order) {}

  // Reads what this rank needs, without communication.
  void read() {
    const std::int64_t steps = layout_.head.integer("steps_taken");
    if (steps < 0 || steps > std::numeric_limits<int>::max())
      throw InvalidInput("the checkpoint counts " + std::to_string(steps) + " steps; it is damaged");
    snapshot_.steps_taken = static_cast<int>(steps);
    read_state("", snapshot_.state);
    read_state("start_", snapshot_.start);
    snapshot_.outside_work = number("outside_work");
    const CheckpointLayout::Array& history = layout_.array("history");
    const std::uint64_t all = 3 * static_cast<std::uint64_t>(order_.all());
    if (history.count > 1 && history.count != 2 + 2 * all)
      throw InvalidInput("the checkpoint's history has " + std::to_string(history.count) +
                         " entries; this scene needs " + std::to_string(2 + 2 * all));
    if (history.count > 1) {
      State& previous = snapshot_.previous.emplace();
      previous.time = read_doubles(path_, history.position + 8, 1)[0];
      previous.q = slice(history.position + 16);
      previous.qdot = slice(history.position + 16 + 8 * all);
    }
  }

  // From slices to own vertices. Collective.
  Simulation::Snapshot to_own() {
    std::vector<State*> states = {&snapshot_.state, &snapshot_.start};
    if (snapshot_.previous) states.push_back(&*snapshot_.previous);
    for (State* state : states) {
      state->q = order_.from_user(state->q);
      state->qdot = order_.from_user(state->qdot);
    }
    return std::move(snapshot_);
  }

  std::vector<double> numbers(const char* name) const {
    const CheckpointLayout::Array& array = layout_.array(name);
    return read_doubles(path_, array.position, array.count);
  }

 private:
  double number(const std::string& name) const {
    const CheckpointLayout::Array& array = layout_.array(name);
    if (array.count != 1) throw InvalidInput("the checkpoint has no single number '" + name + "'");
    return read_doubles(path_, array.position, 1)[0];
  }
  std::vector<double> slice(std::uint64_t position) const {
    return read_doubles(path_, position + 24 * static_cast<std::uint64_t>(order_.first()),
                        3 * static_cast<std::uint64_t>(order_.count()));
  }
  void read_state(const std::string& prefix, State& state) const {
    const std::uint64_t all = 3 * static_cast<std::uint64_t>(order_.all());
    for (const auto& [name, values] : {std::pair{"q", &state.q}, {"qdot", &state.qdot}}) {
      const CheckpointLayout::Array& array = layout_.array(prefix + name);
      if (array.count != all)
        throw InvalidInput("the checkpoint has " + std::to_string(array.count) + " entries; this scene needs " +
                           std::to_string(all));
      *values = slice(array.position);
    }
    state.time = number(prefix + "time");
  }

  fs::path path_;
  const CheckpointLayout& layout_;
  const UserOrder& order_;
  Simulation::Snapshot snapshot_;
};

}  // namespace

void write_slices(const fs::path& path, const Simulation::Snapshot& local, const UserOrder& order,
                  const CheckpointFacts& facts) {
  const bool is_first = rank_of_this_process() == 0;
  const std::vector<SlicedArray> arrays = arrays_of(local, order, facts.frame_times);
  std::vector<std::pair<std::string, std::uint64_t>> counts;
  for (const SlicedArray& array : arrays) {
    counts.emplace_back(array.name, 0);
    for (const Section& section : array.sections) counts.back().second += section.count;
  }
  Checkpoint head;
  head.fingerprint = broadcast_text(facts.fingerprint);
  head.integers = {{"steps_taken", local.steps_taken}};
  std::int64_t extra = is_first ? static_cast<std::int64_t>(facts.integers.size()) : 0;
  sum_over_ranks({&extra, 1});
  for (std::int64_t i = 0; i < extra; ++i) {
    std::int64_t value = is_first ? facts.integers[i].second : 0;
    sum_over_ranks({&value, 1});
    head.integers.emplace_back(broadcast_text(is_first ? facts.integers[i].first : ""), value);
  }
  const CheckpointLayout layout = checkpoint_layout(std::move(head), counts);
  const fs::path unfinished = path.parent_path() / ".aspic-checkpoint";
  {
    const SharedFile file = SharedFile::create(unfinished);
    const std::uint32_t sum = joined(write_numbers(file, arrays, layout), arrays, layout);
    for (const CheckpointLayout::Array& array : layout.arrays)
      file.write_all(array.position - array.before.size(), array.before.data(), is_first ? array.before.size() : 0);
    file.write_all(layout.size - sizeof(sum), &sum, is_first ? sizeof(sum) : 0);
    file.sync();
  }
  succeeds_on(0, [&] {
    keep_previous_checkpoint(path);
    replace_by(unfinished, path);
  });
}

RankCheckpoint read_slices(const fs::path& path, const UserOrder& order) {
  CheckpointLayout layout;
  fs::path file = path;
  RankCheckpoint result;
  const std::string defect = defect_of(path, layout);
  if (!defect.empty()) {
    file = previous_checkpoint(path);
    const std::string other = defect_of(file, layout);
    all_succeed([&] {
      if (!other.empty()) throw InvalidInput("no readable checkpoint: " + defect + "; " + other);
    });
    result.note = defect + "; continuing from " + file.filename().string();
  }
  Reader reader(file, layout, order);
  all_succeed([&] {
    reader.read();
    if (rank_of_this_process() == 0) result.head.arrays = {{"frame_times", reader.numbers("frame_times")}};
  });
  result.head.fingerprint = layout.head.fingerprint;
  result.head.integers = layout.head.integers;
  result.own = reader.to_own();
  return result;
}

}  // namespace aspic::distributed

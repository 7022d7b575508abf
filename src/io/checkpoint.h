// State from which a run continues: named arrays and integers in one binary file with a checksum.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aspic {

struct Checkpoint {
  std::string fingerprint;  // fingerprint of the scene; a checkpoint fits no other scene
  std::vector<std::pair<std::string, std::vector<double>>> arrays;
  std::vector<std::pair<std::string, int64_t>> integers;

  const std::vector<double>* find(std::string_view name) const;  // null: it is missing
  // Throw InvalidInput if the name is missing.
  const std::vector<double>& array(std::string_view name) const;
  int64_t integer(std::string_view name) const;
};

// Writes the file atomically. The previous contents of `path` remain as `previous_checkpoint(path)`.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);
std::filesystem::path previous_checkpoint(const std::filesystem::path& path);

// Positions of the numbers in the file of a checkpoint, for programs that read and write them in slices.
struct CheckpointLayout {
  struct Array {
    std::string name;
    std::uint64_t count = 0;     // of doubles
    std::uint64_t position = 0;  // of the first one [bytes]
    std::string before;          // the bytes of the file from the end of the previous array to the position
  };
  Checkpoint head;  // without arrays
  std::vector<Array> arrays;
  std::uint64_t size = 0;  // of the file [bytes]; its last 4 are the checksum of the others

  const Array& array(std::string_view name) const;  // throws InvalidInput if the name is missing
};
// `counts`: names of the arrays and numbers of their entries.
CheckpointLayout checkpoint_layout(Checkpoint head, const std::vector<std::pair<std::string, std::uint64_t>>& counts);
// Reads the file except the numbers of the arrays and the checksum. Throws InvalidInput.
CheckpointLayout read_checkpoint_layout(const std::filesystem::path& path);
// Checksum of the bytes, and that of the bytes of two parts, one after the other, from those of the parts.
std::uint32_t checkpoint_checksum(const void* bytes, std::size_t count);
std::uint32_t joined_checksum(std::uint32_t first, std::uint32_t second, std::uint64_t bytes_of_second);
void keep_previous_checkpoint(const std::filesystem::path& path);  // does nothing if there is none

// Throws InvalidInput if the file is truncated or altered, or has another version or byte order.
Checkpoint read_checkpoint(const std::filesystem::path& path);

struct NewestCheckpoint {
  Checkpoint checkpoint;
  std::string note;  // reason why it is not the newest; empty if it is
};
// Reads `path`, or the previous checkpoint if that fails. Throws InvalidInput with both reasons if neither can be read.
NewestCheckpoint read_newest_checkpoint(const std::filesystem::path& path);

// Hash of the text in 16 hexadecimal digits (FNV-1a, 64 bits): detects mistakes, not forgery.
std::string fingerprint(std::string_view text);

}  // namespace aspic

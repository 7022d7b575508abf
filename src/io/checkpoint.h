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

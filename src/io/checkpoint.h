// Everything a run needs to continue, as named arrays and integers in one checked binary file.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aspic {

struct Checkpoint {
  std::string fingerprint;  // of the scene: a checkpoint fits no other
  std::vector<std::pair<std::string, std::vector<double>>> arrays;
  std::vector<std::pair<std::string, int64_t>> integers;

  // Throw InvalidInput when there is none of that name.
  const std::vector<double>& array(std::string_view name) const;
  int64_t integer(std::string_view name) const;
};

// The whole file appears at once. What `path` held before stays beside it as `previous_checkpoint(path)`.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);
std::filesystem::path previous_checkpoint(const std::filesystem::path& path);

// Throws InvalidInput for a file that is cut short, altered in any byte, or of another version or byte order.
Checkpoint read_checkpoint(const std::filesystem::path& path);

struct NewestCheckpoint {
  Checkpoint checkpoint;
  std::string note;  // why it is not the newest; empty when it is
};
// `path` when it can be read, else the one before it; throws InvalidInput with both reasons when neither can.
NewestCheckpoint read_newest_checkpoint(const std::filesystem::path& path);

// 16 hexadecimal digits that differ when the texts differ (FNV-1a, 64 bits): a guard against mistakes, not against
// forgery.
std::string fingerprint(std::string_view text);

}  // namespace aspic

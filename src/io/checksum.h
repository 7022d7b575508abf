// CRC-32 of files that grow, to detect later changes.
#pragma once
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string_view>

namespace aspic {

class Checksum {
 public:
  void add(std::string_view bytes);
  uint32_t value() const { return value_; }

 private:
  uint32_t value_ = 0;
};

// Reads the bytes [begin, end) of a file in portions. Throws InvalidInput if the file cannot be read, or ends before a
// finite `end`.
Checksum file_checksum(const std::filesystem::path& path, uint64_t begin = 0,
                       uint64_t end = std::numeric_limits<uint64_t>::max());

// Throws InvalidInput unless both are equal.
void require_unchanged(const std::filesystem::path& path, double written, double found);

}  // namespace aspic

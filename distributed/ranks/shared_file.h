// Files that all ranks write together.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

namespace aspic::distributed {

class SharedFile {
 public:
  // All throw std::runtime_error with the reason of MPI. Collective.
  static SharedFile create(const std::filesystem::path& path);  // an existing file is emptied
  ~SharedFile();
  SharedFile(SharedFile&&) noexcept;

  // Writes bytes of this rank at a position of the file. Each rank has its own arguments.
  void write_all(std::uint64_t position, const void* data, std::size_t bytes) const;
  void sync() const;  // returns when the data are on the disk

 private:
  struct Impl;
  explicit SharedFile(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// Renames a complete file, whose data are on the disk. Throws InvalidInput. Not collective.
void replace_by(const std::filesystem::path& finished, const std::filesystem::path& target);

}  // namespace aspic::distributed

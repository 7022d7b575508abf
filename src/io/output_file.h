// File that grows during a run, for results that are appended step by step.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace aspic {

// All functions throw InvalidInput with path and reason if the system refuses (disk full, no permission).
class OutputFile {
 public:
  OutputFile() = default;                                              // no file
  static OutputFile create(const std::filesystem::path& path);         // empty
  static OutputFile open_existing(const std::filesystem::path& path);  // positioned at its end
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;

  void append(std::string_view bytes);                     // writes all bytes, or none if the system refuses
  void write_at(uint64_t offset, std::string_view bytes);  // overwrites
  void truncate(uint64_t size);                            // keeps the first `size` bytes
  void sync();                                             // returns when the bytes are on disk
  void close();

  uint64_t size() const { return size_; }
  bool is_open() const { return descriptor_ >= 0; }
  const std::filesystem::path& path() const { return path_; }

 private:
  OutputFile(std::filesystem::path path, int flags);
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  uint64_t size_ = 0;
};

}  // namespace aspic

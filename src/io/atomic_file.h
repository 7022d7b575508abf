// Atomic file replacement: a temporary file beside the target, fsync, rename. All functions throw InvalidInput if the
// system refuses (disk full, no permission).
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace aspic {

// A file that replaces the one at `path` once it is complete. A symbolic link remains a link.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();  // without commit(): leaves nothing

  void append(std::string_view bytes);
  void commit();  // returns when the file is on disk

 private:
  [[noreturn]] void fail_to_write() const;

  std::filesystem::path path_, target_;
  std::string temporary_;  // empty once it was renamed
  int descriptor_ = -1;
};

void write_file(const std::filesystem::path& path, std::string_view contents);
std::string read_file(const std::filesystem::path& path);

}  // namespace aspic

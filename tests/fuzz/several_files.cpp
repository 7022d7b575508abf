#include "several_files.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>

namespace aspic::fuzz {

namespace fs = std::filesystem;

std::vector<std::pair<std::string, std::string_view>> split_files(std::string_view bytes,
                                                                  const std::vector<std::string>& allowed) {
  constexpr std::string_view kMark = "=== ";
  std::vector<std::pair<std::string, std::string_view>> files;
  while (bytes.starts_with(kMark)) {
    const size_t line_end = std::min(bytes.find('\n'), bytes.size());
    const std::string name(bytes.substr(kMark.size(), line_end - kMark.size()));
    bytes.remove_prefix(std::min(line_end + 1, bytes.size()));
    size_t end = bytes.starts_with(kMark) ? 0 : bytes.find("\n" + std::string(kMark));
    end = std::min(end, bytes.size());
    if (std::find(allowed.begin(), allowed.end(), name) != allowed.end())
      files.emplace_back(name, bytes.substr(0, end));
    bytes.remove_prefix(end < bytes.size() && bytes[end] == '\n' ? end + 1 : end);
  }
  if (files.empty()) files.emplace_back(allowed.front(), bytes);
  return files;
}

std::string joined_files(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string text;
  for (const auto& [name, contents] : files) text += (text.empty() ? "=== " : "\n=== ") + name + "\n" + contents;
  return text;
}

void put_file(const fs::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

Files::Files(const fs::path& folder, std::string_view bytes, const std::vector<std::string>& allowed) {
  for (const auto& [name, contents] : split_files(bytes, allowed))
    put_file(paths_.emplace_back(folder / name), contents);
}

Files::~Files() {
  std::error_code ignored;
  for (const fs::path& path : paths_) fs::remove(path, ignored);
}

const fs::path& folder_of_process() {
  static const TemporaryFolder folder;
  return folder.path();
}

std::string with_right_checksum(std::string_view bytes) {
  constexpr size_t kSizeOffset = 16, kHead = 24, kChecksum = 4;
  std::string right(bytes);
  if (right.size() < kHead + kChecksum) return right;
  const uint64_t size = right.size();
  std::memcpy(right.data() + kSizeOffset, &size, sizeof size);
  const auto checksum =
      static_cast<uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(right.data()), right.size() - kChecksum));
  std::memcpy(right.data() + right.size() - kChecksum, &checksum, kChecksum);
  return right;
}

std::string with_fingerprint(std::string_view checkpoint, std::string_view fingerprint) {
  constexpr size_t kOffset = 32;  // header and its length
  std::string right(checkpoint);
  if (right.size() >= kOffset + fingerprint.size()) right.replace(kOffset, fingerprint.size(), fingerprint);
  return right;
}

}  // namespace aspic::fuzz

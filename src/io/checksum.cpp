#include "io/checksum.h"

#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "base/error.h"
#include "io/input_file.h"

namespace aspic {

void Checksum::add(std::string_view bytes) {
  value_ = static_cast<uint32_t>(crc32_z(value_, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

Checksum file_checksum(const std::filesystem::path& path, uint64_t begin, uint64_t end) {
  constexpr uint64_t kPortion = 1 << 20;
  std::ifstream in = open_input(path);
  in.seekg(static_cast<std::streamoff>(begin));
  Checksum sum;
  std::string bytes(kPortion, '\0');
  for (uint64_t at = begin; at < end;) {
    in.read(bytes.data(), static_cast<std::streamsize>(std::min(kPortion, end - at)));
    const auto count = static_cast<size_t>(in.gcount());
    sum.add({bytes.data(), count});
    at += count;
    if (in) continue;
    if (end != std::numeric_limits<uint64_t>::max() && at < end)
      throw InvalidInput(path.string() + ": cannot be read up to byte " + std::to_string(end));
    break;
  }
  return sum;
}

void require_unchanged(const std::filesystem::path& path, double written, double found) {
  if (written != found)
    throw InvalidInput(path.string() +
                       ": has changed since the run wrote it, so the run cannot be continued; restore it, or restart "
                       "the run with --force");
}

}  // namespace aspic

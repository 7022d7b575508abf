#include "io/zip.h"

#include <cstdint>
#include <limits>

#include "base/check.h"
#include "io/gzip.h"

namespace aspic {
namespace {

constexpr size_t kGzipHead = 10, kGzipTail = 8;  // around the deflated bytes; the trailer has CRC-32 and size
constexpr uint16_t kVersion = 20, kUtf8 = 1 << 11, kDeflated = 8;
constexpr uint16_t kMidnight = 0, kFirstOfJanuary1980 = 0x21;  // constant, so that archives are reproducible

template <class T>
void append(std::string& bytes, T value) {
  for (size_t i = 0; i < sizeof(T); ++i) bytes += static_cast<char>(static_cast<uint64_t>(value) >> (8 * i) & 0xff);
}

// Fields that both headers of a file share.
std::string description(const std::string& packed, const std::string& name) {
  std::string bytes;
  append<uint16_t>(bytes, kVersion);
  append<uint16_t>(bytes, kUtf8);
  append<uint16_t>(bytes, kDeflated);
  append<uint16_t>(bytes, kMidnight);
  append<uint16_t>(bytes, kFirstOfJanuary1980);
  bytes += packed.substr(packed.size() - kGzipTail, 4);  // CRC-32
  append<uint32_t>(bytes, packed.size() - kGzipHead - kGzipTail);
  bytes += packed.substr(packed.size() - 4);  // size
  append<uint16_t>(bytes, name.size());
  append<uint16_t>(bytes, 0);  // no extra field
  return bytes;
}

}  // namespace

std::string zipped(const std::vector<ZipEntry>& entries) {
  std::string archive, directory;
  for (const ZipEntry& entry : entries) {
    const std::string packed = gzipped(entry.bytes), described = description(packed, entry.name);
    directory += "PK\x01\x02";
    append<uint16_t>(directory, kVersion);
    directory += described;
    append<uint16_t>(directory, 0);  // no comment
    append<uint16_t>(directory, 0);  // the first disk
    append<uint16_t>(directory, 0);  // no attributes
    append<uint32_t>(directory, 0);
    append<uint32_t>(directory, archive.size());
    directory += entry.name;
    archive += "PK\x03\x04" + described + entry.name;
    archive.append(packed, kGzipHead, packed.size() - kGzipHead - kGzipTail);
  }
  const size_t start = archive.size();
  ASPIC_CHECK(start + directory.size() < std::numeric_limits<uint32_t>::max() && entries.size() < 0xffff);
  archive += directory + "PK\x05\x06";
  append<uint32_t>(archive, 0);  // disks
  append<uint16_t>(archive, entries.size());
  append<uint16_t>(archive, entries.size());
  append<uint32_t>(archive, directory.size());
  append<uint32_t>(archive, start);
  append<uint16_t>(archive, 0);  // no comment
  return archive;
}

}  // namespace aspic

#include "io/unzip.h"

#include <zlib.h>

#include <algorithm>
#include <new>

#include "base/free_memory.h"
#include "base/printable.h"
#include "io/byte_cursor.h"

namespace aspic {
namespace {

constexpr std::string_view kDirectoryEnd("PK\x05\x06", 4);
constexpr uint32_t kDirectoryEntry = 0x02014b50, kLocalHead = 0x04034b50;
constexpr size_t kEndBytes = 22;
constexpr uint64_t kLargestRatio = 1032;  // of deflate [zlib technical details]
constexpr uint16_t kStored = 0, kDeflatedMethod = 8;

struct Packed {
  std::string name;
  uint16_t flags = 0, method = 0;
  uint32_t checksum = 0, packed = 0, size = 0, head = 0;
};

std::string inflated(std::string_view packed, size_t size, const ByteCursor& place, const std::string& name) {
  z_stream stream = {};
  if (inflateInit2(&stream, -15) != Z_OK) throw std::bad_alloc();  // raw deflated data
  std::string bytes(size, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // zlib does not write to it
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(size);
  const int status = inflate(&stream, Z_FINISH);
  const bool is_whole = status == Z_STREAM_END && stream.avail_out == 0;
  inflateEnd(&stream);
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (!is_whole) place.fail("the deflated data of " + shown(name) + " are damaged; get another copy");
  return bytes;
}

class Archive {
 public:
  Archive(std::string file, std::string_view bytes) : file_(std::move(file)), bytes_(bytes) {}

  std::vector<ZipEntry> read(FunctionRef<bool(const std::string& name)> is_wanted) {
    const size_t end = bytes_.rfind(kDirectoryEnd);
    if (end == std::string_view::npos || bytes_.size() - end < kEndBytes)
      at(bytes_.size())
          .fail("the directory at the end of the archive is missing; it is cut short, get a complete copy");
    ByteCursor tail = at(end + 10);
    const uint16_t count = tail.read<uint16_t>("the number of files");
    tail.skip(4, "the size of the directory");
    ByteCursor directory = at(tail.read<uint32_t>("the start of the directory"));
    std::vector<ZipEntry> entries;
    for (int i = 0; i < count; ++i) {
      const Packed packed = entry(directory);
      if (!is_wanted(packed.name)) continue;
      for (const ZipEntry& other : entries)
        if (other.name == packed.name) directory.fail(shown(packed.name) + " is there twice; remove one of them");
      count_bytes(packed, directory);
      entries.push_back(unpacked(packed));
    }
    return entries;
  }

 private:
  void count_bytes(const Packed& e, const ByteCursor& place) {
    constexpr uint64_t kMany = uint64_t{1} << 26;
    constexpr int64_t kCopies = 4;  // of the bytes: unpacked, as numbers, as points
    packed_ += e.packed;
    unpacked_ += e.size;
    if (packed_ > bytes_.size()) place.fail("the files of the archive overlap; it is damaged, get another copy");
    if (unpacked_ < kMany) return;
    if (const int64_t available = free_memory() / kCopies; static_cast<int64_t>(unpacked_) > available)
      place.fail("unpacks to more than " + std::to_string(unpacked_) + " bytes; there is memory for " +
                 std::to_string(available) + ". Save fewer frames or points");
  }

  ByteCursor at(size_t position) const {
    ByteCursor cursor(file_, bytes_, std::min(position, bytes_.size()));
    if (position > bytes_.size())
      cursor.fail("the archive refers to byte " + std::to_string(position) + ", beyond its end");
    return cursor;
  }

  Packed entry(ByteCursor& directory) const {
    if (directory.read<uint32_t>("an entry of the directory") != kDirectoryEntry)
      directory.fail("no entry of the directory begins here; the archive is damaged, get another copy");
    directory.skip(4, "versions");
    Packed e;
    e.flags = directory.read<uint16_t>("flags");
    e.method = directory.read<uint16_t>("a method");
    directory.skip(4, "a time");
    e.checksum = directory.read<uint32_t>("a checksum");
    e.packed = directory.read<uint32_t>("a size");
    e.size = directory.read<uint32_t>("a size");
    const uint16_t name = directory.read<uint16_t>("the length of a name"),
                   extra = directory.read<uint16_t>("the length of a field"),
                   comment = directory.read<uint16_t>("the length of a comment");
    directory.skip(8, "attributes");
    e.head = directory.read<uint32_t>("the place of a file");
    const size_t begin = directory.position();
    directory.skip(uint64_t{name} + extra + comment, "a name");
    e.name = printable(bytes_.substr(begin, name));
    return e;
  }

  ZipEntry unpacked(const Packed& e) const {
    ByteCursor head = at(e.head);
    if (head.read<uint32_t>("a file") != kLocalHead)
      head.fail("no file begins here; the archive is damaged, get another copy");
    head.skip(22, "the head of a file");
    const uint16_t name = head.read<uint16_t>("the length of a name"),
                   extra = head.read<uint16_t>("the length of a field");
    head.skip(uint64_t{name} + extra, "a name");
    const size_t begin = head.position();
    head.skip(e.packed, "the bytes of " + shown(e.name));
    const std::string_view bytes = bytes_.substr(begin, e.packed);
    if ((e.flags & 1) != 0) head.fail(shown(e.name) + " is encrypted; export it without a password");
    if (e.method != kStored && e.method != kDeflatedMethod)
      head.fail(shown(e.name) + " is packed by method " + std::to_string(e.method) + "; store or deflate it");
    if (e.method == kStored && e.size != e.packed) head.fail(shown(e.name) + " has two sizes; the archive is damaged");
    if (e.size > kLargestRatio * e.packed)
      head.fail(shown(e.name) + " claims " + std::to_string(e.size) + " bytes, more than its " +
                std::to_string(e.packed) + " deflated bytes can hold; the archive is damaged");
    std::string whole = e.method == kStored ? std::string(bytes) : inflated(bytes, e.size, head, e.name);
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(whole.data()), static_cast<uInt>(whole.size()));
    if (sum != e.checksum)
      head.fail("the checksum of " + shown(e.name) + " is wrong; the archive is damaged, get another copy");
    return {e.name, std::move(whole)};
  }

  std::string file_;
  std::string_view bytes_;
  uint64_t packed_ = 0, unpacked_ = 0;  // bytes of the wanted files so far
};

}  // namespace

std::vector<ZipEntry> unzipped(const std::string& file, std::string_view archive,
                               FunctionRef<bool(const std::string& name)> is_wanted) {
  return Archive(file, archive).read(is_wanted);
}

}  // namespace aspic

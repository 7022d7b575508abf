#include "io/checkpoint.h"

#include <zlib.h>

#include <cstring>
#include <fstream>
#include <utility>

#include "base/check.h"
#include "base/error.h"
#include "base/hash.h"
#include "io/atomic_file.h"
#include "io/input_file.h"
#include "io/number_text.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

// Layout: magic, uint32 byte order mark, uint32 version, uint64 size of the file; the fingerprint; uint64 number of
// integers, each a name and an int64; uint64 number of arrays, each a name, a uint64 length and doubles; CRC-32 of all
// previous bytes. A name is a uint64 length and its characters.
constexpr std::string_view kCheckpointMagic("ASPICCHK", 8);
constexpr uint32_t kWordOrderMark = 0x01020304, kVersion = 1;
constexpr size_t kCheckpointHeadSize = 24, kChecksumSize = 4;

uint32_t checksum(std::string_view bytes) {
  return static_cast<uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void append_name(std::string& bytes, const std::string& name) {
  append_bytes(bytes, uint64_t{name.size()});
  bytes += name;
}

std::string encoded(const Checkpoint& checkpoint) {
  std::vector<std::pair<std::string, uint64_t>> counts;
  for (const auto& [name, values] : checkpoint.arrays) counts.emplace_back(name, values.size());
  const CheckpointLayout layout = checkpoint_layout({checkpoint.fingerprint, {}, checkpoint.integers}, counts);
  std::string bytes;
  for (size_t k = 0; k < layout.arrays.size(); ++k) {
    const std::vector<double>& values = checkpoint.arrays[k].second;
    bytes += layout.arrays[k].before;
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
  }
  append_bytes(bytes, checksum(bytes));
  return bytes;
}

class Decoder {
 public:
  Decoder(const fs::path& path, std::string_view bytes) : path_(path), whole_(bytes), rest_(bytes) {}

  Checkpoint decode() {
    check_head();
    Checkpoint checkpoint;
    checkpoint.fingerprint = name();
    for (uint64_t n = number<uint64_t>(); n > 0; --n) {
      std::string key = name();
      checkpoint.integers.emplace_back(std::move(key), number<int64_t>());
    }
    for (uint64_t n = number<uint64_t>(); n > 0; --n) {
      std::string key = name();
      checkpoint.arrays.emplace_back(std::move(key), reals());
    }
    if (rest_.size() != kChecksumSize) fail("is damaged: it does not end where it should");
    return checkpoint;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(path_.string() + ": " + what); }

  void check_head() {
    if (!whole_.starts_with(kCheckpointMagic)) fail("is not a checkpoint");
    rest_.remove_prefix(kCheckpointMagic.size());
    if (number<uint32_t>() != kWordOrderMark) fail("was written on a machine of another byte order, or is damaged");
    if (const auto version = number<uint32_t>(); version != kVersion) {
      fail("is a checkpoint of version " + std::to_string(version) + "; this program reads version " +
           std::to_string(kVersion));
    }
    if (const auto size = number<uint64_t>(); size != whole_.size() || size < kCheckpointHeadSize + kChecksumSize) {
      fail("is cut short or damaged: " + std::to_string(whole_.size()) + " bytes instead of " + std::to_string(size));
    }
    uint32_t stored;
    std::memcpy(&stored, whole_.data() + whole_.size() - kChecksumSize, kChecksumSize);
    if (stored != checksum(whole_.substr(0, whole_.size() - kChecksumSize))) fail("is damaged: its checksum is wrong");
  }

  std::string_view take(uint64_t size) {
    if (size > rest_.size()) fail("is cut short or damaged");
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  template <class T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }

  std::string name() { return std::string(take(number<uint64_t>())); }

  std::vector<double> reals() {
    const auto count = number<uint64_t>();
    if (count > rest_.size() / sizeof(double)) fail("is cut short or damaged");
    std::vector<double> values(count);
    const std::string_view bytes = take(count * sizeof(double));
    if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

  const fs::path& path_;
  std::string_view whole_, rest_;
};

// Gives the file a second name, atomically replacing the previous owner of that name.
void keep_as(const fs::path& path, const fs::path& kept) {
  std::error_code error;
  const fs::path fresh = kept.string() + ".new";
  fs::remove(fresh, error);
  fs::create_hard_link(path, fresh, error);
  if (error) {  // the file system has no hard links
    write_file(kept, read_file(path));
    return;
  }
  fs::rename(fresh, kept, error);
  if (error) throw InvalidInput(kept.string() + ": cannot be written: " + error.message());
  fs::remove(fresh, error);  // rename keeps both names if they refer to one file
}

// Reads the parts of a file that are not the numbers of arrays.
class LayoutReader {
 public:
  explicit LayoutReader(const fs::path& path) : path_(path), file_(open_input(path)) {}

  CheckpointLayout read() {
    std::error_code error;
    const uint64_t size = fs::file_size(path_, error);
    if (error) fail("cannot be read");
    CheckpointLayout layout;
    if (take(kCheckpointMagic.size()) != kCheckpointMagic) fail("is not a checkpoint");
    if (number<uint32_t>() != kWordOrderMark) fail("was written on a machine of another byte order, or is damaged");
    if (number<uint32_t>() != kVersion) fail("is a checkpoint of another version");
    layout.size = number<uint64_t>();
    if (layout.size != size) fail("is cut short or damaged");
    layout.head.fingerprint = name();
    for (uint64_t n = number<uint64_t>(); n > 0; --n) {
      std::string key = name();
      layout.head.integers.emplace_back(std::move(key), number<int64_t>());
    }
    for (uint64_t n = number<uint64_t>(); n > 0; --n) {
      CheckpointLayout::Array array;
      array.name = name();
      array.count = number<uint64_t>();
      array.position = position_;
      if (array.count > size / sizeof(double)) fail("is cut short or damaged");
      skip(array.count * sizeof(double));
      layout.arrays.push_back(std::move(array));
    }
    if (position_ + kChecksumSize != size) fail("is damaged: it does not end where it should");
    return layout;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(path_.string() + ": " + what); }

  std::string take(uint64_t count) {
    constexpr uint64_t kLongest = 1 << 20;
    if (count > kLongest) fail("is damaged");
    std::string bytes(count, '\0');
    if (!file_.read(bytes.data(), static_cast<std::streamsize>(count))) fail("is cut short or damaged");
    position_ += count;
    return bytes;
  }
  void skip(uint64_t count) {
    position_ += count;
    file_.seekg(static_cast<std::streamoff>(position_));
  }
  template <class T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string name() { return take(number<uint64_t>()); }

  const fs::path& path_;
  std::ifstream file_;
  uint64_t position_ = 0;
};

}  // namespace

const CheckpointLayout::Array& CheckpointLayout::array(std::string_view name) const {
  for (const Array& candidate : arrays)
    if (candidate.name == name) return candidate;
  throw InvalidInput("the checkpoint has no array '" + std::string(name) + "'");
}

CheckpointLayout checkpoint_layout(Checkpoint head, const std::vector<std::pair<std::string, uint64_t>>& counts) {
  std::string bytes(kCheckpointMagic);
  append_bytes(bytes, kWordOrderMark);
  append_bytes(bytes, kVersion);
  const size_t place_of_size = bytes.size();
  append_bytes(bytes, uint64_t{0});
  append_name(bytes, head.fingerprint);
  append_bytes(bytes, uint64_t{head.integers.size()});
  for (const auto& [name, value] : head.integers) {
    append_name(bytes, name);
    append_bytes(bytes, value);
  }
  append_bytes(bytes, uint64_t{counts.size()});
  CheckpointLayout layout;
  layout.head = std::move(head);
  for (const auto& [name, count] : counts) {
    append_name(bytes, name);
    append_bytes(bytes, count);
    const uint64_t position = layout.size + bytes.size();
    layout.arrays.push_back({name, count, position, std::move(bytes)});
    layout.size = position + count * sizeof(double);
    bytes.clear();
  }
  ASPIC_CHECK(!layout.arrays.empty());
  layout.size += kChecksumSize;
  std::memcpy(layout.arrays[0].before.data() + place_of_size, &layout.size, sizeof(layout.size));
  return layout;
}

CheckpointLayout read_checkpoint_layout(const fs::path& path) { return LayoutReader(path).read(); }

uint32_t checkpoint_checksum(const void* bytes, size_t count) {
  return checksum({static_cast<const char*>(bytes), count});
}

uint32_t joined_checksum(uint32_t first, uint32_t second, uint64_t bytes_of_second) {
  return static_cast<uint32_t>(crc32_combine(first, second, static_cast<z_off_t>(bytes_of_second)));
}

const std::vector<double>* Checkpoint::find(std::string_view name) const {
  for (const auto& [key, values] : arrays)
    if (key == name) return &values;
  return nullptr;
}

const std::vector<double>& Checkpoint::array(std::string_view name) const {
  if (const std::vector<double>* values = find(name)) return *values;
  throw InvalidInput("the checkpoint has no array '" + std::string(name) + "'");
}

int64_t Checkpoint::integer(std::string_view name) const {
  for (const auto& [key, value] : integers) {
    if (key == name) return value;
  }
  throw InvalidInput("the checkpoint has no integer '" + std::string(name) + "'");
}

fs::path previous_checkpoint(const fs::path& path) {
  return path.parent_path() / (path.stem().string() + ".previous" + path.extension().string());
}

void write_checkpoint(const fs::path& path, const Checkpoint& checkpoint) {
  keep_previous_checkpoint(path);
  write_file(path, encoded(checkpoint));
}

void keep_previous_checkpoint(const fs::path& path) {
  std::error_code error;
  if (fs::exists(path, error)) keep_as(path, previous_checkpoint(path));
}

Checkpoint read_checkpoint(const fs::path& path) {
  const std::string bytes = read_file(path);
  return Decoder(path, bytes).decode();
}

NewestCheckpoint read_newest_checkpoint(const fs::path& path) {
  std::string reason;
  try {
    return {read_checkpoint(path), ""};
  } catch (const InvalidInput& error) {
    reason = error.what();
  }
  const fs::path previous = previous_checkpoint(path);
  try {
    return {read_checkpoint(previous), reason + "; continuing from " + previous.filename().string()};
  } catch (const InvalidInput& error) {
    throw InvalidInput("no readable checkpoint: " + reason + "; " + error.what());
  }
}

std::string fingerprint(std::string_view text) {
  Fnv1a hash;
  hash.add(text.data(), text.size());
  return hex_digits(hash.value());
}

}  // namespace aspic

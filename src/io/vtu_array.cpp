#include "io/vtu_array.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/free_memory.h"
#include "base/number_chars.h"
#include "io/base64.h"

namespace aspic {
namespace {

constexpr size_t kMaxDeflateRatio = 1032;  // limit of deflate [zlib, technical details]

// Bytes of an array, plain or base64, read sequentially.
class ArrayByteSource {
 public:
  ArrayByteSource(std::string_view text, bool base64) : text_(text), base64_(base64) {}

  bool can_hold(size_t count) const { return count <= spare_.size() + (base64_ ? text_.size() / 4 * 3 : text_.size()); }

  size_t left() const { return text_.size(); }

  bool take(size_t count, std::string& bytes) {
    if (!can_hold(count)) return false;
    if (!base64_) {
      bytes.append(text_.substr(0, count));
      text_.remove_prefix(count);
      return true;
    }
    if (spare_.size() < count && !decode_base64(text_, count - spare_.size(), spare_)) return false;
    if (spare_.size() < count) return false;
    bytes.append(spare_, 0, count);
    spare_.erase(0, count);
    return true;
  }

 private:
  std::string_view text_;
  bool base64_;
  std::string spare_;  // decoded but not consumed
};

class ArrayReader {
 public:
  ArrayReader(const VtkFile& file, const XmlElement& array, ArrayByteSource source, bool is_appended)
      : file_(file), array_(array), source_(std::move(source)), is_appended_(is_appended) {}

  // Arrays of <AppendedData> share its bytes; each byte is counted once.
  std::string read(size_t size) {
    const size_t before = source_.left();
    std::string bytes = file_.compressed ? read_blocks(size) : read_plain(size);
    if (const size_t taken = before - source_.left(); is_appended_) {
      if (taken > file_.appended_left) fail_at(file_, array_, "the arrays of <AppendedData> overlap");
      file_.appended_left -= taken;
    }
    return bytes;
  }

 private:
  uint64_t read_header() {
    std::string bytes;
    if (!source_.take(file_.header_size, bytes)) fail_at(file_, array_, "the data ends in its header");
    if (file_.swapped) std::reverse(bytes.begin(), bytes.end());
    if (file_.header_size == 4) {
      uint32_t value;
      std::memcpy(&value, bytes.data(), 4);
      return value;
    }
    uint64_t value;
    std::memcpy(&value, bytes.data(), 8);
    return value;
  }

  std::string read_plain(size_t size) {
    const uint64_t stated = read_header();
    if (stated != size) fail_size(stated, size);
    std::string bytes;
    if (!source_.take(size, bytes)) fail_at(file_, array_, "the data is cut short or damaged");
    return bytes;
  }

  // [blocks][size of a block][size of the last block, 0: full][compressed size of each block] blocks
  std::string read_blocks(size_t size) {
    const uint64_t blocks = read_header(), block_size = read_header(), last_size = read_header();
    const uint64_t full_blocks = last_size > 0 && blocks > 0 ? blocks - 1 : blocks;
    if (!source_.can_hold(blocks) || (full_blocks > 0 && block_size > size / full_blocks) || last_size > size) {
      fail_at(file_, array_, "the compressed blocks do not fit the size of the data");
    }
    const uint64_t stated = full_blocks * block_size + (blocks > full_blocks ? last_size : 0);
    if (stated != size) fail_size(stated, size);
    std::vector<uint64_t> compressed_size;
    for (uint64_t i = 0; i < blocks; ++i) compressed_size.push_back(read_header());
    std::string bytes;
    for (uint64_t i = 0; i < blocks; ++i)
      inflate_block(compressed_size[i], i < full_blocks ? block_size : last_size, bytes);
    return bytes;
  }

  void inflate_block(uint64_t compressed_size, uint64_t size, std::string& bytes) {
    std::string block;
    if (!source_.take(compressed_size, block)) fail_at(file_, array_, "the data is cut short or damaged");
    if (size / kMaxDeflateRatio > compressed_size) fail_at(file_, array_, "a compressed block is too short");
    const size_t start = bytes.size();
    bytes.resize(start + size);
    uLongf inflated = size;
    const int result = uncompress(reinterpret_cast<Bytef*>(bytes.data() + start), &inflated,
                                  reinterpret_cast<const Bytef*>(block.data()), block.size());
    if (result != Z_OK || inflated != size) fail_at(file_, array_, "a compressed block is damaged");
  }

  [[noreturn]] void fail_size(uint64_t stated, size_t size) const {
    fail_at(file_, array_, "holds " + std::to_string(stated) + " bytes where " + std::to_string(size) + " are needed");
  }

  const VtkFile& file_;
  const XmlElement& array_;
  ArrayByteSource source_;
  bool is_appended_;
};

template <class Stored, class Number>
std::vector<Number> convert(const std::string& bytes, bool swapped) {
  std::vector<Number> numbers(bytes.size() / sizeof(Stored));
  for (size_t i = 0; i < numbers.size(); ++i) {
    char raw[sizeof(Stored)];
    std::memcpy(raw, bytes.data() + i * sizeof(Stored), sizeof(Stored));
    if (swapped) std::reverse(raw, raw + sizeof(Stored));
    Stored stored;
    std::memcpy(&stored, raw, sizeof(Stored));
    numbers[i] = static_cast<Number>(stored);  // NOLINT(bugprone-signed-char-misuse): an Int8 is signed
  }
  return numbers;
}

template <class Number>
std::vector<Number> parse_ascii(const VtkFile& file, const XmlElement& array, size_t count) {
  const char* next = array.text.data();
  const char* const end = next + array.text.size();
  if (count > (array.text.size() + 1) / 2)
    fail_at(file, array, "fewer numbers than the " + std::to_string(count) + " needed");
  const auto skip_blanks = [&] {
    while (next < end && (*next == ' ' || *next == '\t' || *next == '\n' || *next == '\r')) ++next;
  };
  std::vector<Number> numbers(count);
  for (size_t i = 0; i < count; ++i) {
    skip_blanks();
    const auto [after, error] = from_chars(next, end, numbers[i]);
    if (error != std::errc()) fail_at(file, array, "number " + std::to_string(i + 1) + " cannot be read");
    next = after;
  }
  skip_blanks();
  if (next != end) fail_at(file, array, "more than the " + std::to_string(count) + " numbers needed");
  return numbers;
}

std::string array_bytes(const VtkFile& file, const XmlElement& array, size_t size) {
  const std::string* format = array.attribute("format");
  if (format && *format == "binary")
    return ArrayReader(file, array, ArrayByteSource(array.text, true), false).read(size);
  if (!format || *format != "appended") fail_at(file, array, "its format is not ascii, binary or appended");
  if (!file.has_appended) fail_at(file, array, "its data is missing: the file has no <AppendedData>");
  const int64_t offset = count_attribute(file, array, "offset", 0, static_cast<int64_t>(file.appended.size()));
  const ArrayByteSource source(file.appended.substr(static_cast<size_t>(offset)), file.appended_base64);
  return ArrayReader(file, array, source, true).read(size);
}

template <class Number>
struct StoredType {
  std::string_view name;
  size_t size;
  std::vector<Number> (*convert)(const std::string& bytes, bool swapped);
};

// Compressed data may expand a thousandfold, so the free memory is checked first.
void check_memory(const VtkFile& file, const XmlElement& array, size_t count) {
  constexpr size_t kFew = size_t{1} << 20;
  if (count < kFew) return;
  const size_t available = static_cast<size_t>(free_memory()) / (sizeof(double) + sizeof(double));  // stored, converted
  if (count > available)
    fail_at(file, array,
            std::to_string(count) + " numbers; there is memory for " + std::to_string(available) +
                " (use a smaller file, or a machine with more)");
}

template <class Number>
std::vector<Number> read_array(const VtkFile& file, const XmlElement& array, size_t count) {
  static constexpr StoredType<Number> kTypes[] = {
      {"Float64", 8, convert<double, Number>}, {"Float32", 4, convert<float, Number>},
      {"Int64", 8, convert<int64_t, Number>},  {"UInt64", 8, convert<uint64_t, Number>},
      {"Int32", 4, convert<int32_t, Number>},  {"UInt32", 4, convert<uint32_t, Number>},
      {"Int16", 2, convert<int16_t, Number>},  {"UInt16", 2, convert<uint16_t, Number>},
      {"Int8", 1, convert<int8_t, Number>},    {"UInt8", 1, convert<uint8_t, Number>}};
  if (count == 0) return {};
  const std::string* name = array.attribute("type");
  const auto type =
      std::find_if(std::begin(kTypes), std::end(kTypes), [&](const auto& t) { return name && t.name == *name; });
  if (type == std::end(kTypes)) fail_at(file, array, "unknown number type '" + (name ? *name : "") + "'");
  if (std::is_integral_v<Number> && type->name.starts_with("Float")) fail_at(file, array, "integers are needed");
  if (const std::string* format = array.attribute("format"); !format || *format == "ascii") {
    return parse_ascii<Number>(file, array, count);
  }
  check_memory(file, array, count);
  return type->convert(array_bytes(file, array, count * type->size), file.swapped);
}

}  // namespace

void fail_at(const VtkFile& file, const XmlElement& element, const std::string& what) {
  const std::string* name = element.attribute("Name");
  throw InvalidInput(file.name + ":" + std::to_string(element.line) + ": " + (name ? "array '" + *name + "': " : "") +
                     what);
}

int64_t count_attribute(const VtkFile& file, const XmlElement& element, std::string_view name, int64_t fallback,
                        int64_t limit) {
  const std::string* text = element.attribute(name);
  if (!text) return fallback;
  int64_t value = -1;
  const auto [after, error] = from_chars(text->data(), text->data() + text->size(), value);
  if (error != std::errc() || after != text->data() + text->size() || value < 0 || value > limit) {
    fail_at(file, element, std::string(name) + " = '" + *text + "' is not a number from 0 to " + std::to_string(limit));
  }
  return value;
}

VtkFile vtk_file(const XmlElement& root, std::string_view type, std::string name) {
  VtkFile file;
  file.name = std::move(name);
  const auto value = [&](std::string_view key) { return root.attribute(key) ? *root.attribute(key) : std::string(); };
  if (root.name != "VTKFile" || value("type") != type) {
    fail_at(file, root,
            "not a VTK file of type " + std::string(type) + (root.name == "VTKFile" ? " but " + value("type") : ""));
  }
  if (const std::string order = value("byte_order"); !order.empty()) {
    if (order != "LittleEndian" && order != "BigEndian") fail_at(file, root, "unknown byte_order '" + order + "'");
    file.swapped = (order == "LittleEndian") != (std::endian::native == std::endian::little);
  }
  if (const std::string header = value("header_type"); !header.empty()) {
    if (header != "UInt32" && header != "UInt64") fail_at(file, root, "unknown header_type '" + header + "'");
    file.header_size = header == "UInt64" ? 8 : 4;
  }
  if (const std::string compressor = value("compressor"); !compressor.empty()) {
    if (compressor != "vtkZLibDataCompressor")
      fail_at(file, root, compressor + " is not supported (write with vtkZLibDataCompressor or none)");
    file.compressed = true;
  }
  if (const XmlElement* appended = root.child("AppendedData")) {
    const std::string* encoding = appended->attribute("encoding");
    if (!encoding || (*encoding != "raw" && *encoding != "base64"))
      fail_at(file, *appended, "its encoding is not raw or base64");
    const size_t start = appended->text.find('_');
    if (start == std::string_view::npos) fail_at(file, *appended, "the underscore before the data is missing");
    file.appended = appended->text.substr(start + 1);
    file.appended_base64 = *encoding == "base64";
    file.appended_left = file.appended.size();
    file.has_appended = true;
  }
  return file;
}

std::vector<double> read_reals(const VtkFile& file, const XmlElement& array, size_t count) {
  return read_array<double>(file, array, count);
}

std::vector<int64_t> read_integers(const VtkFile& file, const XmlElement& array, size_t count) {
  return read_array<int64_t>(file, array, count);
}

}  // namespace aspic

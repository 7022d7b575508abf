// Reads the numbers of a .msh section from text or binary.
#pragma once
#include <bit>
#include <string>
#include <string_view>

#include "io/byte_cursor.h"
#include "io/text_scanner.h"

namespace aspic {

enum class GmshData { text, little_endian, big_endian };

class GmshSource {
 public:
  GmshSource(const std::string& file, std::string_view contents, size_t position, GmshData data)
      : is_binary_(data != GmshData::text),
        text_(file, contents, TextScanner::kNoComments),
        bytes_(file, contents, position, data == GmshData::big_endian ? std::endian::big : std::endian::little) {
    text_.seek(position);
  }

  // Gmsh types: "int", 4 bytes; "size_t", 8 bytes; "double", 8 bytes.
  int integer(std::string_view what) { return is_binary_ ? bytes_.read<int32_t>(what) : text_.small_integer(what); }
  int64_t size(std::string_view what) { return is_binary_ ? bytes_.read<int64_t>(what) : text_.integer(what); }
  double number(std::string_view what) { return is_binary_ ? bytes_.finite<double>(what) : text_.number(what); }

  void skip_integers(int64_t count, std::string_view what) { skip(count, sizeof(int32_t), what); }
  void skip_sizes(int64_t count, std::string_view what) { skip(count, sizeof(int64_t), what); }
  void skip_numbers(int64_t count, std::string_view what) { skip(count, sizeof(double), what); }

  // Checks that `value` items, each of at least `words` words of text or `bytes` bytes of binary, fit into the rest.
  int checked_count(int64_t value, std::string_view what, size_t words, size_t bytes) const {
    return is_binary_ ? bytes_.checked_count(value, what, bytes) : text_.checked_count(value, what, 2 * words);
  }

  [[noreturn]] void fail(std::string_view message) const { is_binary_ ? bytes_.fail(message) : text_.fail(message); }
  bool is_binary() const { return is_binary_; }
  size_t position() const { return is_binary_ ? bytes_.position() : text_.position(); }

 private:
  void skip(int64_t count, size_t bytes, std::string_view what) {
    const int checked = checked_count(count, what, 1, bytes);
    if (is_binary_)
      bytes_.skip(static_cast<uint64_t>(checked) * bytes, what);
    else
      for (int i = 0; i < checked; ++i) text_.word(what);
  }

  bool is_binary_;
  TextScanner text_;
  ByteCursor bytes_;
};

}  // namespace aspic

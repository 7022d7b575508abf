// Reads numbers from the binary part of a file in memory. Every error is an InvalidInput "file: byte N: problem;
// remedy".
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace aspic {

class ByteCursor {
 public:
  // The bytes must outlive the cursor.
  ByteCursor(std::string file, std::string_view bytes, size_t position, std::endian order = std::endian::little)
      : file_(std::move(file)), bytes_(bytes), position_(position), order_(order) {}

  // `what` names the expected number in the message of an error.
  template <class T>
  T read(std::string_view what) {
    static_assert(std::is_arithmetic_v<T>);
    require(sizeof(T), what);
    char raw[sizeof(T)];
    for (size_t i = 0; i < sizeof(T); ++i)
      raw[i] = bytes_[position_ + (order_ == std::endian::native ? i : sizeof(T) - 1 - i)];
    position_ += sizeof(T);
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

  template <class T>
  double finite(std::string_view what) {
    return checked_finite(static_cast<double>(read<T>(what)), what);
  }

  // Checks that `value` items of at least `bytes` bytes each fit into the rest of the file, so that memory can be
  // reserved.
  int checked_count(int64_t value, std::string_view what, size_t bytes) const;
  double checked_finite(double value, std::string_view what) const;

  void skip(uint64_t bytes, std::string_view what);
  [[noreturn]] void fail(std::string_view message) const;

  size_t position() const { return position_; }
  size_t remaining() const { return bytes_.size() - position_; }

 private:
  void require(uint64_t bytes, std::string_view what) const;

  std::string file_;
  std::string_view bytes_;
  size_t position_;
  std::endian order_;
};

}  // namespace aspic

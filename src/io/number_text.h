// Numbers as text and bytes that read back to the same bits, independent of the locale.
#pragma once
#include <bit>
#include <cstring>
#include <string>

#include "base/number_chars.h"
#include "math/small.h"

namespace aspic {

static_assert(std::endian::native == std::endian::little, "files are written in the order of the machine's bytes");

// Shortest decimal text that reads back to `value`.
template <class T>
void append_number(std::string& text, T value) {
  char digits[32];
  text.append(digits, to_chars(digits, digits + sizeof(digits), value).ptr);
}

// "x y z"
inline void append_point(std::string& text, const Vec3d& point) {
  append_number(text, point[0]);
  text += ' ';
  append_number(text, point[1]);
  text += ' ';
  append_number(text, point[2]);
}

// " i j k", each index offset by `first`.
template <class Indices>
void append_indices(std::string& text, const Indices& indices, int first) {
  for (const int index : indices) {
    text += ' ';
    append_number(text, static_cast<long long>(index) + first);
  }
}

// The bytes of `value`, least significant first.
template <class T>
void append_bytes(std::string& bytes, const T& value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

}  // namespace aspic

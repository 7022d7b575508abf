// std::from_chars and std::to_chars. libc++ has neither of them for floating-point numbers; there, the C library reads
// and writes these.
#pragma once
#include <charconv>
#include <string>
#include <type_traits>

namespace aspic {

// As std::from_chars and std::to_chars, by the C library. Require the locale "C".
std::from_chars_result read_number(const char* first, const char* last, double& value);
std::to_chars_result write_number(char* first, char* last, double value);
std::to_chars_result write_number(char* first, char* last, float value);

// Writes the zero before points that begin a number and after points that end one: "[-.5, 1.]" becomes "[-0.5, 1.0]".
std::string with_zeros_beside_points(const std::string& text);

// As std::from_chars.
template <class T>
std::from_chars_result from_chars(const char* first, const char* last, T& value, int base = 10) {
  if constexpr (!std::is_floating_point_v<T>) {
    return std::from_chars(first, last, value, base);
  } else {
#ifdef __cpp_lib_to_chars
    return std::from_chars(first, last, value);
#else
    return read_number(first, last, value);
#endif
  }
}

// As std::to_chars: the shortest text that reads back to `value`.
template <class T>
std::to_chars_result to_chars(char* first, char* last, T value) {
#ifndef __cpp_lib_to_chars
  if constexpr (std::is_floating_point_v<T>) {
    return write_number(first, last, value);
  } else
#endif
  {
    return std::to_chars(first, last, value);
  }
}

}  // namespace aspic

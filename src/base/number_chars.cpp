#include "base/number_chars.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>

namespace aspic {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// End of the longest decimal number at `at`; `at` itself if there is none. The sign has been read.
const char* end_of_decimal(const char* at, const char* last) {
  const auto skip_digits = [last](const char* from) { return std::find_if_not(from, last, is_digit); };
  const char* end = skip_digits(at);
  bool has_digits = end != at;
  if (end != last && *end == '.') {
    const char* fraction = end + 1;
    end = skip_digits(fraction);
    has_digits = has_digits || end != fraction;
  }
  if (!has_digits) return at;
  if (end == last || (*end != 'e' && *end != 'E')) return end;
  const char* exponent = end + 1;
  if (exponent != last && (*exponent == '-' || *exponent == '+')) ++exponent;
  const char* after = skip_digits(exponent);
  return after != exponent ? after : end;
}

// End of "inf", "infinity" or "nan" in any case; `at` itself if there is none.
const char* end_of_word(const char* at, const char* last) {
  for (const char* word : {"infinity", "inf", "nan"}) {
    const std::ptrdiff_t length = static_cast<std::ptrdiff_t>(std::strlen(word));
    const auto same = [](char x, char lower) { return (x | 0x20) == lower; };
    if (last - at >= length && std::equal(word, word + length, at, [&](char w, char x) { return same(x, w); }))
      return at + length;
  }
  return at;
}

// Shortest scientific text that `reads_back`, among 1 to `most` digits.
template <class T>
std::string shortest(T value, int most, T (*read)(const char*, char**)) {
  char text[40];
  for (int digits = 0; digits < most; ++digits) {
    std::snprintf(text, sizeof text, "%.*e", digits, static_cast<double>(value));
    if (read(text, nullptr) == value) break;
  }
  return text;
}

template <class T>
std::to_chars_result write(char* first, char* last, T value, int most, T (*read)(const char*, char**)) {
  char text[400];
  if (std::isfinite(value)) {
    const std::string scientific = shortest(value, most, read);
    const size_t e = scientific.find('e');
    const int exponent = std::atoi(scientific.c_str() + e + 1);
    const size_t mantissa = scientific.find('.');
    const int decimals = mantissa == scientific.npos ? 0 : static_cast<int>(e - mantissa - 1);
    std::snprintf(text, sizeof text, "%.*f", std::max(0, decimals - exponent), static_cast<double>(value));
    if (scientific.size() < std::strlen(text)) std::strcpy(text, scientific.c_str());
  } else {
    std::strcpy(text, std::isnan(value) ? (std::signbit(value) ? "-nan" : "nan") : value < 0 ? "-inf" : "inf");
  }
  const size_t length = std::strlen(text);
  if (static_cast<size_t>(last - first) < length) return {last, std::errc::value_too_large};
  return {std::copy(text, text + length, first), std::errc()};
}

}  // namespace

std::string with_zeros_beside_points(const std::string& text) {
  constexpr std::string_view kBefore = "-+[,= ", kAfter = "eE,]} ", kDigits = "0123456789";
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    const size_t begin = i == 0 ? text.npos : text.find_last_not_of(kDigits, i - 1);  // the last character before
    const size_t end = std::min(text.find_first_not_of(kDigits, i + 1), text.size());
    const bool is_point = text[i] == '.' && (begin == text.npos || kBefore.find(text[begin]) != kBefore.npos) &&
                          (end == text.size() || kAfter.find(text[end]) != kAfter.npos);
    const bool has_digits_before = i > 0 && begin != i - 1, has_digits_after = end > i + 1;
    if (is_point && !has_digits_before && has_digits_after) result += '0';
    result += text[i];
    if (is_point && has_digits_before && !has_digits_after) result += '0';
  }
  return result;
}

std::from_chars_result read_number(const char* first, const char* last, double& value) {
  const char* start = first != last && *first == '-' ? first + 1 : first;
  const char* end = end_of_decimal(start, last);
  const bool is_decimal = end != start;
  if (!is_decimal) end = end_of_word(start, last);
  if (end == start) return {first, std::errc::invalid_argument};
  const std::string text(first, end);
  const double read = std::strtod(text.c_str(), nullptr);
  const bool has_digits =
      std::any_of(text.begin(), std::find_if(text.begin(), text.end(), [](char c) { return (c | 0x20) == 'e'; }),
                  [](char c) { return c >= '1' && c <= '9'; });
  if (is_decimal && (std::isinf(read) || (read == 0 && has_digits))) return {end, std::errc::result_out_of_range};
  value = read;
  return {end, std::errc()};
}

std::to_chars_result write_number(char* first, char* last, double value) {
  return write(first, last, value, 17, std::strtod);
}

std::to_chars_result write_number(char* first, char* last, float value) {
  return write(first, last, value, 9, std::strtof);
}

}  // namespace aspic

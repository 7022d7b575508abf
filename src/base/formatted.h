// Formats numbers in messages with printf.
#pragma once
#include <cstdio>
#include <string>

namespace aspic {

template <class... Numbers>
std::string formatted(const char* format, Numbers... numbers) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, format, numbers...);
  return buffer;
}

inline std::string three_digits(double x) { return formatted("%.3g", x); }
inline std::string six_digits(double x) { return formatted("%.6g", x); }

}  // namespace aspic

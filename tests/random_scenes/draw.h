// Random draws that are equal on every machine, unlike the distributions of the standard library.
#pragma once
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>

namespace aspic {

std::string shortest(double x);  // shortest text that reads back to x

class Draw {
 public:
  explicit Draw(uint64_t seed) : bits_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  int integer(int low, int high) { return low + static_cast<int>(bits_() % static_cast<uint64_t>(high - low + 1)); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  template <class T>
  T one_of(std::initializer_list<T> choices) {
    return choices.begin()[integer(0, static_cast<int>(choices.size()) - 1)];
  }
  // Random number as a text of few digits.
  std::string number(double low, double high) { return shortest(std::round(uniform(low, high) * 1000) / 1000); }
  std::string size(double low, double high) { return shortest(rounded(logarithmic(low, high))); }
  std::string vector(double length) {
    return "[" + number(-length, length) + ", " + number(-length, length) + ", " + number(-length, length) + "]";
  }

 private:
  static double rounded(double x) {
    const double unit = std::pow(10, std::floor(std::log10(x)) - 2);
    return std::round(x / unit) * unit;
  }

  std::mt19937_64 bits_;
};

}  // namespace aspic

#include "base/number_chars.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

namespace aspic {
namespace {

template <class T, class Write>
std::string text_of(T value, Write write) {
  char text[400];
  return {text, write(text, text + sizeof text, value).ptr};
}

// Ties between the decimal texts of one length may be broken differently; the length and the value are the same.
template <class T>
void expect_standard_text(T value) {
  const std::string expected = text_of(value, [](char* a, char* b, T x) { return std::to_chars(a, b, x); });
  const std::string found = text_of(value, [](char* a, char* b, T x) { return write_number(a, b, x); });
  if (found == expected) return;
  T read = 0;
  EXPECT_EQ(std::from_chars(found.data(), found.data() + found.size(), read).ptr, found.data() + found.size()) << found;
  EXPECT_EQ(read, value) << found;
  EXPECT_EQ(found.size(), expected.size()) << found << " for " << expected;
}

TEST(NumberChars, WritesTheTextOfTheStandardLibrary) {
  for (const double x : {0.0,
                         -0.0,
                         1.0,
                         -1.5,
                         5e3,
                         1e4,
                         1e5,
                         123456.0,
                         0.1,
                         1e-3,
                         1e-5,
                         1.0 / 3,
                         1e21,
                         1e22,
                         1e23,
                         9007199254740993.0,
                         123456789012345678.0,
                         5e-324,
                         std::numeric_limits<double>::max(),
                         std::numeric_limits<double>::infinity(),
                         -std::numeric_limits<double>::infinity()})
    EXPECT_EQ(text_of(x, [](char* a, char* b, double v) { return write_number(a, b, v); }),
              text_of(x, [](char* a, char* b, double v) { return std::to_chars(a, b, v); }));
}

TEST(NumberChars, WritesShortestTextsOfRandomNumbers) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 5000; ++i) {
    const double x = std::bit_cast<double>(random());
    if (std::isfinite(x)) expect_standard_text(x);
    const float y = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (std::isfinite(y)) expect_standard_text(y);
    expect_standard_text(std::ldexp(static_cast<double>(random() >> 40), static_cast<int>(random() % 40) - 30));
  }
}

TEST(NumberChars, ReportsShortBuffers) {
  char text[3];
  EXPECT_EQ(write_number(text, text + 3, 0.125).ec, std::errc::value_too_large);
  EXPECT_EQ(write_number(text, text + 3, 0.5).ec, std::errc());
}

TEST(NumberChars, ReadsLikeTheStandardLibrary) {
  for (const std::string text : {"",       "-",        "+1",
                                 " 1",     "1",        "-1.5",
                                 ".5",     "5.",       ".",
                                 "-.e1",   "1e",       "1e+",
                                 "1e5x",   "0x10",     "1.5.2",
                                 "inf",    "-INF",     "inFx",
                                 "in",     "1e400",    "-1e400",
                                 "1e-400", "0e999999", "0.0e-9999",
                                 "--1",    "1,5",      "1e5",
                                 "2.5E-3", "infinity", "infin",
                                 "nan",    "1e-310",   "0.30000000000000004",
                                 "1_000"}) {
    double expected = 7, found = 7;
    const auto known = std::from_chars(text.data(), text.data() + text.size(), expected);
    const auto result = read_number(text.data(), text.data() + text.size(), found);
    EXPECT_EQ(result.ptr, known.ptr) << text;
    EXPECT_EQ(result.ec, known.ec) << text;
    EXPECT_TRUE(found == expected || (std::isnan(found) && std::isnan(expected))) << text;
  }
}

TEST(NumberChars, PointsBesideOneDigitGetAZero) {
  EXPECT_EQ(with_zeros_beside_points("-.5,.25,1.5"), "-0.5,0.25,1.5");
  EXPECT_EQ(with_zeros_beside_points("[.1, +.2e-3]"), "[0.1, +0.2e-3]");
  EXPECT_EQ(with_zeros_beside_points("[5., -10.]"), "[5.0, -10.0]");
  EXPECT_EQ(with_zeros_beside_points("1.e-3"), "1.0e-3");
  for (const char* text : {".", "./.5.obj", "a.5", "1..5", ".5.obj", "part5.", "5.obj", "1.2.", "2.*X", "-", ""})
    EXPECT_EQ(with_zeros_beside_points(text), text);
}

}  // namespace
}  // namespace aspic

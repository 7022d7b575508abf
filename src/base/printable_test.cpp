#include "base/printable.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace aspic {
namespace {

TEST(Printable, KeepsTextOfAnyLanguage) {
  for (const char* text : {"", "young = 1e5",
                           "b\xc3\xbc"
                           "chse",
                           "\xe8\x82\x9d\xe8\x87\x93", "\xf0\x9f\xab\x80", "a\\b"}) {
    EXPECT_TRUE(is_printable(text)) << text;
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, EscapesTerminalControlCharacters) {
  EXPECT_EQ(printable("\x1b[31mred"), "\\x1B[31mred");
  EXPECT_EQ(printable("two\r\nlines\t"), "two\\x0D\\x0Alines\\x09");
  EXPECT_EQ(printable("\x7f"), "\\x7F");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\xC2\\x9B31m");  // U+009B begins an escape sequence, too
}

TEST(Printable, EscapesInvalidUtf8) {
  EXPECT_EQ(printable("stra\xdf"
                      "e"),
            "stra\\xDFe");                                           // Latin-1
  EXPECT_EQ(printable("\xc3"), "\\xC3");                             // cut short
  EXPECT_EQ(printable("\xe2\x82"), "\\xE2\\x82");                    // cut short
  EXPECT_EQ(printable("\xc0\xaf"), "\\xC0\\xAF");                    // overlong encoding
  EXPECT_EQ(printable("\xe0\x80\xaf"), "\\xE0\\x80\\xAF");           // overlong encoding
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xED\\xA0\\x80");           // half of a surrogate pair
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xF4\\x90\\x80\\x80");  // above U+10FFFF
}

TEST(Printable, EscapesDirectionAndLineSeparators) {
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "b"),
            "a\\xE2\\x80\\xAE"
            "b");  // U+202E: right-to-left override
  EXPECT_EQ(printable("a\xe2\x80\xa8"
                      "b"),
            "a\\xE2\\x80\\xA8"
            "b");  // U+2028: line separator
}

TEST(Printable, KeepsLineBreaks) {
  EXPECT_EQ(printable_lines("a\x1b\n\nb\t"), "a\\x1B\n\nb\\x09");
  EXPECT_EQ(printable_lines("a\n"), "a\n");
}

TEST(Printable, EscapesEveryPairOfBytes) {
  for (int a = 0; a < 256; ++a)
    for (int b = 0; b < 256; ++b) {
      const std::string text = {static_cast<char>(a), static_cast<char>(b)};
      ASSERT_TRUE(is_printable(printable(text))) << a << " " << b;
      ASSERT_EQ(is_printable(text), printable(text) == text) << a << " " << b;
    }
}

TEST(Shortened, CutsBetweenEscapedCharacters) {
  EXPECT_EQ(shortened("0123456789", 10), "0123456789");
  EXPECT_EQ(shortened("0123456789a", 10), "0123456...");
  EXPECT_EQ(shortened("01234\xc3\xbc\xc3\xbc\xc3\xbc", 10), "01234\xc3\xbc...");
  EXPECT_EQ(shortened("01234\x1b[31m", 10), "01234...");  // never splits "\x1B"
  EXPECT_EQ(shown("\x1b]0;\a"), "'\\x1B]0;\\x07'");
}

TEST(Elided, KeepsBeginningAndEnd) {
  const std::string text = elided("place: " + std::string(5000, 'a') + "\x1b; remedy", 100);
  EXPECT_LE(text.size(), 100u);
  EXPECT_TRUE(text.starts_with("place: aaa")) << text;
  EXPECT_TRUE(text.ends_with("a\\x1B; remedy")) << text;
  EXPECT_EQ(elided("short", 100), "short");
  for (size_t cut = 0; cut < 4; ++cut) {  // for every position of the cut within a character
    std::string many;
    for (int i = 0; i < 500; ++i) many += "\xf0\x9f\xab\x80";
    EXPECT_TRUE(is_printable(elided(many + std::string(cut, 'a'), 100)));
  }
}

TEST(InvalidInput, IsOneLineForAnyQuotedText) {
  EXPECT_STREQ(InvalidInput("mesh.obj:1: 'a\nb\x1b'").what(), "mesh.obj:1: 'a\\x0Ab\\x1B'");
  EXPECT_LE(std::string(InvalidInput(std::string(1 << 20, 'a')).what()).size(), InvalidInput::kLongestMessage);
}

TEST(InvalidInput, HasOneLinePerMessage) {
  EXPECT_STREQ(InvalidInput(std::vector<std::string>{"one", "t\nwo"}).what(), "one\nt\\x0Awo");
}

}  // namespace
}  // namespace aspic

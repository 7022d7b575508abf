// Reads words and numbers of a text in memory, independent of the locale. Every error is an InvalidInput "file:line:
// problem; remedy".
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/printable.h"

namespace aspic {

// Converts the whole word to a number; empty if it is invalid, not finite or out of range.
std::optional<double> parse_number(std::string_view word);
std::optional<int64_t> parse_integer(std::string_view word);

class TextScanner {
 public:
  static constexpr char kNoComments = '\0';

  // A comment extends from the character `comment` to the end of its line. The text must outlive the scanner.
  TextScanner(std::string file, std::string_view text, char comment);

  bool at_end();                                // only blanks and comments remain
  bool at_line_end();                           // only blanks and a comment remain on this line
  void require_on_line(std::string_view what);  // throws if the line has ended
  void skip_line();                             // moves to the beginning of the next line

  // `what` names the expected item in the message of an error.
  std::string_view word(std::string_view what);
  std::string_view quoted(std::string_view what);  // a word, or the text between quotes, which may contain blanks
  std::string_view peek();                         // next word without consuming it; empty at the end
  double number(std::string_view what);
  int64_t integer(std::string_view what);
  int small_integer(std::string_view what);  // an integer in the range of int
  // Reads a count of items that take at least `bytes` bytes each. Throws if they cannot fit into the rest of the text,
  // so that memory can be reserved.
  int count(std::string_view what, size_t bytes);
  int checked_count(int64_t value, std::string_view what, size_t bytes) const;  // the same for a value already read
  int index(std::string_view what, int first, int count);  // in [first, first + count); returned counting from 0

  [[noreturn]] void fail(std::string_view message) const;  // at the last word read

  const std::string& file() const { return file_; }
  std::string_view text() const { return text_; }
  size_t position() const { return position_; }
  void seek(size_t position) { position_ = position; }
  size_t word_position() const { return word_begin_; }     // position of the last word read
  void blame(size_t position) { word_begin_ = position; }  // sets the line that fail() reports

 private:
  bool is_continued_line() const;
  void skip_blanks();
  void skip_blank_lines();

  std::string file_;
  std::string_view text_;
  char comment_;
  size_t position_ = 0, word_begin_ = 0;
};

}  // namespace aspic

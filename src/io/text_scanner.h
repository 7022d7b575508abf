// Words and numbers of a text that is held whole in memory. Independent of the locale.
// Every error is an InvalidInput "file:line: what is wrong; remedy".
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/printable.h"

namespace aspic {

// The whole of `word` as a number; nothing when it is not one, or not finite, or out of range.
std::optional<double> parse_number(std::string_view word);
std::optional<int64_t> parse_integer(std::string_view word);

class TextScanner {
 public:
  static constexpr char kNoComments = '\0';

  // A comment begins with the character `comment` and lasts to the end of its line. The text must outlive the scanner.
  TextScanner(std::string file, std::string_view text, char comment);

  bool at_end();                                // nothing but blanks and comments is left
  bool at_line_end();                           // nothing but blanks and a comment is left on this line
  void require_on_line(std::string_view what);  // fails where the line has ended
  void skip_line();                             // to the beginning of the next line

  // `what` names the thing expected, for the message when it is not there.
  std::string_view word(std::string_view what);
  std::string_view peek();  // the next word without taking it; empty at the end
  double number(std::string_view what);
  int64_t integer(std::string_view what);
  int small_integer(std::string_view what);  // one that fits an int
  // A number of things that each take at least `bytes` bytes of this text: what cannot follow is an error, so memory
  // may be reserved for it.
  int count(std::string_view what, size_t bytes);
  int checked_count(int64_t value, std::string_view what, size_t bytes) const;  // the same for a value already read
  int index(std::string_view what, int first, int count);  // in [first, first + count), returned from 0

  [[noreturn]] void fail(std::string_view message) const;  // at the last word taken

  const std::string& file() const { return file_; }
  std::string_view text() const { return text_; }
  size_t position() const { return position_; }
  void seek(size_t position) { position_ = position; }
  size_t word_position() const { return word_begin_; }     // of the last word taken
  void blame(size_t position) { word_begin_ = position; }  // fail() will name the line of this position

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

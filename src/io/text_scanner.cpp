#include "io/text_scanner.h"

#include <algorithm>
#include <climits>
#include <cmath>

#include "base/error.h"
#include "base/number_chars.h"

namespace aspic {
namespace {

bool is_blank_in_line(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// std::from_chars accepts no leading plus.
std::string_view without_plus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

}  // namespace

std::optional<double> parse_number(std::string_view word) {
  word = without_plus(word);
  double value = 0;
  const auto [end, error] = from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return std::nullopt;
  // Underflow gives zero; overflow is an error.
  if (error == std::errc::result_out_of_range && word.find_first_of("eE") != word.npos && word.rfind('-') > 0 &&
      word.rfind('-') != word.npos)
    return 0.0;
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<int64_t> parse_integer(std::string_view word) {
  word = without_plus(word);
  int64_t value = 0;
  const auto [end, error] = from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

TextScanner::TextScanner(std::string file, std::string_view text, char comment)
    : file_(std::move(file)), text_(text), comment_(comment) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // UTF-8 byte order mark, which some editors write
  if (text_.starts_with(kByteOrderMark)) position_ = kByteOrderMark.size();
}

// A backslash at the end of a line joins it with the next one.
bool TextScanner::is_continued_line() const {
  return text_[position_] == '\\' &&
         (text_.substr(position_ + 1, 1) == "\n" || text_.substr(position_ + 1, 2) == "\r\n");
}

void TextScanner::skip_blanks() {
  for (; position_ < text_.size(); ++position_) {
    const char c = text_[position_];
    if (is_blank_in_line(c)) continue;
    if (c == '\\' && is_continued_line()) {
      position_ = text_.find('\n', position_);
    } else if (c == comment_ && comment_ != kNoComments) {
      position_ = std::min(text_.find('\n', position_), text_.size());
      return;
    } else {
      return;
    }
  }
}

void TextScanner::skip_blank_lines() {
  for (skip_blanks(); position_ < text_.size() && text_[position_] == '\n'; skip_blanks()) ++position_;
}

bool TextScanner::at_end() {
  skip_blank_lines();
  return position_ == text_.size();
}

bool TextScanner::at_line_end() {
  skip_blanks();
  return position_ == text_.size() || text_[position_] == '\n';
}

void TextScanner::require_on_line(std::string_view what) {
  if (at_line_end())
    word_begin_ = position_, fail("the line ends where " + std::string(what) + " should follow; complete it");
}

void TextScanner::skip_line() {
  const size_t end = text_.find('\n', position_);
  position_ = end == text_.npos ? text_.size() : end + 1;
}

std::string_view TextScanner::word(std::string_view what) {
  skip_blank_lines();
  word_begin_ = position_;
  if (position_ == text_.size())
    fail("the file ends where " + std::string(what) + " should follow; it is cut short, get a complete copy");
  for (; position_ < text_.size(); ++position_) {
    const char c = text_[position_];
    if (is_blank_in_line(c) || c == '\n' || (c == comment_ && comment_ != kNoComments) ||
        (c == '\\' && is_continued_line()))
      break;
  }
  return text_.substr(word_begin_, position_ - word_begin_);
}

std::string_view TextScanner::quoted(std::string_view what) {
  const std::string_view first = word(what);
  if (first[0] != '"') return first;
  const size_t begin = word_begin_ + 1, line_end = std::min(text_.find('\n', begin), text_.size());
  const size_t end = text_.find('"', begin);
  if (end >= line_end) fail(std::string(what) + " has no closing quote; complete it");
  position_ = end + 1;
  return text_.substr(begin, end - begin);
}

std::string_view TextScanner::peek() {
  if (at_end()) return {};
  const size_t begin = position_;
  const std::string_view next = word("");
  position_ = begin;
  return next;
}

double TextScanner::number(std::string_view what) {
  const std::string_view next = word(what);
  const auto value = parse_number(next);
  if (!value) fail(std::string(what) + " is " + shown(next) + "; it must be a finite number");
  return *value;
}

int64_t TextScanner::integer(std::string_view what) {
  const std::string_view next = word(what);
  const auto value = parse_integer(next);
  if (!value) fail(std::string(what) + " is " + shown(next) + "; it must be a whole number");
  return *value;
}

int TextScanner::small_integer(std::string_view what) {
  const int64_t value = integer(what);
  if (value < INT_MIN || value > INT_MAX)
    fail(std::string(what) + " is " + std::to_string(value) + "; it must fit 32 bits");
  return static_cast<int>(value);
}

int TextScanner::count(std::string_view what, size_t bytes) { return checked_count(integer(what), what, bytes); }

int TextScanner::checked_count(int64_t value, std::string_view what, size_t bytes) const {
  if (value < 0) fail(std::string(what) + " is " + std::to_string(value) + "; it must not be negative");
  // The last item may lack its line break.
  const size_t most = (text_.size() - position_ + 1) / std::max<size_t>(bytes, 1);
  if (value > INT_MAX || static_cast<size_t>(value) > most)
    fail(std::string(what) + " is " + std::to_string(value) + ", but the rest of the file has room for at most " +
         std::to_string(most) + "; it is cut short or damaged, get a complete copy");
  return static_cast<int>(value);
}

int TextScanner::index(std::string_view what, int first, int count) {
  const int64_t value = integer(what);
  if (value < first || value - first >= count)
    fail(std::string(what) + " is " + std::to_string(value) +
         (count == 0 ? ", but the file has none of these; get a complete copy"
                     : "; it must be from " + std::to_string(first) + " to " +
                           std::to_string(static_cast<int64_t>(first) + count - 1)));
  return static_cast<int>(value - first);
}

void TextScanner::fail(std::string_view message) const {
  const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<ptrdiff_t>(word_begin_), '\n');
  throw InvalidInput(file_ + ":" + std::to_string(line) + ": " + std::string(message));
}

}  // namespace aspic

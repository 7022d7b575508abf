#include "base/printable.h"

#include <algorithm>

namespace aspic {
namespace {

// Returns the length [bytes] of the printable character at the beginning of `text`; 0 if there is none.
size_t printable_length(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  char32_t code = first & (0x7fu >> length);
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0u) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3fu);
  }
  const bool is_shortest = length == 2 || code >= (length == 3 ? 0x800u : 0x10000u);
  const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
  const bool is_control = code < 0xa0 || code == 0x2028 || code == 0x2029;
  const bool is_direction = code == 0x61c || code == 0x200e || code == 0x200f || (code >= 0x202a && code <= 0x202e) ||
                            (code >= 0x2066 && code <= 0x2069);
  return is_shortest && code <= 0x10ffff && !is_surrogate && !is_control && !is_direction ? length : 0;
}

size_t shown_length(std::string_view text) { return std::max<size_t>(printable_length(text), 1); }

void append_shown(std::string_view character, std::string& out) {
  if (printable_length(character) > 0) {
    out += character;
    return;
  }
  constexpr char kDigits[] = "0123456789ABCDEF";
  const auto byte = static_cast<unsigned char>(character[0]);
  out += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
}

// Returns the longest beginning whose printable form fits into `max_bytes` bytes; leaves the rest in `text`.
std::string beginning(std::string_view& text, size_t max_bytes) {
  std::string out;
  while (!text.empty()) {
    const size_t length = shown_length(text), before = out.size();
    append_shown(text.substr(0, length), out);
    if (out.size() > max_bytes) {
      out.resize(before);
      break;
    }
    text.remove_prefix(length);
  }
  return out;
}

}  // namespace

bool is_printable(std::string_view text) {
  while (!text.empty()) {
    const size_t length = printable_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string printable(std::string_view text) { return beginning(text, std::string::npos); }

std::string printable_lines(std::string_view text) {
  std::string lines;
  for (size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    lines += printable(text.substr(0, end)) + '\n';
    text.remove_prefix(end + 1);
  }
  return lines + printable(text);
}

std::string shortened(std::string_view text, size_t max_bytes) {
  std::string_view rest = text;
  std::string whole = beginning(rest, max_bytes);
  if (rest.empty()) return whole;
  return beginning(text, max_bytes - 3) + "...";
}

std::string elided(std::string_view text, size_t max_bytes) {
  std::string_view rest = text;
  std::string whole = beginning(rest, max_bytes);
  if (rest.empty()) return whole;
  constexpr std::string_view kMark = " ... ";
  const size_t end = (max_bytes - kMark.size()) / 4;
  std::string last = printable(text.substr(text.size() - std::min(text.size(), end)));
  last.erase(0, last.size() - std::min(last.size(), end));
  while (!last.empty() && (static_cast<unsigned char>(last[0]) & 0xc0u) == 0x80) last.erase(0, 1);
  return beginning(text, max_bytes - kMark.size() - end).append(kMark) + last;
}

std::string shown(std::string_view word) { return "'" + shortened(word, 40) + "'"; }

}  // namespace aspic

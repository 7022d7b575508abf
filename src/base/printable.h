// Printable text for messages, reports and pages, from files and command lines: terminals interpret control characters,
// and JSON must be UTF-8.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace aspic {

// Returns whether `text` is UTF-8 without control characters: those of ASCII (including line breaks and tabs) and
// Latin-1, and those of Unicode that break lines or change the text direction.
bool is_printable(std::string_view text);

// Returns the text with each unprintable byte as \xNN.
std::string printable(std::string_view text);
std::string printable_lines(std::string_view text);  // keeps line breaks

// Returns printable text of at most `max_bytes` bytes [> 3]. "..." replaces the end of `shortened` or the middle of
// `elided` text.
std::string shortened(std::string_view text, size_t max_bytes = 60);
std::string elided(std::string_view text, size_t max_bytes);

// Returns a word for a message: shortened and in single quotes.
std::string shown(std::string_view word);

}  // namespace aspic

// Text from files and command lines as a message, a report or a page may show it: a terminal obeys control characters,
// and JSON holds nothing but UTF-8.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace aspic {

// Whether `text` is UTF-8 without control characters: those of ASCII (line breaks and tabs, too) and of Latin-1, and
// those of Unicode that break a line or turn the direction of what follows.
bool is_printable(std::string_view text);

// The same text where it is printable, and \xNN for each byte of the rest.
std::string printable(std::string_view text);
std::string printable_lines(std::string_view text);  // line breaks stay

// Printable and at most `most` bytes long [> 3]: the end is left out for "...", or, of `elided` text, the middle.
std::string shortened(std::string_view text, size_t most = 60);
std::string elided(std::string_view text, size_t most);

// A word as a message shows it: shortened, in single quotes.
std::string shown(std::string_view word);

}  // namespace aspic

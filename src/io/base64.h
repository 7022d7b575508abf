// Base64 [RFC 4648, section 4] as used by VTK: several encodings, each with its own padding, may follow each other.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace aspic {

void append_base64(std::string_view bytes, std::string& text);

// Decodes the front of `text` until at least `wanted` bytes were appended to `bytes` or the text ends, and removes the
// decoded part from `text`. Skips white space. Returns false if a character is invalid.
bool decode_base64(std::string_view& text, size_t wanted, std::string& bytes);

}  // namespace aspic

// Base64 [RFC 4648, section 4], as VTK uses it: several encodings, each with its own padding, may follow one another.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace aspic {

void append_base64(std::string_view bytes, std::string& text);

// Decodes from the front of `text` until at least `wanted` bytes were appended to `bytes` or the text ends, and
// removes what was read from `text`. Blanks are skipped. False when a character does not belong.
bool decode_base64(std::string_view& text, size_t wanted, std::string& bytes);

}  // namespace aspic

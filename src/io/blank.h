// White space as XML has it, between words and within base64.
#pragma once

namespace aspic {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace aspic

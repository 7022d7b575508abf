// White space of XML, also allowed inside base64.
#pragma once

namespace aspic {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace aspic

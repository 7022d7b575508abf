// The part of a page's message that the server needs; the session reads the rest.
#pragma once
#include <string>
#include <string_view>

namespace aspic::viewer {

struct MessageHead {
  bool is_message = false;  // an object with "do" or "ask"
  std::string does;         // "play"; empty for a question
  std::string id;           // as JSON: "7", or "null"
};

MessageHead parse_head(std::string_view text);

}  // namespace aspic::viewer

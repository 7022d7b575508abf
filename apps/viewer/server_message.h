// What the server itself must know of a page's message; the rest is the session's.
#pragma once
#include <string>
#include <string_view>

namespace aspic::viewer {

struct MessageHead {
  bool is_message = false;  // an object that does or asks something
  std::string does;         // "play"; empty for a question
  std::string id;           // as JSON: "7", or "null"
};

MessageHead parse_head(std::string_view text);

}  // namespace aspic::viewer

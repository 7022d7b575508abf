#include "viewer/server_message.h"

#include <nlohmann/json.hpp>

namespace aspic::viewer {

MessageHead parse_head(std::string_view text) {
  // Keeps only the members of the message itself, without nested values.
  const auto is_shallow = [](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) { return depth <= 1; };
  const nlohmann::json message = nlohmann::json::parse(text, is_shallow, /*allow_exceptions=*/false);
  MessageHead head{.id = "null"};
  if (!message.is_object()) return head;
  const auto text_of = [&](const char* key) {
    const auto found = message.find(key);
    return found != message.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  head.does = text_of("do");
  head.is_message = !head.does.empty() || !text_of("ask").empty();
  if (const auto id = message.find("id"); id != message.end() && id->is_number_integer()) head.id = id->dump();
  return head;
}

}  // namespace aspic::viewer

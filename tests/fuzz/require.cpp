#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "base/error.h"
#include "base/printable.h"
#include "targets.h"

namespace aspic::fuzz {
namespace {

constexpr int kMaxLines = 12;

}  // namespace

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "violated property: %s\n", what);
  std::abort();
}

void require_message(std::string_view message) {
  require(!message.empty(), "an error has a message");
  int lines = 0;
  for (bool is_last = false; !is_last; ++lines) {
    const size_t end = std::min(message.find('\n'), message.size());
    is_last = end == message.size();
    require(is_printable(message.substr(0, end)), "an error message contains no control characters");
    require(end <= InvalidInput::kLongestMessage, "an error message is within its length limit");
    message.remove_prefix(is_last ? end : end + 1);
  }
  require(lines <= kMaxLines, "an error message has few lines");
}

void require_printable(const std::vector<std::string>& texts) {
  for (const std::string& text : texts)
    require(is_printable(text), "messages about a file contain no control characters");
}

std::string attempt(Feed feed, std::string_view bytes) {
  try {
    feed(bytes);
    return "";
  } catch (const InvalidInput& refusal) {
    require_message(refusal.what());
    return refusal.what();
  }
}

}  // namespace aspic::fuzz

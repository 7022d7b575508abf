#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "base/error.h"
#include "base/printable.h"
#include "targets.h"

namespace aspic::fuzz {
namespace {

constexpr int kMostLines = 12;

}  // namespace

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

void require_message(std::string_view message) {
  require(!message.empty(), "a refusal says why");
  int lines = 0;
  for (bool is_last = false; !is_last; ++lines) {
    const size_t end = std::min(message.find('\n'), message.size());
    is_last = end == message.size();
    require(is_printable(message.substr(0, end)), "a refusal holds nothing that a terminal would obey");
    require(end <= InvalidInput::kLongestMessage, "a refusal is no longer than its limit");
    message.remove_prefix(is_last ? end : end + 1);
  }
  require(lines <= kMostLines, "a refusal has a few lines");
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

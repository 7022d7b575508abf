#include <cstdio>
#include <cstdlib>

#include "base/error.h"
#include "targets.h"

namespace aspic::fuzz {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

std::string attempt(Feed feed, std::string_view bytes) {
  try {
    feed(bytes);
    return "";
  } catch (const InvalidInput& refusal) {
    require(*refusal.what() != '\0', "a refusal says why");
    return refusal.what();
  }
}

}  // namespace aspic::fuzz

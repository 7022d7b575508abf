#include "base/check.h"

#include <cstdio>
#include <cstdlib>

namespace aspic {

void check_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: a bug in Aspic: %s does not hold\n", file, line, condition);
  std::abort();
}

}  // namespace aspic

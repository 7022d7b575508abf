#include "base/stopwatch.h"

#include <chrono>

namespace aspic {

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace aspic

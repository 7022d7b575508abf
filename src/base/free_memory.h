// Memory that this process can still allocate.
#pragma once
#include <cstdint>

namespace aspic {

// Returns the smallest of the memory available on the machine and the limits of control group and ulimit -v [bytes].
// INT64_MAX if no limit is known.
int64_t free_memory();

}  // namespace aspic

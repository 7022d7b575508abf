// Memory that this process can still allocate.
#pragma once
#include <cstdint>

namespace aspic {

// Returns the smallest of the available memory of the machine, the limit of the control group and that of ulimit -v
// [bytes]. INT64_MAX if no limit is known.
int64_t free_memory();

}  // namespace aspic

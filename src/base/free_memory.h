// Memory that this process can still allocate, and that it has freed.
#pragma once
#include <cstdint>

namespace aspic {

// Returns the smallest of the available memory of the machine, the limit of the control group and that of ulimit -v
// [bytes]. INT64_MAX if no limit is known.
int64_t free_memory();

// Keeps freed memory for later arrays instead of returning it to the system, which clears every page that it gives. For
// programs that work on one model.
void keep_freed_memory();

}  // namespace aspic

// How much memory this process may still take.
#pragma once
#include <cstdint>

namespace aspic {

// [bytes], the smallest of what the machine has available and what the control group and ulimit -v allow. INT64_MAX
// where no limit is known.
int64_t free_memory();

}  // namespace aspic

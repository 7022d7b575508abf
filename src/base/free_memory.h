// How much memory this process may still take.
#pragma once
#include <cstdint>

namespace aspic {

// [bytes], the smaller of what the machine has available and what the control group allows; INT64_MAX where the
// system does not tell.
int64_t free_memory();

}  // namespace aspic

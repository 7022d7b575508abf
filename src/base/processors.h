// How many processors this process may use.
#pragma once

namespace aspic {

int processor_count();  // at least 1; honours the affinity mask (taskset) where the system has one

}  // namespace aspic

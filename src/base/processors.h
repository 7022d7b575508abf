// Number of processors available to this process.
#pragma once

namespace aspic {

int processor_count();  // at least 1; respects the affinity mask (taskset) where available

}  // namespace aspic

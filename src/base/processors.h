// How many processors this process may use.
#pragma once

namespace aspic {

int processor_count();  // at least 1; honors the affinity mask (taskset) where the system has one

}  // namespace aspic

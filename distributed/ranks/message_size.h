// Numbers of elements in a message: MPI takes 32-bit integers.
#pragma once
#include <cstddef>
#include <limits>
#include <string>

#include "base/error.h"

namespace aspic::distributed {

// Returns the number as MPI takes it. Throws InvalidInput if it is too large.
inline int message_size(size_t elements) {
  if (elements > static_cast<size_t>(std::numeric_limits<int>::max()))
    throw InvalidInput("a message between ranks would have " + std::to_string(elements) +
                       " elements, more than MPI sends at once; use more ranks");
  return static_cast<int>(elements);
}

}  // namespace aspic::distributed

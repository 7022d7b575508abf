// The scenes that several ranks can simulate.
#pragma once
#include "scene/value.h"

namespace aspic::distributed {

// Throws InvalidInput for the first key that is not supported, with its place, its value and a remedy. `document`: with
// all defaults.
void require_supported(const Table& document);

}  // namespace aspic::distributed

// Guards against a miscompiled engine.
#pragma once
#include <string>

namespace aspic::engine {

// Returns which computation has a wrong result; empty: none.
std::string self_test();

}  // namespace aspic::engine

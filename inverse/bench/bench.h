// The virtual bench of the viewer: an indenter presses on the body of a scene, its readings are kept and become a data
// set, and `aspic fit` fits the stiffness to it. docs/viewer.md shows how to use it.
#pragma once
#include "viewer/extension.h"

namespace aspic::bench {

viewer::SessionExtension bench();

}  // namespace aspic::bench

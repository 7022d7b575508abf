// The minimization of a function of two variables, for the functions panel.
#pragma once
#include "viewer/arguments.h"

namespace aspic::viewer {

// A FunctionReply of web/src/protocol.ts. Throws InvalidInput.
Json function_reply(Arguments& question);

}  // namespace aspic::viewer

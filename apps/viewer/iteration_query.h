// What a page asks about an iteration of a step: E along its direction, and over a plane through it.
#pragma once
#include "optimize/landscape.h"
#include "viewer/side.h"

namespace aspic::viewer {

// The reply of web/src/protocol.ts. Repeats the step. Throws InvalidInput: it cannot be repeated, has no such
// iteration, or `stop` stops.
Json iteration_reply(Side& side, int step, int iteration, const StopToken& stop);

Json to_json(const std::vector<CurvePoint>& curve);

}  // namespace aspic::viewer

// Samples of the energy E around an iteration of a step: along its direction, and over a plane through it.
#pragma once
#include "optimize/landscape.h"
#include "viewer/side.h"

namespace aspic::viewer {

// Repeats the step and returns the reply of web/src/protocol.ts. Throws InvalidInput if the step cannot be repeated or
// has no such iteration, or if `stop` stops.
Json iteration_reply(Side& side, int step, int iteration, const StopToken& stop);

Json to_json(const std::vector<CurvePoint>& curve);

}  // namespace aspic::viewer

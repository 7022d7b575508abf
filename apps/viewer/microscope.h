// What a page asks about one place, one iteration or the worst places of a simulation.
#pragma once
#include <functional>

#include "optimize/landscape.h"
#include "viewer/side.h"

namespace aspic::viewer {

// The replies of web/src/protocol.ts. Vertices and triangles are those of the surface, in range.
Json vertex_reply(const Side& side, const Surface& surface, int vertex);
Json tet_reply(const Side& side, const Surface& surface, int triangle);
Json worst_reply(const Side& side);
// Repeats the step. Throws InvalidInput: it cannot be repeated, has no such iteration, or was told to stop.
Json iteration_reply(Side& side, int step, int iteration, const Consent& go_on);

Json to_json(const std::vector<CurvePoint>& curve);

}  // namespace aspic::viewer

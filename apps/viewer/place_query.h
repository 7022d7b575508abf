// What a page asks about a place of a simulation: one vertex, one tet, or the places that are worst off.
#pragma once
#include "viewer/side.h"

namespace aspic::viewer {

// The replies of web/src/protocol.ts. Vertices and triangles are those of the surface, in range.
Json vertex_reply(const Side& side, const Surface& surface, int vertex);
Json tet_reply(const Side& side, const Surface& surface, int triangle);
Json worst_reply(const Side& side);

}  // namespace aspic::viewer

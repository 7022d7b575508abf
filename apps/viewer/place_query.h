// Replies to questions about a place: one vertex, one tet, or the places with extreme values.
#pragma once
#include "viewer/session_messages.h"

namespace aspic::viewer {

// web/src/protocol.ts declares the replies. Vertices and triangles are those of the shown surface, in range.
Json vertex_reply(const ShownSide& shown, int vertex);
Json tet_reply(const ShownSide& shown, int triangle);
Json worst_reply(const ShownSide& shown);

}  // namespace aspic::viewer

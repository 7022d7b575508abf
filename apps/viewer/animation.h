// The motion of a session as a file, sampled from the snapshots of its timeline.
#pragma once
#include "viewer/session_messages.h"

namespace aspic::viewer {

// Returns {"name", "base64", "note"}. `format`: "usd", "pc2" (a ZIP archive of the surface as OBJ and its point cache)
// or "glb". Throws InvalidInput for another format, without motion, and for a surface that is too large.
Json animation_reply(const ShownSide& shown, const Json& format);

}  // namespace aspic::viewer

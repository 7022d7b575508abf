// Replies to the questions of a page. web/src/protocol.ts declares them.
#pragma once
#include <optional>

#include "io/camera.h"
#include "optimize/landscape.h"
#include "viewer/session_messages.h"

namespace aspic::viewer {

// Details of one vertex, one tet, and the places with extreme values. Vertices and triangles are those of the shown
// surface, in range.
Json vertex_reply(const ShownSide& shown, int vertex);
Json tet_reply(const ShownSide& shown, int triangle);
Json worst_reply(const ShownSide& shown);

// Samples of the energy E around an iteration of a step: along its direction, and over a plane through it. Repeats the
// step. Throws InvalidInput if the step cannot be repeated or has no such iteration, or if `stop` stops.
Json iteration_reply(Side& side, int step, int iteration, const StopToken& stop);
Json to_json(const std::vector<CurvePoint>& curve);

// The minimization of a function of two variables, for the functions panel. Throws InvalidInput.
Json function_reply(Arguments& question);

// Returns {"name", "base64", "note"}. `format`: "usd", "pc2" (a ZIP archive of the surface as OBJ and its point cache)
// or "glb"; USD and GLB contain the camera. Throws InvalidInput without motion, and for a surface that is too large.
Json animation_reply(const ShownSide& shown, const std::string& format, std::optional<Camera> camera = {});

}  // namespace aspic::viewer

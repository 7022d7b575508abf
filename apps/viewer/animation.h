// The motion of a session as a file: the steps that its timeline holds.
#pragma once
#include "viewer/session_messages.h"

namespace aspic::viewer {

// {"name", "base64", "note"}: `format` is "usd", "pc2" (a ZIP archive of the surface as OBJ and its point cache) or
// "glb". Throws InvalidInput: another format, no motion yet, or a surface that is too large for the page.
Json animation_reply(const ShownSide& shown, const Json& format);

}  // namespace aspic::viewer

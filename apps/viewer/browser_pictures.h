// The viewer's page in a browser without a window: it draws pictures for this program.
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "base/stop_token.h"

namespace aspic::viewer {

struct PageOfPictures {
  std::string page;   // HTML
  std::string query;  // of its address, after the token: "&render=1"; see web/src/main.ts

  // What the page asks for, by number. Called from another thread. Empty: it has all it needs.
  std::function<std::string(int index)> part = {};
};

using Pictures = std::function<void(int index, int count, std::string_view png)>;  // in order

enum class RenderEnd { done, interrupted };

// Calls `pictures` for every picture from another thread. An exception of `pictures` ends the drawing and is rethrown
// here. Always ends the browser. Throws InvalidInput if there is no browser, it exits or is silent for a minute, or the
// page fails.
RenderEnd draw_in_browser(const PageOfPictures& page, const Pictures& pictures, const StopToken& stop);

}  // namespace aspic::viewer

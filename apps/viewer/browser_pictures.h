// Pictures that the viewer's page draws in a headless browser.
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "base/stop_token.h"

namespace aspic::viewer {

struct PageOfPictures {
  std::string page;   // HTML
  std::string query;  // end of the address, after the token: "&render=1"; see web/src/main.ts

  // Returns the part of the data with that index. Called from another thread. Empty: the page contains all data.
  std::function<std::string(int index)> part = {};
};

using Pictures = std::function<void(int index, int count, std::string_view png)>;  // called in order

enum class RenderEnd { done, interrupted };

// Calls `pictures` for every picture from another thread. An exception of `pictures` ends the drawing and is rethrown
// here. Always ends the browser. Throws InvalidInput if there is no browser, it exits or is silent for a minute, or the
// page fails.
RenderEnd draw_in_browser(const PageOfPictures& page, const Pictures& pictures, const StopToken& stop);

}  // namespace aspic::viewer

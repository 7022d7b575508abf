// The viewer's page in a browser without a window: it draws pictures for this program.
#pragma once
#include <functional>
#include <string>
#include <string_view>

namespace aspic::viewer {

struct PageOfPictures {
  std::string page;   // HTML
  std::string query;  // of its address, after the token: "&render=1"; web/src/main.ts tells what there is

  // What the page asks for, by number. Called from another thread. Empty: it has all it needs.
  std::function<std::string(int index)> part = {};
};

using Pictures = std::function<void(int index, int count, std::string_view png)>;  // in order

enum class RenderEnd { done, interrupted };

// Calls `pictures` with every picture, from another thread, while this waits; what it throws ends the drawing and is
// thrown here. Stops when `go_on` says false. The browser is always ended. Throws InvalidInput: there is no browser, it
// ends or says nothing for a minute, or the page cannot do what is asked.
RenderEnd draw_in_browser(const PageOfPictures& page, const Pictures& pictures, const std::function<bool()>& go_on);

}  // namespace aspic::viewer

// Shows an address in the reader's browser.
#pragma once
#include <string>

namespace aspic::cli {

// False: there is no display, or nothing that opens it there.
bool open_browser(const std::string& address);

}  // namespace aspic::cli

// Opens an address in the user's browser.
#pragma once
#include <string>

namespace aspic::cli {

// Returns false if there is no display, or no program to open the address.
bool open_browser(const std::string& address);

}  // namespace aspic::cli

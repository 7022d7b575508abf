// The page of the viewer, reports and pictures: one HTML file with its scripts and styles, embedded in the program.
#pragma once
#include <string>
#include <string_view>

namespace aspic::viewer {

const std::string& page();

// Returns the page with `html` at the place of a recorded run, before its script.
std::string page_with(std::string_view html);

}  // namespace aspic::viewer

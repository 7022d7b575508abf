// The page of the viewer, reports and pictures: one HTML file with its scripts and styles, part of the program.
#pragma once
#include <string>
#include <string_view>

namespace aspic::viewer {

const std::string& page();

// The page with `html` where a recorded run belongs, before its script.
std::string page_with(std::string_view html);

}  // namespace aspic::viewer

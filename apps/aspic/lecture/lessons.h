// The pages of the lecture as lessons of the viewer: the demonstrations of course.h, each with what to look at.
#pragma once
#include <filesystem>
#include <vector>

#include "viewer/session.h"

namespace aspic::cli::lecture {

// In the order of the pages. Where the lecture's scenes are not found, lessons that need one say so. `cache` keeps
// meshes that take long to make.
std::vector<viewer::Lesson> lessons(const std::filesystem::path& cache);

}  // namespace aspic::cli::lecture

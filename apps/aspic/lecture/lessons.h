// Lessons of the viewer from the lecture's pages: the demonstrations of course.h with instructions.
#pragma once
#include <filesystem>
#include <vector>

#include "viewer/session.h"

namespace aspic::cli::lecture {

// Returns the lessons in page order. If the lecture's scenes are missing, lessons that need one report it. `cache`
// stores meshes that take long to make.
std::vector<viewer::Lesson> lessons(const std::filesystem::path& cache);

}  // namespace aspic::cli::lecture

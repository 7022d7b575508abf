// One frame of a run as an unstructured grid: all bodies, with the fields that a viewer colours by.
#pragma once
#include <filesystem>

#include "dynamics/simulation.h"

namespace aspic {

void write_frame(const std::filesystem::path& path, const Simulation& simulation);

}  // namespace aspic

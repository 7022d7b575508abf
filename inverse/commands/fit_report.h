// HTML report of a fit, written by the viewer if the program includes it.
#pragma once
#include <cstdio>
#include <filesystem>

#include "page/fit_page.h"
#include "pipeline/fit_run.h"

namespace aspic::cli {

// Prints its path, or the reason of its absence, to `stream` (null: nothing).
void write_fit_report(const std::filesystem::path& file, const viewer::FitPageContent& content, std::FILE* stream);

}  // namespace aspic::cli

// Results of demonstrations as text, page and JSON.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "aspic/lecture/course.h"

namespace aspic::cli::lecture {

struct Result {
  const Demonstration* demonstration;
  Sheet sheet;
  double seconds = 0;
};

void print(const Result& result);
std::string count_text(const std::vector<Result>& results);  // number of passing pages, and pages that cannot be judged

// Writes a page with embedded pictures.
void write_page(const std::filesystem::path& path, const std::string& mesh, const Result& result);

// Writes index.html with embedded pictures, and lecture.json, for all pages.
void write_summary(const std::filesystem::path& folder, const std::string& mesh, const std::vector<Result>& results);

}  // namespace aspic::cli::lecture

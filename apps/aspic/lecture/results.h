// The results of demonstrations as text, as a page and as JSON.
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

std::string pages_text(const std::vector<int>& pages);  // "5, 7-9"
void print(const Result& result);
std::string count_text(const std::vector<Result>& results);  // how many pages pass, and which cannot be judged

// index.html with the pictures inside, and lecture.json, of all the pages.
void write_summary(const std::filesystem::path& folder, const std::string& mesh, const std::vector<Result>& results);

}  // namespace aspic::cli::lecture

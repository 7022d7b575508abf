#include "aspic/assignments.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace aspic::cli {
namespace {

bool is_assignment(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || text[0] == '-') return false;
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  };
  std::error_code error;
  return std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(equals), fits) &&
         !std::filesystem::exists(text, error);
}

}  // namespace

std::vector<std::string> spread_assignments(const std::vector<std::string>& arguments) {
  std::vector<std::string> result;
  bool follows_one = false;  // follows --set KEY=VALUE
  for (size_t i = 0; i < arguments.size(); ++i) {
    if (follows_one && is_assignment(arguments[i])) result.emplace_back("--set");
    const bool is_value = i > 0 && arguments[i - 1] == "--set";
    follows_one = is_value || arguments[i].starts_with("--set=") || (follows_one && is_assignment(arguments[i]));
    result.push_back(arguments[i]);
  }
  return result;
}

}  // namespace aspic::cli

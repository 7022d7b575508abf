#include "recording/file_pattern.h"

#include <algorithm>
#include <cctype>

#include "base/error.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

// The parts of the pattern between stars must follow each other in the name, the first and last at its ends.
bool matches(std::string_view name, std::string_view pattern) {
  const size_t star = pattern.find('*');
  if (star == std::string_view::npos) return name == pattern;
  if (!name.starts_with(pattern.substr(0, star))) return false;
  name.remove_prefix(star);
  for (pattern.remove_prefix(star + 1);;) {
    const size_t next = pattern.find('*');
    if (next == std::string_view::npos) return name.size() >= pattern.size() && name.ends_with(pattern);
    const size_t found = name.find(pattern.substr(0, next));
    if (found == std::string_view::npos) return false;
    name.remove_prefix(found + next);
    pattern.remove_prefix(next + 1);
  }
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

size_t digits_at(std::string_view text, size_t at) {
  size_t end = at;
  while (end < text.size() && is_digit(text[end])) ++end;
  return end - at;
}

// Compares runs of digits as numbers, everything else by characters.
bool naturally_less(std::string_view a, std::string_view b) {
  size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      while (i < a.size() && a[i] == '0') ++i;
      while (j < b.size() && b[j] == '0') ++j;
      const size_t m = digits_at(a, i), n = digits_at(b, j);
      if (m != n) return m < n;
      if (const int order = a.substr(i, m).compare(b.substr(j, n)); order != 0) return order < 0;
      i += m, j += n;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
    }
  }
  return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

}  // namespace

bool is_pattern(const fs::path& path) { return path.filename().string().find('*') != std::string::npos; }

std::vector<fs::path> matching_files(const fs::path& pattern) {
  if (!is_pattern(pattern)) return {pattern};
  const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (matches(name, pattern.filename().string())) names.push_back(name);
  }
  if (error) throw InvalidInput(folder.string() + ": cannot be listed: " + error.message());
  if (names.empty())
    throw InvalidInput(pattern.string() + ": no file matches; * matches any characters of a file's name");
  std::sort(names.begin(), names.end(), naturally_less);
  std::vector<fs::path> files;
  for (const std::string& name : names) files.push_back(folder / name);
  return files;
}

}  // namespace aspic

// Feeds files to a target without a fuzzer, in any build: "replay gmsh FILE|FOLDER ...". "replay --list" prints the
// targets.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "io/atomic_file.h"
#include "targets.h"

namespace aspic::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(int count, char** arguments) {
  std::vector<fs::path> files;
  for (int i = 0; i < count; ++i)
    if (fs::is_directory(arguments[i]))
      for (const auto& entry : fs::directory_iterator(arguments[i])) files.push_back(entry.path());
    else
      files.emplace_back(arguments[i]);
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace
}  // namespace aspic::fuzz

int main(int count, char** arguments) {
  using namespace aspic::fuzz;
  const std::string name = count > 1 ? arguments[1] : "";
  if (name == "--list") {
    for (const Target& target : targets()) std::printf("%s\n", std::string(target.name).c_str());
    return 0;
  }
  const Target* target = target_named(name);
  if (count < 3 || !target) {
    std::fprintf(stderr, "usage: replay TARGET FILE|FOLDER ...; replay --list prints the targets\n");
    return 2;
  }
  const std::vector<fs::path> files = files_of(count - 2, arguments + 2);
  for (const fs::path& file : files) {
    std::fprintf(stderr, "%s: ", file.string().c_str());  // the last name printed is the faulty file
    const std::string refusal = attempt(target->feed, aspic::read_file(file));
    std::fprintf(stderr, "%s\n", refusal.empty() ? "read" : refusal.c_str());
  }
  return files.empty() ? 1 : 0;
}

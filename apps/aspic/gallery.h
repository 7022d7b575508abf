// The scenes that the viewer offers: those that come with the program, and those that were opened before.
#pragma once
#include <filesystem>
#include <vector>

#include "viewer/session.h"

namespace aspic::cli {

// All scenes below `folder`, by name; the first comment line of each is what it is about.
std::vector<viewer::OfferedScene> scenes_below(const std::filesystem::path& folder);

// The folder of the scenes that come with the program; empty where there is none.
std::filesystem::path shipped_scenes();

// What was opened, newest first, in a small file below the user's folder for the state of programs. A list that cannot
// be read or written is an empty one: nobody's work depends on it.
class RecentScenes {
 public:
  static constexpr size_t kMost = 12;

  explicit RecentScenes(std::filesystem::path file);
  static std::filesystem::path usual_file();  // empty where the user has no such folder

  void note(const std::filesystem::path& scene) const;
  std::vector<std::filesystem::path> read() const;  // those that still exist

 private:
  std::filesystem::path file_;
};

}  // namespace aspic::cli

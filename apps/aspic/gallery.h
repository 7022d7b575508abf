// Scenes that the viewer offers: shipped scenes and recently opened ones.
#pragma once
#include <filesystem>
#include <vector>

#include "viewer/offered_scenes.h"

namespace aspic::cli {

// Returns the folder of the shipped scenes; empty if missing.
std::filesystem::path shipped_scenes();

// Opened scenes, newest first, in a small file in the user's state folder. If it cannot be read or written, the list is
// empty.
class RecentScenes {
 public:
  static constexpr size_t kMax = 12;

  explicit RecentScenes(std::filesystem::path file);
  static std::filesystem::path default_file();  // empty if the user has no such folder

  void note(const std::filesystem::path& scene) const;
  std::vector<std::filesystem::path> read() const;  // existing files only

 private:
  std::filesystem::path file_;
};

}  // namespace aspic::cli

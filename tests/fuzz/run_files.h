// Scenes and runs small enough for thousands of them per minute.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace aspic::fuzz {

inline constexpr double kMaxTets = 300;
SceneOptions small_scenes();

// Files of a folder in memory.
class Folder {
 public:
  explicit Folder(const std::filesystem::path& path);
  const std::string& contents(const std::filesystem::path& name) const;  // the file must exist
  void restore(const std::filesystem::path& path) const;                 // replaces the folder's files by these

 private:
  std::vector<std::pair<std::filesystem::path, std::string>> files_;  // sorted by relative path
};

// Run of a box of six tets after some steps.
Folder begun_run(int steps);

// Adapts the checkpoint's fingerprint and checksum to the scene in the folder.
void make_checkpoint_right(const std::filesystem::path& path, std::string_view fingerprint);

}  // namespace aspic::fuzz

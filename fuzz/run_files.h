// Scenes and runs small enough for thousands of them per minute.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace aspic::fuzz {

inline constexpr double kMostTets = 300;
SceneOptions small_scenes();

// The files of a folder, kept in memory.
class Folder {
 public:
  explicit Folder(const std::filesystem::path& path);
  const std::string& contents(const std::filesystem::path& name) const;  // which is there
  void restore(const std::filesystem::path& path) const;                 // with these files and no others

 private:
  std::vector<std::pair<std::filesystem::path, std::string>> files_;  // by their names within it
};

// A run of a box of six tets after some steps.
Folder begun_run(int steps);

// Of whatever a scene there says, the checkpoint has its fingerprint and a right checksum.
void make_checkpoint_right(const std::filesystem::path& path, std::string_view fingerprint);

}  // namespace aspic::fuzz

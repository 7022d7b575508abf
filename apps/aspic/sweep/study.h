// Studies: a scene and the values of its keys in each case of an ensemble (docs/ensembles.md).
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace aspic {

struct Study {
  std::filesystem::path scene;  // relative to the current folder
  bool frames = false;          // whether the runs write frames and reports
  int threads = 1;              // of each run
  std::vector<std::string> keys;
  // Per case the values of the keys, as after KEY= in --set. Empty: the value of the scene.
  std::vector<std::vector<std::string>> cases;

  std::vector<std::string> overrides(size_t index) const;  // of a case: "material.young=2e5", ...
};

constexpr int kMaxCases = 100'000;

// Throws InvalidInput with file, line, value and remedy. Checks each value in the first case, and each row of a table,
// against the keys of scenes.
Study read_study(const std::filesystem::path& path);

}  // namespace aspic

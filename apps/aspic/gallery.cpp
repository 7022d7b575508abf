#include "aspic/gallery.h"

#include <cstdlib>
#include <fstream>

#include "aspic/shipped_files.h"
#include "base/error.h"
#include "io/atomic_file.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

constexpr size_t kLongestPath = 4096;

// Scenes there are of tests and other programs, and vanish.
bool is_temporary(const fs::path& scene) {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  const fs::path inside = scene.lexically_relative(folder);
  return !error && !inside.empty() && *inside.begin() != "..";
}

}  // namespace

// The folder "lecture" distinguishes it from other folders named scenes.
fs::path shipped_scenes() { return shipped_file("scenes/lecture").parent_path(); }

RecentScenes::RecentScenes(fs::path file) : file_(std::move(file)) {}

fs::path RecentScenes::default_file() {
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value && fs::path(value).is_absolute() ? fs::path(value) : fs::path();
  };
  if (const fs::path state = folder("XDG_STATE_HOME"); !state.empty()) return state / "aspic" / "recent";
  const fs::path home = folder("HOME");
  return home.empty() ? home : home / ".local" / "state" / "aspic" / "recent";
}

void RecentScenes::note(const fs::path& scene) const {
  std::error_code error;
  const std::string path = fs::absolute(scene, error).lexically_normal().string();
  if (file_.empty() || error || is_temporary(path) || path.find('\n') != std::string::npos) return;
  std::string text = path + "\n";
  size_t count = 1;
  for (const fs::path& other : read())
    if (other != path && count++ < kMax) text += other.string() + "\n";
  fs::create_directories(file_.parent_path(), error);
  try {
    if (!error) write_file(file_, text);
  } catch (const InvalidInput&) {  // a full disk, or missing permissions
  }
}

std::vector<fs::path> RecentScenes::read() const {
  std::vector<fs::path> paths;
  std::ifstream in(file_);
  std::string line;
  std::error_code error;
  while (!file_.empty() && paths.size() < kMax && std::getline(in, line))
    if (line.size() < kLongestPath && fs::path(line).is_absolute() && fs::is_regular_file(line, error) &&
        !is_temporary(line))
      paths.emplace_back(line);
  return paths;
}

}  // namespace aspic::cli

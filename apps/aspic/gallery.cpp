#include "aspic/gallery.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "aspic/shipped_files.h"
#include "base/error.h"
#include "base/printable.h"
#include "io/atomic_file.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

constexpr size_t kLongestAbout = 300, kLongestPath = 4096;

std::string about(const fs::path& scene) {
  std::ifstream in(scene);
  std::string line;
  std::getline(in, line);
  if (line.empty() || line[0] != '#') return "";
  const size_t text = line.find_first_not_of("# ");
  return text == std::string::npos ? "" : printable(line.substr(text, kLongestAbout));
}

}  // namespace

std::vector<viewer::OfferedScene> scenes_below(const fs::path& folder) {
  std::vector<viewer::OfferedScene> scenes;
  std::error_code error;
  for (fs::recursive_directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
    if (i->path().extension() == ".toml" && i->is_regular_file(error))
      scenes.push_back({i->path().lexically_relative(folder).generic_string(), about(i->path()), i->path()});
  const auto is_inside = [](const viewer::OfferedScene& s) { return s.name.find('/') != std::string::npos; };
  std::sort(scenes.begin(), scenes.end(), [&](const auto& x, const auto& y) {
    return std::pair(is_inside(x), x.name) < std::pair(is_inside(y), y.name);
  });
  return scenes;
}

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
  if (file_.empty() || error || path.find('\n') != std::string::npos) return;
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
    if (line.size() < kLongestPath && fs::path(line).is_absolute() && fs::is_regular_file(line, error))
      paths.emplace_back(line);
  return paths;
}

}  // namespace aspic::cli

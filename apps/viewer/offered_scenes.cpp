#include "viewer/offered_scenes.h"

#include <algorithm>
#include <fstream>
#include <utility>

#include "base/printable.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;

constexpr size_t kLongestAbout = 300;

std::string about(const fs::path& scene) {
  std::ifstream in(scene);
  std::string line;
  std::getline(in, line);
  if (line.empty() || line[0] != '#') return "";
  const size_t text = line.find_first_not_of("# ");
  return text == std::string::npos ? "" : printable(line.substr(text, kLongestAbout));
}

}  // namespace

std::vector<OfferedScene> scenes_below(const fs::path& folder) {
  std::vector<OfferedScene> scenes;
  std::error_code error;
  for (fs::recursive_directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
    if (i->path().extension() == ".toml" && i->is_regular_file(error))
      scenes.push_back({i->path().lexically_relative(folder).generic_string(), about(i->path()), i->path()});
  const auto is_inside = [](const OfferedScene& s) { return s.name.find('/') != std::string::npos; };
  std::sort(scenes.begin(), scenes.end(), [&](const auto& x, const auto& y) {
    return std::pair(is_inside(x), x.name) < std::pair(is_inside(y), y.name);
  });
  return scenes;
}

}  // namespace aspic::viewer

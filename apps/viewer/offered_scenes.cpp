#include "viewer/offered_scenes.h"

#include <algorithm>
#include <tuple>

#include "io/atomic_file.h"
#include "io/base64.h"
#include "scene/first_comment.h"

namespace aspic::viewer {

namespace fs = std::filesystem;

namespace {

std::string picture(const fs::path& folder, const std::string& stem) {
  const size_t name = stem.find_first_not_of("0123456789_");
  const fs::path file = folder / "gallery" / (stem.substr(std::min(name, stem.size())) + ".webp");
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return "";
  std::string url = "data:image/webp;base64,";
  append_base64(read_file(file), url);
  return url;
}

}  // namespace

std::vector<OfferedScene> scenes_below(const fs::path& folder) {
  std::vector<OfferedScene> scenes;
  std::error_code error;
  for (fs::recursive_directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
    if (i->path().extension() == ".toml" && i->is_regular_file(error))
      scenes.push_back({i->path().lexically_relative(folder).generic_string(), first_comment(i->path()), i->path(),
                        picture(folder, i->path().stem().string())});
  const auto is_inside = [](const OfferedScene& s) { return s.name.find('/') != std::string::npos; };
  std::sort(scenes.begin(), scenes.end(), [&](const auto& x, const auto& y) {
    return std::tuple(is_inside(x), x.picture.empty(), x.name) < std::tuple(is_inside(y), y.picture.empty(), y.name);
  });
  return scenes;
}

}  // namespace aspic::viewer

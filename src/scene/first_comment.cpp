#include "scene/first_comment.h"

#include <fstream>

#include "base/printable.h"

namespace aspic {

std::string first_comment(const std::filesystem::path& scene) {
  constexpr size_t kLongest = 300;
  std::ifstream in(scene);
  std::string line;
  std::getline(in, line);
  if (line.empty() || line[0] != '#') return "";
  const size_t text = line.find_first_not_of("# ");
  return text == std::string::npos ? "" : printable(line.substr(text, kLongest));
}

}  // namespace aspic

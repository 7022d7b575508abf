#include <cmath>
#include <string>

#include "scene/expression.h"
#include "scene/scene_document.h"
#include "scene/value.h"
#include "targets.h"

namespace aspic::fuzz {

void toml(std::string_view bytes) {
  const Table document = read_scene_document(std::string(bytes), "scene.toml", {});
  const std::string text = to_toml(document);
  require(to_toml(read_scene_document(text, "resolved.toml", {})) == text, "a resolved scene reads back the same");
}

void overrides(std::string_view bytes) {
  static const std::string kScene =
      "[[body]]\nname = \"a\"\nshape = { box = { lower = [0, 0, 0], upper = [1, 1, 1], cells = [1, 1, 1] } "
      "}\n[[body.pin]]\nwhere = \"y < 0\"\n[[body]]\nname = \"b\"\nshape = { sphere = { radius = 1, size = 1 } }\n";
  std::vector<std::string> lines;
  for (size_t begin = 0; begin < bytes.size();) {
    const size_t end = std::min(bytes.find('\n', begin), bytes.size());
    lines.emplace_back(bytes.substr(begin, end - begin));
    begin = end + 1;
  }
  read_scene_document(kScene, "scene.toml", lines);
}

// The first character selects the variables.
void expression(std::string_view bytes) {
  if (bytes.empty()) return;
  const auto variables = static_cast<ExpressionVariables>(static_cast<unsigned char>(bytes[0]) % 3);
  const Expression formula(std::string(bytes.substr(1)), variables);
  for (const Vec3d& X : {Vec3d{{0, 0, 0}}, Vec3d{{1, -2, 0.5}}, Vec3d{{1e300, -1e-300, 7}}})
    for (const double t : {0.0, 1.5}) formula.evaluate(X, t);
  require(std::isfinite(formula.at({{0.25, 0.5, 0.75}}, 1)), "an accepted value is finite");
}

}  // namespace aspic::fuzz

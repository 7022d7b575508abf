#include "data/patch_table.h"

#include <set>
#include <utility>

namespace aspic {

std::vector<Triangle> listed_triangles(const std::filesystem::path& file, const Value& name,
                                       const std::vector<Triangle>& boundary, ErrorList& errors,
                                       std::vector<std::string>& notes) {
  std::set<Triangle> outward;
  for (const Triangle& t : boundary)
    for (int i = 0; i < 3; ++i) outward.insert({t[i], t[(i + 1) % 3], t[(i + 2) % 3]});
  MeasuredTable table(file, {{"a", "b", "c"}, {}}, errors, notes);
  std::vector<Triangle> triangles;
  while (table.next()) {
    Triangle t{};
    bool is_whole = true;
    for (int i = 0; i < 3; ++i) {
      const std::optional<int> v = table.integer(std::string(1, "abc"[i]));
      is_whole &= v.has_value();
      t[i] = v.value_or(-1);
    }
    if (is_whole && !outward.contains(t) && outward.contains({t[0], t[2], t[1]})) std::swap(t[1], t[2]);
    if (outward.contains(t)) {
      triangles.push_back(t);
    } else {
      table.error("a, b, c are not a triangle of the surface; give its corners, counted from 0");
    }
  }
  if (triangles.empty() && errors.is_empty()) throw error_at(name.place, "the table has no triangle");
  return triangles;
}

}  // namespace aspic

#include "mesh/self_intersection.h"

#include <algorithm>
#include <cmath>

#include "mesh/box_tree.h"
#include "mesh/topology.h"
#include "mesh/triangle_shape.h"

namespace aspic {
namespace {

// Turned so that the vertices common to both come first, in the same order; how many there are.
int align(Triangle& s, Triangle& t) {
  int common = 0;
  for (int i = 0; i < 3; ++i) {
    const auto found = std::find(t.begin() + common, t.end(), s[i]);
    if (found == t.end()) continue;
    std::iter_swap(t.begin() + common, found);
    std::swap(s[common], s[i]);
    ++common;
  }
  return common;
}

class Search {
 public:
  explicit Search(const TriMesh& mesh) : vertices_(mesh.vertices), triangles_(mesh.triangles) {
    const std::vector<int> first = first_at_same_place(vertices_);
    for (Triangle& triangle : triangles_)
      for (int& v : triangle) v = first[v];
    for (size_t t = 0; t < triangles_.size(); ++t)
      if (!is_degenerate(corners(triangles_[t]))) usable_.push_back(static_cast<int>(t));
  }

  std::vector<std::array<int, 2>> pairs(int most) const {
    std::vector<Box> boxes(usable_.size());
    for (size_t i = 0; i < usable_.size(); ++i)
      for (int v : triangles_[usable_[i]]) boxes[i].add(vertices_[v]);
    const BoxTree tree(boxes);
    std::vector<std::array<int, 2>> found;
    for (int i = 0; i < static_cast<int>(usable_.size()); ++i)
      tree.for_each_overlap(boxes[i], [&](int j) {
        if (j < i && static_cast<int>(found.size()) < most && intersect(usable_[j], usable_[i]))
          found.push_back({usable_[j], usable_[i]});
        return static_cast<int>(found.size()) < most;
      });
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  TriangleCorners corners(const Triangle& t) const { return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]}; }

  bool intersect(int i, int j) const {
    Triangle s = triangles_[i], t = triangles_[j];
    switch (align(s, t)) {
      case 0:
        return meet(corners(s), corners(t));
      case 1:
        return meet_beyond_vertex(corners(s), corners(t));
      case 2:
        return meet_beyond_edge(corners(s), corners(t));
      default:
        return false;
    }
  }

  const std::vector<Vec3d>& vertices_;
  std::vector<Triangle> triangles_;
  std::vector<int> usable_;
};

}  // namespace

std::vector<std::array<int, 2>> self_intersections(const TriMesh& mesh, int most) { return Search(mesh).pairs(most); }

}  // namespace aspic

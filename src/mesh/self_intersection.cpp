#include "mesh/self_intersection.h"

#include <algorithm>

#include "mesh/box_tree.h"
#include "mesh/topology.h"
#include "mesh/triangle_shape.h"

namespace aspic {
namespace {

constexpr long kMaxCompared = 100'000'000;  // takes seconds

// Rotates both triangles so that their common vertices come first, in the same order. Returns the number of common
// vertices.
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
    omit_repeated();
  }

  SelfIntersections pairs(int max_pairs) const {
    std::vector<Box> boxes(usable_.size());
    for (size_t i = 0; i < usable_.size(); ++i)
      for (int v : triangles_[usable_[i]]) boxes[i].add(vertices_[v]);
    const BoxTree tree(boxes);
    std::vector<std::array<int, 2>> found;
    long compared = 0;
    const auto within_limits = [&] { return static_cast<int>(found.size()) < max_pairs && compared < kMaxCompared; };
    for (int i = 0; i < static_cast<int>(usable_.size()) && within_limits(); ++i)
      tree.for_each_overlap(boxes[i], [&](int j) {
        ++compared;
        if (j < i && intersect(usable_[j], usable_[i])) found.push_back({usable_[j], usable_[i]});
        return within_limits();
      });
    const bool is_complete = within_limits();
    std::sort(found.begin(), found.end());
    return {std::move(found), is_complete};
  }

 private:
  // Omits triangles that repeat the corners of an earlier one, because a pile of them would need all pairs.
  void omit_repeated() {
    const auto sorted = [this](int t) {
      Triangle triangle = triangles_[t];
      std::sort(triangle.begin(), triangle.end());
      return triangle;
    };
    std::stable_sort(usable_.begin(), usable_.end(), [&](int s, int t) { return sorted(s) < sorted(t); });
    const auto is_same = [&](int s, int t) { return sorted(s) == sorted(t); };
    usable_.erase(std::unique(usable_.begin(), usable_.end(), is_same), usable_.end());
    std::sort(usable_.begin(), usable_.end());
  }

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

SelfIntersections self_intersections(const TriMesh& mesh, int max_pairs) { return Search(mesh).pairs(max_pairs); }

}  // namespace aspic

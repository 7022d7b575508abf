// Binary tree of axis-aligned boxes over items in Morton order. Finds the items whose boxes overlap a box, are near a
// point, or lie on a ray.
#pragma once
#include <span>
#include <vector>

#include "mesh/box.h"

namespace aspic {

class BoxTree {
 public:
  explicit BoxTree(std::span<const Box> boxes);
  std::span<const int> items() const { return items_; }  // in Morton order

  // Calls visit(item) for the items whose box overlaps `box` until it returns false.
  template <class Visit>
  void for_each_overlap(const Box& box, Visit visit) const {
    if (!items_.empty()) overlap({0, 0, static_cast<int>(items_.size())}, box, visit);
  }

  // Calls visit(item) for the items whose box has a squared distance of at most `reach` from x, roughly from near to
  // far. `visit` may lower `reach`.
  template <class Visit>
  void for_each_near(const Vec3d& x, const double& reach, Visit visit) const {
    if (!items_.empty()) near({0, 0, static_cast<int>(items_.size())}, x, reach, visit);
  }

  // Calls visit(item) for the items whose box the ray enters at a parameter of at most `reach`, which visit may lower.
  template <class Visit>
  void for_each_on_ray(const Vec3d& origin, const Vec3d& direction, const double& reach, Visit visit) const {
    if (!items_.empty()) along({0, 0, static_cast<int>(items_.size())}, origin, direction, reach, visit);
  }

 private:
  // A node and its items [begin, end). Its left child follows it; a subtree of n items has 2 n - 1 nodes.
  struct Node {
    int index, begin, end;
    bool is_leaf() const { return end - begin == 1; }
    int middle() const { return begin + (end - begin) / 2; }
    Node left() const { return {index + 1, begin, middle()}; }
    Node right() const { return {index + 2 * (middle() - begin), middle(), end}; }
  };

  Box bound(Node node, std::span<const Box> boxes);

  template <class Visit>
  bool overlap(Node node, const Box& box, Visit& visit) const {
    if (!bounds_[node.index].overlaps(box)) return true;
    if (node.is_leaf()) return visit(items_[node.begin]);
    return overlap(node.left(), box, visit) && overlap(node.right(), box, visit);
  }

  template <class Visit>
  void near(Node node, const Vec3d& x, const double& reach, Visit& visit) const {
    if (node.is_leaf()) return visit(items_[node.begin]);
    Node first = node.left(), second = node.right();
    double to_first = bounds_[first.index].squared_distance(x), to_second = bounds_[second.index].squared_distance(x);
    if (to_second < to_first) std::swap(first, second), std::swap(to_first, to_second);
    if (to_first <= reach) near(first, x, reach, visit);
    if (to_second <= reach) near(second, x, reach, visit);
  }

  template <class Visit>
  void along(Node node, const Vec3d& origin, const Vec3d& direction, const double& reach, Visit& visit) const {
    const double entry = bounds_[node.index].entry(origin, direction);
    if (!(entry <= reach) || entry == Box::kInfinity) return;
    if (node.is_leaf()) return visit(items_[node.begin]);
    along(node.left(), origin, direction, reach, visit);
    along(node.right(), origin, direction, reach, visit);
  }

  std::vector<int> items_;
  std::vector<Box> bounds_;  // in preorder
};

}  // namespace aspic

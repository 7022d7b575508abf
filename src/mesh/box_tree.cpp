#include "mesh/box_tree.h"

#include "mesh/order.h"

namespace aspic {

BoxTree::BoxTree(std::span<const Box> boxes) {
  std::vector<Vec3d> centers;
  centers.reserve(boxes.size());
  for (const Box& box : boxes) centers.push_back(0.5 * box.lower + 0.5 * box.upper);
  items_ = morton_order(centers);
  if (items_.empty()) return;
  bounds_.resize(2 * items_.size() - 1);
  bound({0, 0, static_cast<int>(items_.size())}, boxes);
}

Box BoxTree::bound(Node node, std::span<const Box> boxes) {
  Box& box = bounds_[node.index];
  if (node.is_leaf()) return box = boxes[items_[node.begin]];
  box = bound(node.left(), boxes);
  const Box right = bound(node.right(), boxes);
  box.add(right.lower);
  box.add(right.upper);
  return box;
}

}  // namespace aspic

#include "mesh/box_tree.h"

#include "base/parallel.h"
#include "mesh/order.h"

namespace aspic {

BoxTree::BoxTree(std::span<const Box> boxes) {
  std::vector<Vec3d> centers;
  centers.reserve(boxes.size());
  for (const Box& box : boxes) centers.push_back(0.5 * box.lower + 0.5 * box.upper);
  items_ = morton_order(centers);
  if (items_.empty()) return;
  bounds_.resize(2 * items_.size() - 1);
  leaves_.resize(items_.size());
  add_parts(root());
  refit(boxes);
}

void BoxTree::refit(std::span<const Box> boxes) {
  parallel_for(part_count(), [&](int part) { bound(parts_[part], boxes, 0); });
  if (!items_.empty()) bound(root(), boxes, kPart);
}

void BoxTree::add_parts(Node node) {
  if (node.count() <= kPart) return parts_.push_back(node);
  add_parts(node.left());
  add_parts(node.right());
}

void BoxTree::bound(Node node, std::span<const Box> boxes, int above) {
  if (node.count() <= above) return;
  Box& box = bounds_[node.index];
  if (node.is_leaf()) {
    leaves_[node.begin] = box = boxes[items_[node.begin]];
    return;
  }
  bound(node.left(), boxes, above);
  bound(node.right(), boxes, above);
  box = bounds_[node.left().index];
  const Box& right = bounds_[node.right().index];
  box.add(right.lower);
  box.add(right.upper);
}

double BoxTree::looseness() const {
  const auto sides = [](std::span<const Box> boxes) {
    double sum = 0;
    for (const Box& box : boxes)
      for (int axis = 0; axis < 3; ++axis) sum += std::max(box.upper[axis] - box.lower[axis], 0.0);  // 0: empty
    return sum;
  };
  const double of_items = sides(leaves_);
  return of_items > 0 ? sides(bounds_) / of_items : 0;
}

}  // namespace aspic

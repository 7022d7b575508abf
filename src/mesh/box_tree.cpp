#include "mesh/box_tree.h"

#include "base/parallel.h"
#include "mesh/order.h"

namespace aspic {

template <class B>
BoxTreeOf<B>::BoxTreeOf(std::span<const B> boxes) {
  std::vector<Vec3d> centers;
  centers.reserve(boxes.size());
  for (const B& box : boxes) centers.push_back(box.center());
  items_ = morton_order(centers);
  if (items_.empty()) return;
  bounds_.resize(2 * items_.size() - 1);
  leaves_.resize(items_.size());
  add_parts(root());
  refit(boxes);
}

template <class B>
void BoxTreeOf<B>::refit(std::span<const B> boxes) {
  parallel_for(part_count(), [&](int part) {
    const auto [index, begin, end] = parts_[part];
    bool is_equal = true;
    for (int i = begin; i < end && is_equal; ++i) is_equal = leaves_[i] == boxes[items_[i]];
    if (!is_equal) bound(parts_[part], boxes, 0);
  });
  if (!items_.empty()) bound(root(), boxes, kPart);
}

template <class B>
void BoxTreeOf<B>::add_parts(Node node) {
  if (node.count() <= kPart) return parts_.push_back(node);
  add_parts(node.left());
  add_parts(node.right());
}

template <class B>
void BoxTreeOf<B>::bound(Node node, std::span<const B> boxes, int above) {
  if (node.count() <= above) return;
  B& box = bounds_[node.index];
  if (node.is_leaf()) {
    leaves_[node.begin] = box = boxes[items_[node.begin]];
    return;
  }
  bound(node.left(), boxes, above);
  bound(node.right(), boxes, above);
  box = bounds_[node.left().index];
  box.merge(bounds_[node.right().index]);
}

template <class B>
double BoxTreeOf<B>::looseness() const {
  const auto sides = [](std::span<const B> boxes) {
    double sum = 0;
    for (const B& box : boxes) sum += box.sides();
    return sum;
  };
  const double of_items = sides(leaves_);
  return of_items > 0 ? sides(bounds_) / of_items : 0;
}

template class BoxTreeOf<Box>;
template class BoxTreeOf<SweptBox>;

}  // namespace aspic

// Binary tree of axis-aligned boxes, at rest or moving, over items in Morton order. Finds the items whose boxes overlap
// a box or those of another tree, are near a point, or lie on a ray.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "mesh/swept_box.h"

namespace aspic {

template <class B>
class BoxTreeOf {
 public:
  explicit BoxTreeOf(std::span<const B> boxes);
  std::span<const int> items() const { return items_; }  // in Morton order

  // Replaces the boxes of the items and keeps their order. Requires as many boxes as before. Queries stay correct, but
  // visit more nodes after the items have moved past each other.
  void refit(std::span<const B> boxes);
  // Returns the sum of the sides of all boxes of the tree, relative to that of the items. It grows as the order
  // degrades.
  double looseness() const;

  B bounds() const { return items_.empty() ? B{} : bounds_[root().index]; }  // box around all items

  // Calls visit(item) for the items whose box overlaps `box` until it returns false.
  template <class Visit>
  void for_each_overlap(const Box& box, Visit visit) const {
    if (!items_.empty()) overlap(root(), box, visit);
  }

  // Calls visit(item, other_item) for each pair of an item in part `part` of this tree and an item of `other` with
  // overlapping boxes, until it returns false. Parts consist of consecutive items, and threads may process them
  // concurrently.
  int part_count() const { return static_cast<int>(parts_.size()); }
  template <class Visit>
  void for_each_pair(int part, const BoxTreeOf& other, Visit visit) const {
    if (!other.items_.empty()) pairs<false>(parts_[part], other, other.root(), visit);
  }
  // The same for pairs of items of this tree. Each pair is visited once over all parts.
  template <class Visit>
  void for_each_own_pair(int part, Visit visit) const {
    pairs<true>(parts_[part], *this, root(), visit);
  }

  // Calls visit(item) for the items whose box has a squared distance of at most `reach` from x, roughly by ascending
  // distance. `visit` may lower `reach`.
  template <class Visit>
  void for_each_near(const Vec3d& x, const double& reach, Visit visit) const {
    if (!items_.empty()) near(root(), x, reach, visit);
  }

  // Calls visit(item) for the items whose box the ray enters at a parameter of at most `reach`, which `visit` may
  // lower.
  template <class Visit>
  void for_each_on_ray(const Vec3d& origin, const Vec3d& direction, const double& reach, Visit visit) const {
    if (!items_.empty()) along(root(), origin, direction, reach, visit);
  }

 private:
  static constexpr int kPart = 64;  // items per part; enough work for a thread
  static constexpr int kBlock = 4;  // nodes with up to this many items are tested pair by pair

  // A node and its items [begin, end). Its left child follows it; a subtree of n items has 2 n - 1 nodes.
  struct Node {
    int index, begin, end;
    int count() const { return end - begin; }
    bool is_leaf() const { return count() == 1; }
    int middle() const { return begin + (end - begin) / 2; }
    Node left() const { return {index + 1, begin, middle()}; }
    Node right() const { return {index + 2 * (middle() - begin), middle(), end}; }
  };

  Node root() const { return {0, 0, static_cast<int>(items_.size())}; }
  void add_parts(Node node);
  // Computes the bounds of the nodes below `node` with more than `above` items, given those of the smaller nodes.
  void bound(Node node, std::span<const B> boxes, int above);

  // Descends into the node with more items. A pair of items of one tree is visited where the first item comes earlier.
  template <bool kIsOwn, class Visit>
  bool pairs(Node node, const BoxTreeOf& tree, Node other, Visit& visit) const {
    if (kIsOwn && other.end <= node.begin + 1) return true;
    if (!bounds_[node.index].overlaps(tree.bounds_[other.index])) return true;
    if (node.count() <= kBlock && other.count() <= kBlock) return block_pairs<kIsOwn>(node, tree, other, visit);
    if (node.count() > other.count())
      return pairs<kIsOwn>(node.left(), tree, other, visit) && pairs<kIsOwn>(node.right(), tree, other, visit);
    return pairs<kIsOwn>(node, tree, other.left(), visit) && pairs<kIsOwn>(node, tree, other.right(), visit);
  }

  template <bool kIsOwn, class Visit>
  bool block_pairs(Node node, const BoxTreeOf& tree, Node other, Visit& visit) const {
    for (int i = node.begin; i < node.end; ++i)
      for (int j = kIsOwn ? std::max(other.begin, i + 1) : other.begin; j < other.end; ++j)
        if (leaves_[i].overlaps(tree.leaves_[j]) && !visit(items_[i], tree.items_[j])) return false;
    return true;
  }

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
  std::vector<B> bounds_;    // bounds of the nodes in preorder
  std::vector<B> leaves_;    // boxes of items_
  std::vector<Node> parts_;  // the largest subtrees of at most kPart items
};

using BoxTree = BoxTreeOf<Box>;
using SweptBoxTree = BoxTreeOf<SweptBox>;

}  // namespace aspic

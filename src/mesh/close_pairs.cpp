#include "mesh/close_pairs.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/parallel.h"

namespace aspic {
namespace {

constexpr double kMaxLoose = 1.5;  // looseness relative to a new tree at which a tree is rebuilt

using Pairs = std::vector<std::array<int, 2>>;

double largest_component(const Vec3d& x) { return std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])}); }

// Inflates the box of points that move by up to `length` by the radius, and rounds outward.
void inflate(Box& box, double radius, double length) {
  constexpr double kOutward = 4 * std::numeric_limits<double>::epsilon();
  for (int axis = 0; axis < 3; ++axis) {
    const double largest = std::max(std::abs(box.lower[axis]), std::abs(box.upper[axis]));
    const double by = radius + kOutward * (largest + length + radius);
    box.lower[axis] -= by;
    box.upper[axis] += by;
  }
}

bool is_finite(const Vec3d& x) {
  return std::all_of(x.a, x.a + 3, [](double xi) { return std::isfinite(xi); });
}

template <class Points>
SweptBox primitive_box(const Points& points, const PairQuery& query, double radius) {
  SweptBox box{.is_new = query.is_new.empty()};
  double by = 0, length = 0;
  for (const int point : points) {
    const Vec3d move = query.dx.empty() ? Vec3d{} : query.dx[point];
    if (!is_finite(query.x[point]) || !is_finite(move)) return {};
    box.start.add(query.x[point]);
    box.move.add(move);
    length = std::max(length, largest_component(move));
    if (!query.by.empty()) by = std::max(by, query.by[point]);
    box.is_new |= !query.is_new.empty() && query.is_new[point];
  }
  inflate(box.start, radius + by, length);
  return box;
}

// `points_of(i)` returns the positions of primitive i as a range of indices.
template <class PointsOf>
void bound_primitives(const PointsOf& points_of, const PairQuery& query, std::span<const double> radius,
                      std::vector<SweptBox>& boxes) {
  ASPIC_CHECK(radius.empty() || radius.size() == boxes.size());
  parallel_chunks(static_cast<int>(boxes.size()), [&](int first, int last) {
    for (int i = first; i < last; ++i) boxes[i] = primitive_box(points_of(i), query, radius.empty() ? 0 : radius[i]);
  });
}

template <class A, class B>
bool share_point(const A& a, const B& b) {
  for (const int i : a)
    for (const int j : b)
      if (i == j) return true;
  return false;
}

// Collects pairs from several threads. Stops them when more than `limit` pairs are found.
class PairCollector {
 public:
  PairCollector(int parts, size_t limit) : found_(parts), limit_(limit) {}

  // Returns whether the search continues.
  bool add(int part, int a, int b) {
    found_[part].push_back({a, b});
    if (found_[part].size() % kBatch == 0) count_ += kBatch;
    return count_ <= limit_;
  }

  bool overflows() const {
    size_t sum = 0;
    for (const Pairs& part : found_) sum += part.size();
    return sum > limit_;
  }

  // Sorts the pairs by a counting sort of the first members, of which there are `firsts`, then by the second members.
  Pairs sorted(int firsts) const {
    std::vector<size_t> start(firsts + 1, 0);
    for (const Pairs& part : found_)
      for (const auto& [a, b] : part) ++start[a + 1];
    for (int i = 0; i < firsts; ++i) start[i + 1] += start[i];
    Pairs all(start[firsts]);
    std::vector<size_t> next(start.begin(), start.end() - 1);
    for (const Pairs& part : found_)
      for (const auto& pair : part) all[next[pair[0]]++] = pair;
    parallel_chunks(firsts, [&](int first, int last) {
      for (int i = first; i < last; ++i)
        std::sort(all.begin() + static_cast<std::ptrdiff_t>(start[i]),
                  all.begin() + static_cast<std::ptrdiff_t>(start[i + 1]));
    });
    return all;
  }

 private:
  static constexpr size_t kBatch = 1024;

  std::vector<Pairs> found_;
  size_t limit_;
  std::atomic<size_t> count_ = 0;  // pairs in full batches
};

}  // namespace

void PairFinder::Tree::fit() {
  if (!tree.empty()) {
    tree.front().refit(boxes);
    if (!(tree.front().looseness() > kMaxLoose * looseness)) return;
    tree.clear();
  }
  tree.emplace_back(boxes);
  looseness = tree.front().looseness();
}

void PairFinder::place(const PairQuery& query) {
  vertices_.boxes.resize(primitives_.vertices.size());
  edges_.boxes.resize(primitives_.edges.size());
  triangles_.boxes.resize(primitives_.triangles.size());
  bound_primitives([&](int i) { return std::array<int, 1>{primitives_.vertices[i]}; }, query, query.vertex_radius,
                   vertices_.boxes);
  bound_primitives([&](int i) { return primitives_.edges[i]; }, query, query.edge_radius, edges_.boxes);
  bound_primitives([&](int i) { return primitives_.triangles[i]; }, query, query.triangle_radius, triangles_.boxes);
  for (Tree* tree : {&vertices_, &edges_, &triangles_}) tree->fit();
}

ClosePairs PairFinder::find(const PairQuery& query) {
  place(query);
  const auto& vertices = primitives_.vertices;
  const auto& edges = primitives_.edges;
  const auto& triangles = primitives_.triangles;
  const SweptBoxTree &of_vertices = *vertices_, &of_edges = *edges_;
  PairCollector vertex_triangle(of_vertices.part_count(), query.limit), edge_edge(of_edges.part_count(), query.limit);
  parallel_for(of_vertices.part_count(), [&](int part) {
    of_vertices.for_each_pair(part, *triangles_, [&](int v, int t) {
      if (share_point(std::array<int, 1>{vertices[v]}, triangles[t])) return true;
      if (query.filter && !query.filter->accepts_vertex_triangle(v, t)) return true;
      return vertex_triangle.add(part, v, t);
    });
  });
  parallel_for(of_edges.part_count(), [&](int part) {
    of_edges.for_each_own_pair(part, [&](int e, int f) {
      const auto [a, b] = std::minmax(e, f);
      if (share_point(edges[a], edges[b])) return true;
      if (query.filter && !query.filter->accepts_edge_edge(a, b)) return true;
      return edge_edge.add(part, a, b);
    });
  });
  if (vertex_triangle.overflows() || edge_edge.overflows()) return {.is_complete = false};
  return {vertex_triangle.sorted(static_cast<int>(vertices.size())), edge_edge.sorted(static_cast<int>(edges.size()))};
}

ClosePairs PairFinder::find_between(const PairFinder& other, bool has_edges, const PairFilter* filter,
                                    size_t limit) const {
  const SweptBoxTree &of_vertices = *vertices_, &of_edges = *edges_;
  PairCollector vertex_triangle(of_vertices.part_count(), limit), edge_edge(of_edges.part_count(), limit);
  parallel_for(of_vertices.part_count(), [&](int part) {
    of_vertices.for_each_pair(part, *other.triangles_, [&](int v, int t) {
      return (filter && !filter->accepts_vertex_triangle(v, t)) || vertex_triangle.add(part, v, t);
    });
  });
  if (has_edges)
    parallel_for(of_edges.part_count(), [&](int part) {
      of_edges.for_each_pair(part, *other.edges_, [&](int a, int b) {
        return (filter && !filter->accepts_edge_edge(a, b)) || edge_edge.add(part, a, b);
      });
    });
  if (vertex_triangle.overflows() || edge_edge.overflows()) return {.is_complete = false};
  return {vertex_triangle.sorted(static_cast<int>(primitives_.vertices.size())),
          edge_edge.sorted(static_cast<int>(primitives_.edges.size()))};
}

}  // namespace aspic

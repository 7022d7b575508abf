#include "mesh/topology.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "mesh/disjoint_sets.h"
#include "mesh/grouped_elements.h"

namespace aspic {
namespace {

void sort_unique(std::vector<int>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

int corner_of(const Triangle& triangle, int vertex) {
  return static_cast<int>(std::find(triangle.begin(), triangle.end(), vertex) - triangle.begin());
}

// Triangles around a vertex belong to one fan if they share an edge at it.
std::vector<int> vertices_with_several_fans(const std::vector<Triangle>& triangles, const std::vector<EdgeUse>& uses,
                                            int vertex_count) {
  DisjointSets fans(3 * static_cast<int>(triangles.size()));
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    for (const EdgeUse* use = first + 1; use < last; ++use)
      for (int v : first->edge)
        fans.join(3 * first->triangle + corner_of(triangles[first->triangle], v),
                  3 * use->triangle + corner_of(triangles[use->triangle], v));
  });
  std::vector<int> fan(vertex_count, -1), several;
  for (size_t t = 0; t < triangles.size(); ++t) {
    if (lists_vertex_twice(triangles[t])) continue;
    for (int c = 0; c < 3; ++c) {
      const int v = triangles[t][c], mine = fans.find(3 * static_cast<int>(t) + c);
      if (fan[v] >= 0 && fan[v] != mine) several.push_back(v);
      fan[v] = mine;
    }
  }
  sort_unique(several);
  return several;
}

int groups_of_open_edges(const std::vector<EdgeUse>& uses, int vertex_count) {
  DisjointSets groups(vertex_count);
  std::vector<int> ends;
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first != 1) return;
    groups.join(first->edge[0], first->edge[1]);
    ends.push_back(first->edge[0]);
  });
  for (int& v : ends) v = groups.find(v);
  sort_unique(ends);
  return static_cast<int>(ends.size());
}

}  // namespace

std::vector<int> first_at_same_place(const std::vector<Vec3d>& points) {
  const auto less = [&](int i, int j) {
    for (int axis = 0; axis < 3; ++axis)
      if (points[i][axis] != points[j][axis]) return points[i][axis] < points[j][axis];
    return i < j;
  };
  std::vector<int> order, first(points.size());
  std::iota(first.begin(), first.end(), 0);
  for (size_t i = 0; i < points.size(); ++i)
    if (std::isfinite(points[i][0] + points[i][1] + points[i][2])) order.push_back(static_cast<int>(i));
  std::sort(order.begin(), order.end(), less);
  for (size_t i = 1; i < order.size(); ++i) {
    const Vec3d &a = points[order[i - 1]], &b = points[order[i]];
    if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]) first[order[i]] = first[order[i - 1]];
  }
  return first;
}

std::vector<EdgeUse> edge_uses(const std::vector<Triangle>& triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t) {
    if (lists_vertex_twice(triangles[t])) continue;
    for (int c = 0; c < 3; ++c) {
      const int a = triangles[t][c], b = triangles[t][(c + 1) % 3];
      uses.push_back({{std::min(a, b), std::max(a, b)}, static_cast<int>(t), a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.triangle < b.triangle;
  });
  return uses;
}

SurfaceTopology topology(const std::vector<Triangle>& triangles, int vertex_count) {
  const std::vector<EdgeUse> uses = edge_uses(triangles);
  SurfaceTopology found;
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    std::vector<int>* list = nullptr;
    if (last - first == 1) {
      list = &found.open;
      ++found.open_edges;
    } else if (last - first > 2) {
      list = &found.non_manifold;
      ++found.non_manifold_edges;
    } else if (first[0].forward == first[1].forward) {
      list = &found.disagreeing;
    }
    for (const EdgeUse* use = first; list && use < last; ++use) list->push_back(use->triangle);
  });
  sort_unique(found.open);
  sort_unique(found.non_manifold);
  sort_unique(found.disagreeing);
  found.holes = groups_of_open_edges(uses, vertex_count);
  found.non_manifold_vertices = vertices_with_several_fans(triangles, uses, vertex_count);
  return found;
}

template <class Element>
std::vector<int> repeated_elements(const std::vector<Element>& elements) {
  int vertex_count = 0;
  for (const Element& element : elements)
    vertex_count = std::max(vertex_count, 1 + *std::max_element(element.begin(), element.end()));
  constexpr size_t kSize = std::tuple_size_v<Element>;
  const auto groups = grouped_elements<kSize>(vertex_count, [&](const auto& visit) {
    for (size_t e = 0; e < elements.size(); ++e)
      if (!lists_vertex_twice(elements[e])) visit(elements[e], static_cast<int>(e));
  });
  std::vector<int> repeated;
  for_each_group(groups, [&](const GroupedElement<kSize>* begin, const GroupedElement<kSize>* end) {
    for (const GroupedElement<kSize>* e = begin + 1; e < end; ++e) repeated.push_back(e->place);
  });
  std::sort(repeated.begin(), repeated.end());
  return repeated;
}
template std::vector<int> repeated_elements(const std::vector<Triangle>&);
template std::vector<int> repeated_elements(const std::vector<Tet>&);

}  // namespace aspic

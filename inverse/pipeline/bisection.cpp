#include "pipeline/bisection.h"

#include <algorithm>
#include <iterator>

#include "mesh/tet_nodes.h"

namespace aspic {

std::vector<int> united(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

BisectedMesh::BisectedMesh(std::vector<Vec3d> rest, const std::vector<Tet>& tets) : rest_(std::move(rest)) {
  for (int v = 0; v < static_cast<int>(rest_.size()); ++v) support_.push_back({v});
  for (int t = 0; t < static_cast<int>(tets.size()); ++t) parts_.push_back({tets[t], t, 0});
}

void BisectedMesh::bisect(const std::function<bool(const Part&)>& is_wanted) {
  const size_t count = parts_.size();
  for (size_t i = 0; i < count; ++i)
    if (is_wanted(parts_[i])) split(i);
  // Each round splits edges at least as long as those of the neighbors, so it ends.
  for (bool is_done = false; !is_done;) {
    is_done = true;
    for (size_t i = 0, end = parts_.size(); i < end; ++i)
      if (has_split_edge(parts_[i].tet)) split(i), is_done = false;
  }
}

std::vector<Midpoint> BisectedMesh::midpoints() const {
  std::vector<Midpoint> all;
  for (const auto& [edge, vertex] : middle_) all.push_back({vertex, edge.first, edge.second});
  std::sort(all.begin(), all.end(), [](const Midpoint& m, const Midpoint& n) { return m.vertex < n.vertex; });
  return all;
}

double BisectedMesh::longest_edge(const Tet& tet) const {
  const auto [a, b] = longest(tet);
  return norm(rest_[a] - rest_[b]);
}

// Equal lengths are ordered by the vertices, the same in all tets of an edge.
BisectedMesh::Edge BisectedMesh::longest(const Tet& tet) const {
  std::pair<double, Edge> best = {-1, {}};
  for (const auto& [i, j] : kTetEdges) {
    const Edge edge = std::minmax({tet[i], tet[j]});
    best = std::max(best, {squared_norm(rest_[edge.first] - rest_[edge.second]), edge});
  }
  return best.second;
}

bool BisectedMesh::has_split_edge(const Tet& tet) const {
  return std::any_of(std::begin(kTetEdges), std::end(kTetEdges), [&](const auto& edge) {
    return middle_.count(std::minmax({tet[edge[0]], tet[edge[1]]})) > 0;
  });
}

void BisectedMesh::split(size_t part) {
  const Edge edge = longest(parts_[part].tet);
  const auto [place, is_new] = middle_.try_emplace(edge, static_cast<int>(rest_.size()));
  if (is_new) {
    rest_.push_back(0.5 * (rest_[edge.first] + rest_[edge.second]));
    support_.push_back(united(support_[edge.first], support_[edge.second]));
  }
  ++parts_[part].generation;
  Part other = parts_[part];
  std::replace(parts_[part].tet.begin(), parts_[part].tet.end(), edge.first, place->second);
  std::replace(other.tet.begin(), other.tet.end(), edge.second, place->second);
  parts_.push_back(other);
}

}  // namespace aspic

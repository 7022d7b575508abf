#include "sharp_edges.h"

#include <algorithm>
#include <cmath>

#include "mesh/topology.h"
#include "triangle_tree.h"

namespace aspic {
namespace {

using Chain = std::vector<int>;  // vertices; closed chains begin and end with the same vertex

constexpr double kSharp = 0.643;   // cosine of 50 degrees, between the normals at an edge
constexpr double kBlade = -0.94;   // minus the cosine of 20 degrees, between the normals at an edge
constexpr double kStraight = 0.5;  // cosine of 60 degrees, between two edges of a chain

// Edges whose adjacent normals have a cosine less than `most`.
std::vector<std::array<int, 2>> sharp_edges(const TriMesh& body, double most) {
  std::vector<std::array<int, 2>> edges;
  for_each_edge(edge_uses(body.triangles), [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first == 2 && dot(unit_normal(body, first[0].triangle), unit_normal(body, first[1].triangle)) < most)
      edges.push_back(first->edge);
  });
  return edges;
}

double distance(const TriMesh& body, int a, int b) {
  const Vec3d edge = body.vertices[b] - body.vertices[a];
  return norm(edge);
}

double chain_length(const TriMesh& body, const Chain& chain) {
  double sum = 0;
  for (size_t i = 1; i < chain.size(); ++i) sum += distance(body, chain[i - 1], chain[i]);
  return sum;
}

// Graph of sharp edges, split into chains at corners.
class SharpGraph {
 public:
  SharpGraph(const TriMesh& body, const std::vector<std::array<int, 2>>& edges)
      : body_(body), edges_(edges), next_(body.vertices.size()), used_(edges.size()) {
    for (size_t e = 0; e < edges.size(); ++e)
      for (int v : edges[e]) next_[v].push_back(static_cast<int>(e));
  }

  size_t degree(int v) const { return next_[v].size(); }

  std::vector<Chain> chains() {
    std::vector<Chain> chains;
    for (size_t v = 0; v < next_.size(); ++v)
      if (is_corner(static_cast<int>(v)))
        for (int e : next_[v])
          if (!used_[e]) chains.push_back(walk(static_cast<int>(v), e));
    for (size_t e = 0; e < edges_.size(); ++e)  // the remaining edges form closed chains
      if (!used_[e]) chains.push_back(walk(edges_[e][0], static_cast<int>(e)));
    return chains;
  }

 private:
  int other(int edge, int v) const { return edges_[edge][edges_[edge][0] == v]; }

  bool is_corner(int v) const {
    if (next_[v].empty()) return false;
    if (next_[v].size() != 2) return true;
    const Vec3d &x = body_.vertices[v], &a = body_.vertices[other(next_[v][0], v)],
                &b = body_.vertices[other(next_[v][1], v)];
    const Vec3d in = x - a, out = b - x;
    return dot(in, out) < kStraight * std::sqrt(dot(in, in) * dot(out, out));
  }

  Chain walk(int start, int edge) {
    Chain chain = {start};
    for (int v = start;;) {
      used_[edge] = true;
      v = other(edge, v);
      chain.push_back(v);
      if (v == start || is_corner(v)) return chain;
      const int following = next_[v][next_[v][0] == edge];
      if (used_[following]) return chain;
      edge = following;
    }
  }

  const TriMesh& body_;
  const std::vector<std::array<int, 2>>& edges_;
  std::vector<std::vector<int>> next_;  // sharp edges at each vertex
  std::vector<char> used_;
};

// Removes the edges of short chains with a free end. Returns whether there were any.
bool prune(const TriMesh& body, double shortest, std::vector<std::array<int, 2>>& edges) {
  SharpGraph graph(body, edges);
  std::vector<std::array<int, 2>> gone;
  for (const Chain& chain : graph.chains()) {
    const bool is_free = graph.degree(chain.front()) == 1 || graph.degree(chain.back()) == 1;
    const bool is_small_loop = chain.front() == chain.back();
    if (!(is_free || is_small_loop) || chain_length(body, chain) >= shortest) continue;
    for (size_t i = 1; i < chain.size(); ++i)
      gone.push_back({std::min(chain[i - 1], chain[i]), std::max(chain[i - 1], chain[i])});
  }
  std::sort(gone.begin(), gone.end());
  std::erase_if(edges, [&](const auto& edge) { return std::binary_search(gone.begin(), gone.end(), edge); });
  return !gone.empty();
}

// Marks chains that leave a common corner at a small angle, because the balls that protect them would shrink forever.
std::vector<bool> in_needles(const TriMesh& body, const std::vector<Chain>& chains) {
  constexpr double kNeedle = 0.94;  // cosine of 20 degrees
  struct End {
    int corner;
    Vec3d direction;
    size_t chain;
  };
  std::vector<End> ends;
  const auto add = [&](int corner, int next, size_t chain) {
    const Vec3d edge = body.vertices[next] - body.vertices[corner];
    ends.push_back({corner, (1 / norm(edge)) * edge, chain});
  };
  for (size_t c = 0; c < chains.size(); ++c) {
    add(chains[c].front(), chains[c][1], c);
    add(chains[c].back(), chains[c][chains[c].size() - 2], c);
  }
  std::stable_sort(ends.begin(), ends.end(), [](const End& a, const End& b) { return a.corner < b.corner; });
  std::vector<bool> result(chains.size());
  for (size_t i = 0; i < ends.size(); ++i)
    for (size_t j = i + 1; j < ends.size() && ends[j].corner == ends[i].corner; ++j)
      if (dot(ends[i].direction, ends[j].direction) > kNeedle) result[ends[i].chain] = result[ends[j].chain] = true;
  return result;
}

}  // namespace

std::vector<std::vector<Vec3d>> sharp_chains(const TriMesh& body, double size) {
  std::vector<std::array<int, 2>> edges = sharp_edges(body, kSharp);
  while (prune(body, size / 2, edges)) {
  }
  const std::vector<Chain> chains = SharpGraph(body, edges).chains();
  constexpr long kFew = 12;
  const long tiny = std::count_if(chains.begin(), chains.end(),
                                  [&](const Chain& chain) { return chain_length(body, chain) < size / 4; });
  if (tiny > kFew && 4 * tiny > static_cast<long>(chains.size())) return {};
  const std::vector<bool> is_in_needle = in_needles(body, chains);
  std::vector<std::vector<Vec3d>> lines;
  for (size_t c = 0; c < chains.size(); ++c) {
    if (is_in_needle[c]) continue;
    std::vector<Vec3d>& line = lines.emplace_back();
    for (int v : chains[c]) line.push_back(body.vertices[v]);
  }
  return lines;
}

bool has_blade(const TriMesh& body) { return !sharp_edges(body, kBlade).empty(); }

}  // namespace aspic

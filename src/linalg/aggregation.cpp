#include "linalg/aggregation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.h"

namespace aspic {
namespace {

constexpr size_t kMinSize = 5;  // vertices; an affine displacement is determined by four
constexpr double kCellsPerSide =
    0.9;  // maximum length in units of edge length * cbrt(size): affine displacements cannot bend

class Aggregation {
 public:
  explicit Aggregation(const AggregationInput& input) : in_(input), group_(input.graph.vertex_count(), -1) {}

  Aggregates run() {
    std::vector<int> vertices;
    for (int v = 0; v < in_.graph.vertex_count(); ++v)
      if (in_.excluded.empty() || in_.excluded[v] == 0) vertices.push_back(v);
    bisect(vertices);
    split_into_components(vertices);
    merge_small_groups();
    return collect();
  }

 private:
  bool is_strong(int v, int w) const { return in_.modulus.empty() || !is_modulus_jump(in_.modulus[v], in_.modulus[w]); }

  struct Side {
    int axis = 0;
    double length = 0;
  };
  Side longest_side(std::span<const int> part) const {
    Vec3d low = in_.position[part[0]], high = low;
    for (const int v : part)
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], in_.position[v][k]);
        high[k] = std::max(high[k], in_.position[v][k]);
      }
    int longest = 0;
    for (int k = 1; k < 3; ++k)
      if (high[k] - low[k] > high[longest] - low[longest]) longest = k;
    return {longest, high[longest] - low[longest]};
  }

  // Returns the mean length of the edges at the vertices of the part.
  double edge_length(std::span<const int> part) const {
    double sum = 0;
    int64_t count = 0;
    for (const int v : part)
      for (const int w : in_.graph.around(v)) {
        const Vec3d e = in_.position[w] - in_.position[v];
        sum += norm(e);
        ++count;
      }
    return count > 0 ? sum / static_cast<double>(count) : 0;
  }

  void bisect(std::span<int> part) {
    if (part.empty()) return;
    const Side side = longest_side(part);
    const double reach = kCellsPerSide * std::cbrt(in_.size) * edge_length(part);
    int parts = std::max<int>(1, static_cast<int>((part.size() + in_.size / 2) / in_.size));
    if (parts == 1 && part.size() >= 2 * kMinSize && side.length > reach) parts = 2;
    if (parts == 1) {
      for (const int v : part) group_[v] = groups_;
      ++groups_;
      return;
    }
    const int k = side.axis;
    const size_t half = part.size() * (parts / 2) / parts;
    std::nth_element(part.begin(), part.begin() + half, part.end(),
                     [&](int v, int w) { return std::pair(in_.position[v][k], v) < std::pair(in_.position[w][k], w); });
    bisect(part.first(half));
    bisect(part.subspan(half));
  }

  // Replaces the groups by the connected components of their strong couplings.
  void split_into_components(std::span<const int> vertices) {
    std::vector<int> component(group_.size(), -1), stack;
    groups_ = 0;
    for (const int seed : vertices) {
      if (component[seed] >= 0) continue;
      component[seed] = groups_;
      stack.push_back(seed);
      while (!stack.empty()) {
        const int v = stack.back();
        stack.pop_back();
        for (const int w : in_.graph.around(v))
          if (group_[w] == group_[v] && component[w] < 0 && is_strong(v, w)) {
            component[w] = groups_;
            stack.push_back(w);
          }
      }
      ++groups_;
    }
    group_ = std::move(component);
  }

  void merge_small_groups() {
    std::vector<std::vector<int>> members(groups_);
    for (int v = 0; v < in_.graph.vertex_count(); ++v)
      if (group_[v] >= 0) members[group_[v]].push_back(v);
    std::vector<int> touches(groups_, 0), touched;
    for (int g = 0; g < groups_; ++g) {
      if (members[g].size() >= kMinSize) continue;
      touched.clear();
      for (const int v : members[g])
        for (const int w : in_.graph.around(v))
          if (group_[w] >= 0 && group_[w] != g && is_strong(v, w) && touches[group_[w]]++ == 0)
            touched.push_back(group_[w]);
      int best = -1;
      for (const int other : touched)
        if (best < 0 || touches[other] > touches[best]) best = other;
      for (const int other : touched) touches[other] = 0;
      if (best < 0) continue;
      for (const int v : members[g]) group_[v] = best;
      members[best].insert(members[best].end(), members[g].begin(), members[g].end());
      members[g].clear();
    }
  }

  Aggregates collect() const {
    Aggregates result;
    std::vector<int> number(groups_, -1);
    int count = 0;
    result.of_vertex = group_;
    for (int& g : result.of_vertex) {
      if (g < 0) continue;
      if (number[g] < 0) number[g] = count++;
      g = number[g];
    }
    result.start.assign(count + 1, 0);
    for (const int g : result.of_vertex)
      if (g >= 0) ++result.start[g + 1];
    std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
    result.member.resize(result.start[count]);
    std::vector<int> next(result.start.begin(), result.start.end() - 1);
    for (size_t v = 0; v < result.of_vertex.size(); ++v)
      if (result.of_vertex[v] >= 0) result.member[next[result.of_vertex[v]]++] = static_cast<int>(v);
    return result;
  }

  const AggregationInput& in_;
  std::vector<int> group_;
  int groups_ = 0;
};

}  // namespace

Aggregates make_aggregates(const AggregationInput& input) {
  ASPIC_CHECK(input.size >= 1 && input.position.size() + 1 == input.graph.start.size());
  ASPIC_CHECK(input.modulus.empty() || input.modulus.size() == input.position.size());
  ASPIC_CHECK(input.excluded.empty() || input.excluded.size() == input.position.size());
  return Aggregation(input).run();
}

}  // namespace aspic

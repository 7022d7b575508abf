#include "ranks/rank_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "dynamics/stiffness_parts.h"
#include "mesh/disjoint_sets.h"
#include "ranks/exchange.h"

namespace aspic::distributed {
namespace {

// Values per vertex whose ghosts are those of their owners.
class VertexValues {
 public:
  VertexValues(const MeshShare& share, Halo& halo)
      : halo_(halo), values_(3 * static_cast<size_t>(share.local_vertices())) {}
  double& operator[](int v) { return values_[3 * static_cast<size_t>(v)]; }
  void update() { halo_.update(values_); }

 private:
  Halo& halo_;
  std::vector<double> values_;
};

// Sets each value to the smallest vertex of its connected component, in the numbers of the whole mesh.
void label_components(const TetMesh& local, const MeshShare& share, VertexValues& label) {
  DisjointSets sets(share.local_vertices());
  for (const Tet& tet : local.tets)
    for (const int v : tet) sets.join(tet[0], v);
  for (int v = 0; v < share.local_vertices(); ++v) label[v] = share.vertex[v];
  std::vector<double> smallest(share.local_vertices());
  std::int64_t changes = 1;
  while (changes > 0) {
    changes = 0;
    for (int v = 0; v < share.local_vertices(); ++v) smallest[v] = label[v];
    for (int v = 0; v < share.local_vertices(); ++v) {
      double& least = smallest[sets.find(v)];
      least = std::min(least, label[v]);
    }
    for (int v = 0; v < share.local_vertices(); ++v) {
      const double least = smallest[sets.find(v)];
      if (least < label[v]) ++changes;
      label[v] = least;
    }
    label.update();
    sum_over_ranks({&changes, 1});
  }
}

struct Entry {
  double component;
  int level;
  int vertex;        // smallest one
  double stiffness;  // largest one
};

// Returns the largest stiffness of each component.
std::map<double, double> stiffest_of(const std::map<double, double>& own) {
  std::vector<Entry> entries;
  for (const auto& [component, stiffness] : own) entries.push_back({component, 0, 0, stiffness});
  std::map<double, double> stiffest;
  for (const Entry& entry : gather_all(entries)) {
    double& largest = stiffest.try_emplace(entry.component, entry.stiffness).first->second;
    largest = std::max(largest, entry.stiffness);
  }
  return stiffest;
}

using Part = std::pair<double, int>;  // component and level

// Numbers the parts in the order of their first vertices.
std::map<Part, int> numbers_of(const std::map<Part, int>& first_own) {
  std::vector<Entry> entries;
  for (const auto& [part, vertex] : first_own) entries.push_back({part.first, part.second, vertex, 0});
  std::map<Part, int> first;
  for (const Entry& entry : gather_all(entries)) {
    int& vertex = first.try_emplace({entry.component, entry.level}, entry.vertex).first->second;
    vertex = std::min(vertex, entry.vertex);
  }
  std::vector<std::pair<int, Part>> order;
  for (const auto& [part, vertex] : first) order.emplace_back(vertex, part);
  std::sort(order.begin(), order.end());
  std::map<Part, int> number;
  for (const auto& [_, part] : order) number.emplace(part, static_cast<int>(number.size()));
  return number;
}

}  // namespace

std::vector<int> parts_of_ranks(const TetMesh& local, const MeshShare& share, Halo& halo,
                                std::span<const double> modulus) {
  VertexValues component(share, halo);
  label_components(local, share, component);
  std::vector<double> stiffness = longest_edge(local);
  std::map<double, double> stiffest_own;
  for (int v = 0; v < share.own(); ++v) {
    stiffness[v] *= modulus[v];
    double& largest = stiffest_own.try_emplace(component[v], 0).first->second;
    if (std::isfinite(stiffness[v])) largest = std::max(largest, stiffness[v]);
  }
  const std::map<double, double> stiffest = stiffest_of(stiffest_own);
  std::map<Part, int> first_own;
  std::vector<Part> of_vertex;
  for (int v = 0; v < share.own(); ++v) {
    of_vertex.emplace_back(component[v], softness_level(stiffest.at(component[v]), stiffness[v]));
    first_own.try_emplace(of_vertex.back(), share.first() + v);
  }
  const std::map<Part, int> number = numbers_of(first_own);
  VertexValues part(share, halo);
  for (int v = 0; v < share.own(); ++v) part[v] = number.at(of_vertex[v]);
  part.update();
  std::vector<int> result;
  for (int v = 0; v < share.local_vertices(); ++v) result.push_back(static_cast<int>(part[v]));
  return result;
}

}  // namespace aspic::distributed

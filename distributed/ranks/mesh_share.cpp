#include "ranks/mesh_share.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace aspic::distributed {

int MeshShare::local(int whole_vertex) const {
  if (owns(whole_vertex)) return whole_vertex - first();
  const auto ghosts = vertex.begin() + own(), found = std::lower_bound(ghosts, vertex.end(), whole_vertex);
  return found != vertex.end() && *found == whole_vertex ? static_cast<int>(found - vertex.begin()) : -1;
}

std::vector<int> equal_cuts(int count, int parts) {
  std::vector<int> cut;
  for (int p = 0; p <= parts; ++p) cut.push_back(static_cast<int>(std::int64_t{count} * p / parts));
  return cut;
}

std::vector<Tet> arrange(const std::vector<std::vector<Tet>>& tets, const std::vector<std::vector<int>>& numbers,
                         MeshShare& share) {
  std::vector<int> ghosts;
  for (const std::vector<Tet>& of_body : tets)
    for (const Tet& tet : of_body)
      std::copy_if(tet.begin(), tet.end(), std::back_inserter(ghosts), [&](int v) { return !share.owns(v); });
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  share.vertex.resize(share.own());
  std::iota(share.vertex.begin(), share.vertex.end(), share.first());
  share.vertex.insert(share.vertex.end(), ghosts.begin(), ghosts.end());

  std::vector<Tet> local;
  for (size_t b = 0; b < tets.size(); ++b) {
    MeshShare::Body& body = share.bodies.emplace_back();
    body.first_tet = static_cast<int>(local.size());
    for (const bool is_counted : {true, false}) {
      int& count = is_counted ? body.counted : body.halo;
      for (size_t t = 0; t < tets[b].size(); ++t) {
        Tet tet = tets[b][t];
        if (share.owns(*std::min_element(tet.begin(), tet.end())) != is_counted) continue;
        for (int& v : tet) v = share.local(v);
        local.push_back(tet);
        share.user_tet.push_back(numbers[b][t]);
        ++count;
      }
    }
  }
  return local;
}

}  // namespace aspic::distributed

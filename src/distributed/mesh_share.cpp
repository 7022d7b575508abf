#include "distributed/mesh_share.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "base/check.h"

namespace aspic::distributed {

int MeshShare::local(int whole_vertex) const {
  if (owns(whole_vertex)) return whole_vertex - first();
  const auto ghosts = vertex.begin() + own(), found = std::lower_bound(ghosts, vertex.end(), whole_vertex);
  return found != vertex.end() && *found == whole_vertex ? static_cast<int>(found - vertex.begin()) : -1;
}

MeshShare make_mesh_share(const TetMesh& whole, std::span<const BodyRange> bodies, int rank, int ranks) {
  ASPIC_CHECK(whole.vertex_count() >= ranks && whole.mids.empty());
  MeshShare share;
  share.rank = rank;
  for (int r = 0; r <= ranks; ++r)
    share.cut.push_back(static_cast<int>(std::int64_t{whole.vertex_count()} * r / ranks));
  std::vector<int> ghosts;
  for (const BodyRange& body : bodies) {
    std::vector<int> halo;
    MeshShare::Body& tets = share.bodies.emplace_back();
    tets.first_tet = static_cast<int>(share.tet.size());
    for (int t = body.first_tet; t < body.first_tet + body.tet_count; ++t) {
      const Tet& tet = whole.tets[t];
      if (std::none_of(tet.begin(), tet.end(), [&](int v) { return share.owns(v); })) continue;
      (share.owns(*std::min_element(tet.begin(), tet.end())) ? share.tet : halo).push_back(t);
      std::copy_if(tet.begin(), tet.end(), std::back_inserter(ghosts), [&](int v) { return !share.owns(v); });
    }
    tets.counted = static_cast<int>(share.tet.size()) - tets.first_tet;
    tets.halo = static_cast<int>(halo.size());
    share.tet.insert(share.tet.end(), halo.begin(), halo.end());
  }
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  share.vertex.resize(share.own());
  std::iota(share.vertex.begin(), share.vertex.end(), share.first());
  share.vertex.insert(share.vertex.end(), ghosts.begin(), ghosts.end());
  return share;
}

TetMesh local_mesh(const TetMesh& whole, const MeshShare& share) {
  TetMesh mesh;
  for (const int v : share.vertex) mesh.rest.push_back(whole.rest[v]);
  for (const int t : share.tet) {
    Tet tet = whole.tets[t];
    for (int& v : tet) v = share.local(v);
    mesh.tets.push_back(tet);
  }
  return mesh;
}

std::vector<double> local_part(std::span<const double> whole, const MeshShare& share) {
  std::vector<double> part;
  part.reserve(3 * share.vertex.size());
  for (const int v : share.vertex)
    for (int r = 0; r < 3; ++r) part.push_back(whole[3 * static_cast<size_t>(v) + r]);
  return part;
}

}  // namespace aspic::distributed

// Bisection of tets at their longest edges [Rivara 1984]; neighbors are bisected until faces match.
#pragma once
#include <array>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "mesh/tet_mesh.h"
#include "model/misfit.h"

namespace aspic {

class BisectedMesh {
 public:
  struct Part {
    Tet tet{};
    int parent = 0;      // tet of the initial mesh
    int generation = 0;  // number of bisections
  };

  // Mid-edge nodes of quadratic tets are left out. Vertices keep their numbers, and new ones follow.
  BisectedMesh(std::vector<Vec3d> rest, const std::vector<Tet>& tets);

  // Bisects the wanted tets and their neighbors once.
  void bisect(const std::function<bool(const Part&)>& is_wanted);

  const std::vector<Vec3d>& rest() const { return rest_; }
  const std::vector<Part>& parts() const { return parts_; }
  // Corners of the initial tet, face or edge that contains a vertex, ascending.
  const std::vector<int>& support(int vertex) const { return support_[vertex]; }
  double longest_edge(const Tet& tet) const;
  std::vector<Midpoint> midpoints() const;  // the new vertices, ascending

 private:
  using Edge = std::pair<int, int>;  // ascending
  Edge longest(const Tet& tet) const;
  bool has_split_edge(const Tet& tet) const;
  void split(size_t part);

  std::vector<Vec3d> rest_;
  std::vector<Part> parts_;
  std::vector<std::vector<int>> support_;
  std::map<Edge, int> middle_;  // of split edges
};

// Union of two supports.
std::vector<int> united(const std::vector<int>& a, const std::vector<int>& b);

}  // namespace aspic

// A box and its surface, for tests of terms that act on surfaces.
#pragma once
#include <random>
#include <vector>

#include "energy/tet_elasticity.h"
#include "mesh/generators.h"
#include "mesh/surface.h"

namespace aspic {

inline const TetMesh& box_mesh() {
  static const TetMesh box = make_box({{0, 0, 0}}, {{1, 0.8, 0.6}}, {4, 3, 3});
  return box;
}

inline const std::vector<Triangle>& box_surface() {
  static const std::vector<Triangle> triangles = boundary_triangles(box_mesh(), 0, box_mesh().tet_count());
  return triangles;
}

inline const BlockPattern& box_pattern() {  // pattern of the tets
  static const BlockPattern of_tets = [] {
    const MaterialInfo& info = material_info("neo_hookean");
    const std::vector<MaterialParameters> parameters(box_mesh().tet_count(), {lame_from_young_poisson(1, 0.3), {}});
    Couplings couplings;
    make_tet_elasticity(info.name, box_mesh(), 0, parameters)->add_couplings(couplings);
    return make_pattern(box_mesh().vertex_count(), couplings);
  }();
  return of_tets;
}

inline std::vector<double> box_at_rest() {
  std::vector<double> x;
  for (const Vec3d& X : box_mesh().rest) x.insert(x.end(), {X[0], X[1], X[2]});
  return x;
}

inline std::vector<double> shaken_box(double amount, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  std::vector<double> x = box_at_rest();
  for (double& xi : x) xi += uniform(random);
  return x;
}

}  // namespace aspic

// Boxes of quadratic tets with different parameters, for tests.
#pragma once
#include <array>
#include <random>
#include <vector>

#include "energy/energy.h"
#include "material/list.h"
#include "material/registry.h"
#include "mesh/generators.h"
#include "mesh/numbering.h"
#include "mesh/tet_nodes.h"

namespace aspic {

inline const Vec3d kSize = {{1, 0.8, 0.6}};

// Renumbered, so that mid-edge nodes and corners are in any order.
inline TetMesh quadratic_box(std::array<int, 3> cells) {
  const TetMesh mesh = raise_order(make_box({{0, 0, 0}}, kSize, cells));
  return from_user(locality_numbering(mesh), mesh);
}

inline const TetMesh& small() {
  static const TetMesh mesh = quadratic_box({3, 2, 1});  // 36 tets
  return mesh;
}

inline std::vector<MaterialParameters> different_parameters(const TetMesh& mesh, const MaterialInfo& info) {
  std::vector<MaterialParameters> parameters;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    MaterialParameters p{lame_from_young_poisson(1 + 0.1 * t, 0.1 + 0.004 * (t % 60)), {}};
    for (size_t k = 0; k < info.extra.size(); ++k) p.extra[k] = info.extra[k].fallback;
    parameters.push_back(p);
  }
  return parameters;
}

// With a mean volume, except for some tets.
inline std::vector<MaterialParameters> nearly_incompressible(const TetMesh& mesh, const MaterialInfo& info) {
  constexpr double kPoisson[] = {0.49, 0.2, 0.499, 0.47};
  std::vector<MaterialParameters> parameters = different_parameters(mesh, info);
  for (int t = 0; t < mesh.tet_count(); ++t) parameters[t].lame = lame_from_young_poisson(1 + 0.1 * t, kPoisson[t % 4]);
  return parameters;
}

using ParametersOf = std::vector<MaterialParameters> (*)(const TetMesh& mesh, const MaterialInfo& info);
inline constexpr ParametersOf kBothParameters[] = {different_parameters, nearly_incompressible};

inline std::vector<double> positions(const TetMesh& mesh, const Mat3d& A, double noise, const Vec3d& shift = {}) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-noise, noise);
  std::vector<double> x;
  for (const Vec3d& X : mesh.rest) {
    const Vec3d y = A * X + shift;
    for (int r = 0; r < 3; ++r) x.push_back(y[r] + (noise > 0 ? uniform(random) : 0));
  }
  return x;
}
inline const Mat3d kAffine = {{1.1, 0.2, 0.1, -0.15, 0.95, 0.05, 0.1, 0, 1.05}};

inline BlockPattern bound_pattern(const TetMesh& mesh, Energy& V) {
  Couplings couplings;
  V.add_couplings(couplings);
  const BlockPattern pattern = make_pattern(mesh.vertex_count(), couplings);
  V.bind(pattern);
  return pattern;
}

// A material with a barrier, and a state in which it acts at corners.
inline constexpr char kBarrier[] = "neo_hookean_log";
inline const Mat3d kFlat = {{1, 0.1, 0, -0.1, 1, 0.05, 0, 0, 0.08}};

}  // namespace aspic

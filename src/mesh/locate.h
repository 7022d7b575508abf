// Where points lie in a tet mesh: in which tet, or how far from the nearest.
#pragma once
#include <array>
#include <vector>

#include "mesh/box_tree.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct Located {
  int tet = -1;
  std::array<double, 4> weights{};  // barycentric, summing to 1; some negative outside
  double squared_distance = 0;      // to the tet [m^2]; 0 inside

  double least_weight() const;
  bool is_outside() const;  // but for round-off
};

class TetLocator {
 public:
  // Refers to the mesh; passes over flat tets. Throws InvalidInput when there is no other.
  explicit TetLocator(const TetMesh& mesh);

  // The tet that has p deepest inside; outside of all the nearest one, of several the one that extrapolates least.
  Located locate(const Vec3d& p) const;

 private:
  Located container(const Vec3d& p) const;  // tet = -1 when there is none
  Located nearest(const Vec3d& p) const;
  std::array<double, 4> weights(int item, const Vec3d& p) const;

  const TetMesh& mesh_;
  std::vector<int> usable_;
  std::vector<Mat3d> inverse_;  // of the edge matrices of the usable tets
  BoxTree tree_;
};

}  // namespace aspic

// Point location in a tet mesh: the containing tet, or the nearest one.
#pragma once
#include <array>
#include <vector>

#include "mesh/box_tree.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct Located {
  int tet = -1;
  std::array<double, 4> weights{};  // barycentric, sum to 1; some negative outside
  double squared_distance = 0;      // squared distance to the tet [m^2]; 0 inside

  double min_weight() const;
  bool is_outside() const;  // up to round-off
};

class TetLocator {
 public:
  // Keeps a reference to the mesh. Flat tets are skipped. Throws InvalidInput if all tets are flat.
  explicit TetLocator(const TetMesh& mesh);

  // Returns the tet that contains p at the greatest depth, or outside of all tets the nearest one; ties are resolved by
  // the least extrapolation.
  Located locate(const Vec3d& p) const;

 private:
  Located container(const Vec3d& p) const;  // tet = -1 if none contains p
  Located nearest(const Vec3d& p) const;
  std::array<double, 4> weights(int item, const Vec3d& p) const;

  const TetMesh& mesh_;
  std::vector<int> usable_;
  std::vector<Mat3d> inverse_;  // inverse edge matrices of the usable tets
  BoxTree tree_;
};

}  // namespace aspic

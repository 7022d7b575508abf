// Moduli interpolated in the space of strains, as [Bickel 2009] represents a non-linear material: examples, each a
// deformed body with the E and nu per tet that explain it, are points in the six-dimensional space of the co-rotated
// Cauchy strains e = R'F - I of each tet; between them log E and nu are interpolated by radial basis functions.
//   log E(e) = c + sum_i w_i |e - e_i|,  sum_i w_i = 0,  and the same for nu(e)
// Nothing is known beyond the examples: there the values are held within the range that they span, widened.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "material/lame.h"
#include "math/small.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// e of a deformation gradient: symmetric, 0 at rest and for every rotation.
Mat3d corotated_strain(const Mat3d& F);
Mat3d deformation_gradient(const TetMesh& mesh, const Mat3d& rest_inverse, int tet, std::span<const double> x);

struct StrainExample {
  std::string name;
  std::vector<double> young, poisson;  // per tet: of the linear material that explains the example [Pa], [1]
  std::vector<double> x;               // the deformed body, 3 per vertex [m]
};

class StrainSpaceModuli {
 public:
  // Throws InvalidInput without an example, and for one that does not belong to the mesh.
  StrainSpaceModuli(const TetMesh& mesh, std::span<const StrainExample> examples);

  Lame at(int tet, const Mat3d& strain) const;
  int tet_count() const { return static_cast<int>(tets_.size()); }

 private:
  struct Sample {
    Mat3d strain;
    double log_young_weight, poisson_weight;
  };
  struct Tet {
    std::vector<Sample> samples;
    double log_young, poisson;  // c
    double least_log_young, largest_log_young, least_poisson, largest_poisson;
  };
  std::vector<Tet> tets_;
};

}  // namespace aspic

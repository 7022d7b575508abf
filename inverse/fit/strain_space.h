// Moduli interpolated in strain space, as [Bickel 2009] represents a nonlinear material. Examples are deformed bodies
// with fitted E and nu per tet: points in the six-dimensional space of corotated Cauchy strains e = R'F - I of each
// tet. Between them log E and nu are interpolated by radial basis functions.
//   log E(e) = c + sum_i w_i |e - e_i|,  sum_i w_i = 0,  and the same for nu(e)
// Beyond the examples the values are limited to their range, slightly widened.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "material/lame.h"
#include "math/small.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// Corotated strain e: symmetric, 0 at rest and for every rotation.
Mat3d corotated_strain(const Mat3d& F);
Mat3d deformation_gradient(const TetMesh& mesh, const Mat3d& rest_inverse, int tet, std::span<const double> x);

struct StrainExample {
  std::string name;
  std::vector<double> young, poisson;  // per tet: linear material fitted to the example [Pa], [1]
  std::vector<double> x;               // the deformed body, 3 per vertex [m]
};

class StrainSpaceModuli {
 public:
  // Throws InvalidInput without examples, or for one of another mesh.
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

// Harmonic fields in a tet mesh: linear finite elements for Laplace's equation with values on the boundary.
#pragma once
#include <span>
#include <vector>

#include "linalg/scalar_cholesky.h"
#include "mesh/tet_mesh.h"

namespace aspic {

class HarmonicExtension {
 public:
  explicit HarmonicExtension(const TetMesh& mesh);  // throws InvalidInput if the matrix cannot be factorized

  // Vertices with given values: those of the boundary, and those without tets.
  const std::vector<int>& given() const { return given_; }

  // Fills in the other vertices. The result stays within the range of the given values, which obtuse tets would
  // exceed slightly.
  void extend(std::span<double> values);

 private:
  struct Coupling {
    int inner, given;  // row of the matrix; vertex
    double value;
  };

  std::vector<int> given_, inner_;
  std::vector<Coupling> couplings_;
  ScalarCholesky matrix_;
};

}  // namespace aspic

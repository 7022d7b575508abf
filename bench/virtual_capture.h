// A cube of tissue with a stiff ball inside, held at the bottom, indented and measured in simulation: data for fits.
#pragma once
#include <vector>

#include "fit/misfit.h"

namespace aspic::bench {

struct VirtualCapture {
  int cells = 20;        // cells per edge of the fitted mesh
  int data_cells = 27;   // cells per edge of the mesh of the data
  int indentations = 4;  // up to 9; on the top first, then on the sides
  int markers = 100;     // on the top and the sides
  double noise = 0.01;   // noise of positions and forces relative to the largest motion and force
  double contrast = 5;   // modulus of the ball relative to the tissue
  double side = 0.1;     // side of the cube [m]
  double young = 20e3;   // modulus of the tissue [Pa]
  double poisson = 0.4;  // Poisson's ratio everywhere
  double depth = 0.01;   // depth of an indentation [m]
  unsigned seed = 1;     // seed of the noise
};

struct Captured {
  Experiment experiment;      // uses the fitted mesh
  std::vector<double> truth;  // log E of each tet, by centroid
  std::vector<char> inside;   // whether each tet is in the ball
};

// Throws InvalidInput if the data cannot be computed.
Captured capture(const VirtualCapture& setup);
std::vector<MaterialParameters> known(const VirtualCapture& setup, const TetMesh& mesh);

}  // namespace aspic::bench

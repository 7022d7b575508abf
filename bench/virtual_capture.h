// A cube of tissue with a stiff ball inside, held below, poked and measured in the computer: data for fits.
#pragma once
#include <vector>

#include "fit/misfit.h"

namespace aspic::bench {

struct VirtualCapture {
  int cells = 20;        // of the mesh that is fitted, along each edge
  int data_cells = 27;   // of the mesh that the data come from
  int pokes = 4;         // up to 9, on the top and then on the sides
  int markers = 100;     // on the top and the sides
  double noise = 0.01;   // of positions and forces, in parts of the largest motion and force
  double contrast = 5;   // of the ball
  double side = 0.1;     // of the cube [m]
  double young = 20e3;   // of the tissue [Pa]
  double poisson = 0.4;  // of all
  double depth = 0.01;   // of a poke [m]
  unsigned seed = 1;     // of the noise
};

struct Captured {
  Experiment experiment;      // on the mesh that is fitted
  std::vector<double> truth;  // log E of each of its tets, by centroid
  std::vector<char> inside;   // the ball?
};

// Throws InvalidInput when the data cannot be made.
Captured capture(const VirtualCapture& setup);
std::vector<MaterialParameters> known(const VirtualCapture& setup, const TetMesh& mesh);

}  // namespace aspic::bench

// Positions and velocities of all vertices at one time.
#pragma once
#include <vector>

namespace aspic {

struct TetMesh;

struct State {
  std::vector<double> q, qdot;  // positions [m] and velocities [m/s], 3 per vertex
  double time = 0;              // [s]
};

// Returns the state of a body in its rest shape, with zero velocities at time 0.
State at_rest(const TetMesh& mesh);

}  // namespace aspic

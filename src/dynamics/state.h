#pragma once
#include <vector>

namespace aspic {

struct State {
  std::vector<double> q, qdot;  // positions [m] and velocities [m/s], 3 per vertex
  double time = 0;              // [s]
};

}  // namespace aspic

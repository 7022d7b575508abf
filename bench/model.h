// Models of one body, without a scene file.
#pragma once
#include <string>
#include <vector>

#include "dynamics/model.h"
#include "dynamics/state.h"

namespace aspic::bench {

struct Substance {
  std::string material = "neo_hookean_log";
  double young = 1e6;     // [Pa]
  double poisson = 0.4;   // [1]
  double density = 1000;  // [kg/m^3]
};

// One body under gravity along -y with consistent mass; `clamped` vertices stay where they are.
Model make_model(TetMesh mesh, const Substance& substance, std::vector<int> clamped);
State at_rest(const TetMesh& mesh);

}  // namespace aspic::bench

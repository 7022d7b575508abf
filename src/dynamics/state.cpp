#include "dynamics/state.h"

#include "mesh/vertices.h"

namespace aspic {

State at_rest(const TetMesh& mesh) {
  State state;
  state.q = rest_positions(mesh);
  state.qdot.assign(state.q.size(), 0.0);
  return state;
}

}  // namespace aspic

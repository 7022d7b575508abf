// The share of a follower pressure on an open patch that has no potential. With W the volume swept by the patch (see
// pressure.h) and F_n = integral of N_n n da over the deformed patch,
//   r_n = dW/dx_n - F_n = -sum over rim edges of the integral of N_n u x (X' / 2 + u' / 3) ds,   u = x - X,
// because W also counts the volume between the rim and its side walls. This term has the forces p r_n, so that it and
// the pressure p W exert -p F_n: p against the normals of the current shape, per current area.
//   D(x) = -p (r(x0) . d + d' S(x0) d / 2),   d = x - x0,   S: symmetric part of dr/dx
// where x0 is lagged, see LaggedEnergy. It is the work of the rim with the opposite sign.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "energy/energy.h"
#include "mesh/surface.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// An edge of a face in the direction of its boundary.
struct RimEdge {
  int a, b;
  int mid = -1;  // node between them; -1 on a linear face
};

// Returns the edges of a patch that no other face of it shares; empty: the patch is closed.
std::vector<RimEdge> rim_of(std::span<const Face> patch);

class PressureRim : public Energy, public LaggedEnergy {
 public:
  virtual const Energy& pressure() const = 0;  // the term p W
};

// `pressure`: the term of the patch. `value`: its pressure over time [Pa].
std::unique_ptr<PressureRim> make_pressure_rim(const Energy& pressure, const TetMesh& mesh,
                                               std::span<const RimEdge> rim, std::function<double(double)> value);

}  // namespace aspic

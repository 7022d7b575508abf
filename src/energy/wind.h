// Wind on a sheet: drag along the normal and along the plane of each triangle, as the incremental potential of a step
//   D(x) = h sum A rho/2 (Cn/3 |w.n|^3 + Ct/3 |w - (w.n) n|^3),   w = wind - (x - start) / h at the centroid
// with the normal n, the area A and the wind at StepContext::shape. D is convex and twice differentiable. The force
// on a triangle is F = A rho/2 (Cn |w.n| (w.n) n + Ct |w_t| w_t), w_t = w - (w.n) n. In statics it is constant, that of
// the wind on the sheet at rest: D = -F . (x - start).
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "energy/energy.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct WindLaw {
  double density = 1.2;                  // rho of the air [kg/m^3]
  double normal_coefficient = 1.2;       // Cn [1], about that of a square plate across the wind
  double tangential_coefficient = 0.01;  // Ct [1], about that of both sides of a smooth plate along the wind
};

using WindField = std::function<Vec3d(const Vec3d& x, double time)>;  // velocity of the air [m/s]

// Work of the forces at x during a step or stage of length h [J]. The sheet receives wind - loss = F . (x - start).
struct WindWork {
  double wind = 0;  // sum of F . wind h, the work of the moving air
  double loss = 0;  // sum of F . w h >= 0, dissipated in the air
};

class Wind : public Energy {
 public:
  virtual WindWork work(Positions x, const Context& context) const = 0;  // 0 in statics
};

// `triangles`: vertices of the mesh, any orientation. `velocity` is evaluated once per step and triangle.
std::unique_ptr<Wind> make_wind(std::vector<Triangle> triangles, const WindLaw& law, WindField velocity);

}  // namespace aspic

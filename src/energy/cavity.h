// The content of a cavity: a gas or a liquid in the volume v that a closed patch of the boundary encloses. With v_0 the
// volume at the start or a given one, a(t) a given ratio and p the pressure above that outside,
//   gas, isothermal: p = p_0 (a v_0 / v - 1),  V = p_0 (v - v_0) - p_0 a v_0 log(v / v_0)   p_0: pressure outside
//   liquid:          p = K (a - v / v_0),      V = K v_0 / 2 (v / v_0 - a)^2                K: bulk modulus
// where a is the amount of gas relative to v_0 at p_0, or the volume of the liquid without pressure relative to v_0. V
// is infinite for v <= 0.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "energy/dense_energy.h"
#include "mesh/surface.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct CavityContent {
  enum Kind { gas, liquid } kind = gas;
  double modulus = 0;                         // p_0 or K [Pa]; > 0
  std::function<double(double time)> amount;  // a [1], >= 0
  double volume = 0;                          // v_0 [m^3]; 0: the volume at the start
};

struct CavityState {
  double volume = 0;    // v [m^3]
  double pressure = 0;  // p [Pa]
};

class Cavity : public Energy, public DenseEnergy {
 public:
  virtual CavityState state(Positions x, double time) const = 0;
};

// Returns the volume that the patch encloses at rest [m^3]; negative if it encloses the body.
double cavity_volume(const TetMesh& mesh, std::span<const Face> patch);

// `patch`: closed, of boundary faces of the mesh, which need not outlive it. Throws InvalidInput if the volume at the
// start is not positive.
std::unique_ptr<Cavity> make_cavity(std::string name, const TetMesh& mesh, std::span<const Face> patch,
                                    CavityContent content, Positions start);

}  // namespace aspic

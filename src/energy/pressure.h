// V(x) = p * (volume swept outwards by a patch of the surface from rest to x): a pressure that follows the body,
// pushing against the outward normal where p > 0. Each point is taken to have come along a straight line, x(s) = X + s
// u:
//   swept = sum over triangles of mean(u) . int_0^1 a(s) ds,   a(s) the area vector of the triangle at s
// It is a function of x, so energy is conserved. The forces are exactly those of the pressure on a closed surface, at
// every vertex inside a patch, and for any patch that moves along its normals at rest. At the rim of an open patch they
// also hold the side walls that the motion draws: of second order in the displacement where the rim moves sideways.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "energy/energy.h"
#include "mesh/tet_mesh.h"

namespace aspic {

class Pressure : public SteadyEnergy {
 public:
  virtual void set_pressure(double pressure) = 0;  // [Pa]
  virtual double pressure() const = 0;
  virtual double swept_volume(Positions x) const = 0;  // outwards [m^3]
};

// A pressure in time: t [s] to p [Pa].
using PressureOfTime = std::function<double(double)>;

// `patch`: boundary triangles of the mesh, outward oriented.
std::unique_ptr<Pressure> make_pressure(const TetMesh& mesh, std::vector<Triangle> patch, double pressure);
std::unique_ptr<Energy> make_pressure(std::string name, const TetMesh& mesh, std::vector<Triangle> patch,
                                      PressureOfTime pressure);

}  // namespace aspic

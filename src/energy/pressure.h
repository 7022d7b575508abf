// V(x) = p * (volume swept outward by a surface patch from rest to x), which pushes against the outward normal for p >
// 0. Each point is assumed to move along a straight line, x(s) = X + s u:
//   swept = sum over triangles of mean(u) . int_0^1 a(s) ds, where a(s) is the area vector of the triangle at s
// V is a function of x, so energy is conserved. The forces equal those of a follower pressure on a closed surface and
// at every vertex inside a patch. At the rim of an open patch they also include the pressure on the side walls that the
// motion sweeps; pressure_rim.h removes it.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "energy/energy.h"
#include "mesh/surface.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// A pressure that the caller sets, constant in time.
class Pressure : public SteadyEnergy {
 public:
  virtual void set_pressure(double pressure) = 0;      // [Pa], for subsequent evaluations
  virtual double pressure() const = 0;                 // the value of subsequent evaluations [Pa]
  virtual double swept_volume(Positions x) const = 0;  // [m^3], positive outward
};

// Pressure as a function of time: t [s] to p [Pa].
using PressureOfTime = std::function<double(double)>;

// Return the term for a patch of boundary faces of the mesh, which need not outlive it. `pressure`: [Pa], the initial
// value or a function of time. `name` appears in reports; the default is "pressure".
std::unique_ptr<Pressure> make_pressure(const TetMesh& mesh, std::span<const Face> patch, double pressure);
std::unique_ptr<Energy> make_pressure(std::string name, const TetMesh& mesh, std::span<const Face> patch,
                                      PressureOfTime pressure);

}  // namespace aspic

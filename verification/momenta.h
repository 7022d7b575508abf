// A box that spins, vibrates and optionally falls, and its momenta.
#pragma once
#include <string>

#include "verification/models.h"

namespace aspic::verify {

struct Momenta {
  Vec3d linear, angular;  // sum of p [kg m/s], and of x cross p [kg m^2/s]
};
Momenta momenta(const Simulation& simulation);

// One cubic meter of 1000 kg/m^3, stretched by 1.2 along z, rotating at 6 rad/s about z and moving at 2 m/s along x.
Simulation spinning_box(const std::string& integrator, double h, const Vec3d& gravity, double young);

}  // namespace aspic::verify

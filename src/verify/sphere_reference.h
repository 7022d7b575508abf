// A thick hollow sphere that is blown up: the equations of one radius.
#pragma once
#include <string>

namespace aspic::verify {

struct Inflation {
  double outer;  // radius of the outer surface afterwards [m]
  double force;  // nominal radial stress at the inner surface, pressing outwards [Pa]
};

// Rest radii a and b; the inner radius becomes `inner`, the outside is free. Shooting with principal_energy and the
// classical Runge-Kutta method, to about 1e-8; E = 1 Pa.
Inflation inflated_sphere(const std::string& material, double poisson, double a, double b, double inner);

}  // namespace aspic::verify

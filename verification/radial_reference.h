// Bodies whose deformation is one function of one radius: a hollow sphere that is blown up, a cylinder that is twisted.
#pragma once
#include <array>
#include <string>
#include <vector>

namespace aspic::verify {

struct Inflation {
  double outer;  // radius of the outer surface afterwards [m]
  double force;  // nominal radial stress at the inner surface, pressing outwards [Pa]
};

// Rest radii a and b; the inner radius becomes `inner`, the outside is free. Shooting with principal_energy and the
// classical Runge-Kutta method, to about 1e-8; E = 1 Pa. Throws
// std::runtime_error where the secant method does not converge.
Inflation inflated_sphere(const std::string& material, double poisson, double a, double b, double inner);

struct Torsion {
  double torque, force;                      // about the axis [N m], along it, pulling [N]
  std::vector<std::array<double, 2>> radii;  // before and after, from 0 to 1 before [m]

  double radius(double R) const;  // of what was at R [m]
};

// x = (r(R) cos(Theta + twist Z), r(R) sin(Theta + twist Z), Z) of a cylinder of radius 1 m whose length is held and
// whose side is free; twist in rad/m. As above.
Torsion twisted_cylinder(const std::string& material, double poisson, double twist);

}  // namespace aspic::verify

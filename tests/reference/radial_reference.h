// References with a deformation that is one function of one radius: inflated hollow sphere, twisted cylinder.
#pragma once
#include <array>
#include <string>
#include <vector>

namespace aspic::verify {

struct Inflation {
  double outer;  // deformed outer radius [m]
  double force;  // nominal radial stress at the inner surface, directed outward [Pa]
};

// Rest radii a and b; the inner radius becomes `inner`, the outer surface is free. Uses shooting with principal_energy
// and the classical Runge-Kutta method, accurate to about 1e-8; E = 1 Pa. Throws std::runtime_error if the secant
// method does not converge.
Inflation inflated_sphere(const std::string& material, double poisson, double a, double b, double inner);

struct Torsion {
  double torque, force;                      // torque about the axis [N m], axial tension [N]
  std::vector<std::array<double, 2>> radii;  // rest and deformed radii, rest radius from 0 to 1 [m]

  double radius(double R) const;  // deformed radius of rest radius R [m]
};

// x = (r(R) cos(Theta + twist Z), r(R) sin(Theta + twist Z), Z) for a cylinder of radius 1 m with fixed length and free
// side; twist in rad/m. Method and exception as above.
Torsion twisted_cylinder(const std::string& material, double poisson, double twist);

}  // namespace aspic::verify

// A smooth deformation of the unit cube with the body force that holds it.
#pragma once
#include <string>

namespace aspic::verify {

struct SpaceError {
  double h;       // edge of a cell [m]
  double l2, h1;  // sqrt(int |x_h - x|^2), sqrt(int |F_h - F|^2) [m^(5/2)], [m^(3/2)]
};
// With n cells along each edge, every inner vertex moved by up to a fifth of a cell; E = 1 Pa. The body force is that
// of `material`, the tets are made of `taken`.
SpaceError manufactured_error(const std::string& material, const std::string& taken, double poisson, int n);

}  // namespace aspic::verify

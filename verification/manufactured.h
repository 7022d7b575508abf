// A smooth deformation of the unit cube with the body force of its equilibrium.
#pragma once
#include <string>

namespace aspic::verify {

struct SpaceError {
  double h;       // edge length of a cell [m]
  double l2, h1;  // sqrt(int |x_h - x|^2), sqrt(int |F_h - F|^2) [m^(5/2)], [m^(3/2)]
};
// Uses n cells per edge, with every inner vertex moved by up to a fifth of a cell; E = 1 Pa. The body force belongs to
// `material`; the tets use `taken`.
SpaceError manufactured_error(const std::string& material, const std::string& taken, double poisson, int n);

}  // namespace aspic::verify

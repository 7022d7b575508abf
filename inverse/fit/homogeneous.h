// Stress of a homogeneously deformed cube, as in testing machines. Traction-free faces determine the lateral stretch t.
//   uniaxial      F = diag(l, t, t)     equibiaxial  F = diag(l, l, t)
//   planar        F = diag(l, 1, t), also called pure shear
//   simple_shear  F = I + g e1 e2'
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "material/registry.h"
#include "math/small.h"

namespace aspic {

enum class Deformation { uniaxial, equibiaxial, planar, simple_shear };

std::string_view name(Deformation deformation);
std::vector<std::string> deformation_names();
Deformation deformation_named(std::string_view name);  // throws InvalidInput with the nearest known name

// compressible: the material with its own bulk modulus. incompressible: the limit of an infinite one, with J = 1 and a
// pressure that makes the faces traction-free.
enum class Volume { compressible, incompressible };

struct HomogeneousState {
  bool is_found = false;  // false: no lateral stretch makes the faces traction-free
  Mat3d F{};
  double stress = 0;           // nominal stress P_11; for simple shear P_12 [Pa]
  std::vector<double> slopes;  // derivatives of the stress with respect to mu, lambda and the material's own parameters
};

// `stretch`: l > 0, or the amount of shear g [1]. Throws InvalidInput for an unknown material.
HomogeneousState homogeneous_state(std::string_view material, const MaterialParameters& parameters,
                                   Deformation deformation, double stretch, Volume volume);

}  // namespace aspic

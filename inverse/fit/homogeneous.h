// Stress of a cube that deforms alike everywhere, as testing machines measure it: the faces that nobody pulls are free
// of traction, which determines the stretch across them.
//   uniaxial      F = diag(l, t, t)     equibiaxial  F = diag(l, l, t)
//   planar        F = diag(l, 1, t), also called pure shear
//   simple_shear  F = I + g e1 e2'
#pragma once
#include <span>
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

// compressible: the material as it is, with its own bulk modulus. incompressible: its limit for an infinite one, J = 1
// with a pressure that frees the faces of traction.
enum class Volume { compressible, incompressible };

struct HomogeneousState {
  bool is_found = false;  // false: no stretch across was found at which the faces are free
  Mat3d F{};
  double stress = 0;           // nominal, P_11; of simple shear P_12 [Pa]
  std::vector<double> slopes;  // of the stress by mu, lambda and the material's own parameters
};

// `stretch`: l > 0, or the amount of shear g [1]. Throws InvalidInput for an unknown material.
HomogeneousState homogeneous_state(std::string_view material, const MaterialParameters& parameters,
                                   Deformation deformation, double stretch, Volume volume);

}  // namespace aspic

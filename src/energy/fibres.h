// Families of fibres in tets, as a term of V beside the elasticity of the body.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "energy/energy.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// Fibres of a tet, see material/fibre_law.h.
struct Fibre {
  Vec3d direction = {{1, 0, 0}};  // at rest, of length 1
  double stiffness = 0;           // k1 [Pa]
  double exponent = 1;            // k2 [1], > 0
  double dispersion = 0;          // kappa [1]: 0 (along the direction) to 1/3 (isotropic)
};

// Returns the energy of one family in tets [first, first + fibres.size()). `name` appears in reports.
std::unique_ptr<Energy> make_fibres(std::string name, const TetMesh& mesh, int first, std::span<const Fibre> fibres);

// Active muscle fibres of a tet, see material/muscle_law.h.
struct MuscleFibre {
  Vec3d direction = {{1, 0, 0}};  // at rest, of length 1
  double strength = 0;            // largest nominal stress [Pa] at the optimal stretch 1
  double optimal_stretch = 1;     // [1], > 0
};

// The same for muscle, whose activation (0 to 1) is evaluated once per step.
std::unique_ptr<Energy> make_muscle(std::string name, const TetMesh& mesh, int first,
                                    std::span<const MuscleFibre> fibres, std::function<double(double time)> activation);

}  // namespace aspic

// Families of fibres in tets, as a term of V beside the elasticity of the body.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "energy/damping.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// Directions at rest, of length 1, at the quadrature points of a tet. A linear tet has only the first.
using FibreDirections = std::array<Vec3d, 4>;
int fibre_point_count(const TetMesh& mesh, int tet);
// Barycentric coordinates of a quadrature point.
std::array<double, 4> fibre_point(const TetMesh& mesh, int tet, int point);

// Fibres of a tet, see material/fibre_law.h.
struct Fibre {
  FibreDirections directions;
  double stiffness = 0;   // k1 [Pa]
  double exponent = 1;    // k2 [1], > 0
  double dispersion = 0;  // kappa [1]: 0 (along the direction) to 1/3 (isotropic)
};

// See material/guccione_law.h.
struct GuccioneFibre {
  FibreDirections directions;
  double stiffness = 0;                     // C [Pa]
  double along = 1, across = 1, shear = 1;  // bf, bt, bfs [1]
};

// See material/weiss_law.h. Requires exponent (straight_stretch - 1) <= kMostWeissStiffening.
inline constexpr double kMostWeissStiffening = 10;
struct WeissFibre {
  FibreDirections directions;
  double stiffness = 0;           // C3 [Pa]
  double exponent = 1;            // C4 [1], > 0
  double straight_stretch = 1.1;  // l* [1], > 1
  double straight_stiffness = 0;  // C5 [Pa]
};

// The tets [first, first + number of fibres) of a mesh. `name` appears in reports.
struct FibrePlace {
  std::string name;
  const TetMesh& mesh;
  int first = 0;
};

// Return the energy of one family.
std::unique_ptr<Energy> make_fibres(const FibrePlace& place, std::span<const Fibre> fibres);
std::unique_ptr<Energy> make_fibres(const FibrePlace& place, std::span<const GuccioneFibre> fibres);
std::unique_ptr<Energy> make_fibres(const FibrePlace& place, std::span<const WeissFibre> fibres);

// Active muscle fibres of a tet, see material/muscle_law.h.
struct MuscleFibre {
  FibreDirections directions;
  double strength = 0;         // largest nominal stress [Pa] at the optimal stretch 1
  double optimal_stretch = 1;  // [1], > 0
};

// The same with a constant tension, see material/tension_law.h.
struct TensionFibre {
  FibreDirections directions;
  double strength = 0;  // [Pa]
};

// Activation over time [s]: 0 to 1, evaluated once per step.
using Activation = std::function<double(double time)>;

// Return the energy of muscle with an activation.
std::unique_ptr<Energy> make_muscle(const FibrePlace& place, std::span<const MuscleFibre> fibres,
                                    Activation activation);
std::unique_ptr<Energy> make_muscle(const FibrePlace& place, std::span<const TensionFibre> fibres,
                                    Activation activation);

// Force-velocity relation of muscle fibres, see material/hill_law.h.
struct MuscleVelocity : MuscleFibre {
  double max_velocity = 10;  // largest velocity of shortening [1/s]: optimal lengths per second, > 0
  double curvature = 0.25;   // k [1], > 0
  double lengthening = 1.5;  // relative force of fast lengthening [1], > 1
};

// Returns its dissipation potential.
std::unique_ptr<Damping> make_muscle_velocity(const FibrePlace& place, std::span<const MuscleVelocity> fibres,
                                              Activation activation);

}  // namespace aspic

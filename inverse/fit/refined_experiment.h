// What the mesh of a fit gets wrong: linear tets are too stiff. The same body is put at rest under the same loads on a
// mesh with edges half as long; errors fall with the square of the edges, so that 4/3 of the difference is that of the
// mesh [Richardson 1911]. It is taken off the measurements, and a part of it is added to their standard deviations
// (as in the approximation errors of [Kaipio and Somersalo 2007]). A force is proportional to the stiffness, which is
// unknown: its extrapolation is geometric, so that it keeps its sign, and its error is relative.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "fit/misfit.h"

namespace aspic {

// Every tet in eight, the octahedron in its middle along its shortest diagonal.
Experiment refined(const Experiment& experiment);
Experiment refined(Experiment experiment, int times);

// What the tets of a refined mesh are made of: its parts follow one another, tet by tet.
std::vector<MaterialParameters> for_parts(std::span<const MaterialParameters> parameters, int tet_count);

// Limit of fine meshes minus mesh of the fit, of what is predicted for a case.
struct MeshError {
  std::vector<Vec3d> markers;  // one per position [m]
  Wrench wrench;
  Vec3d force_on_mesh{};  // predicted on the mesh of the fit [N]

  // The error of another force on the same body: it grows with the force.
  Wrench for_force_on_mesh(const Vec3d& force) const;
  Wrench for_force_in_limit(const Vec3d& force) const;
  double force_factor() const;  // |force in the limit| / |force on the mesh|; 1 without a force
  // |error of the force| over the smaller of both forces; 0 without a force.
  double relative_force_error() const;
};

struct MeshErrors {
  std::vector<MeshError> cases;  // empty: unknown
  std::string failure;           // why
};

// For a material, one set of parameters per tet or per tet of the mesh that the experiment's was refined from.
MeshErrors mesh_errors(const Experiment& experiment, const std::string& material,
                       std::span<const MaterialParameters> parameters, const EquilibriumOptions& options = {});

// What would have been measured on a body that is like the mesh; deviations grow by kUncertain of the error.
inline constexpr double kUncertain = 1.0 / 3;
Experiment without_mesh_errors(Experiment experiment, const MeshErrors& errors);

}  // namespace aspic

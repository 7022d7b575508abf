// Discretization error of a fit: linear tets are too stiff. The same body is solved under the same loads on a mesh with
// half the edge length. Errors are quadratic in the edge length, and cubic with quadratic tets, so 4/3 or 8/7 of the
// difference is the error [Richardson 1911]. It is subtracted from the measurements, and a fraction of it is added to
// their standard deviations (like the approximation errors of [Kaipio and Somersalo 2007]). Forces are proportional to
// the unknown stiffness, so their extrapolation is geometric: it keeps the sign, and the error is relative.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "model/predictions.h"

namespace aspic {

// Splits every tet in eight, with the octahedron cut along its shortest diagonal.
Experiment refined(const Experiment& experiment);
// Positions x of a mesh, interpolated at the vertices of the refined one.
std::vector<double> prolonged(const TetMesh& mesh, const TetMesh& fine, std::span<const double> x);
Experiment refined(Experiment experiment, int times);

// Limit of fine meshes minus mesh of the fit, for the predictions of a case.
struct MeshError {
  std::vector<Vec3d> markers;  // one per position [m]
  Wrench wrench;
  Wrench on_mesh;  // predicted on the mesh of the fit

  double lever = 1;  // [m]: sizes of wrenches are |force| and |torque| / lever, so a twist without a force has one, too

  Wrench limit() const;
  // Errors of another wrench on the same body, or of a measured one; they are proportional to it.
  Wrench for_wrench_on_mesh(const Wrench& other) const;
  Wrench for_measured(const LoadCase& load) const;
  double factor() const;  // size of the limit over that on the mesh; 1 without a wrench
  // |error of the force| over the smaller of both forces; 0 without a force.
  double relative_force_error() const;
};

struct MeshErrors {
  std::vector<MeshError> cases;  // empty: unknown
  std::string failure;           // why
};

// Requires one parameter set per tet of the material's mesh. Starts from the predictions for another material, which it
// replaces.
MeshErrors mesh_errors(const Experiment& experiment, const std::string& material,
                       std::span<const MaterialParameters> parameters, const EquilibriumOptions& options = {},
                       ErrorPredictions* last = nullptr);

// Corrects the measurements to a body like the mesh; standard deviations grow by kUncertain of the error, and so does
// an error with one factor for all readings, because the error of a mesh is systematic. Chosen: half and double move
// values by a third of a standard deviation.
inline constexpr double kUncertain = 1.0 / 3;
Corrected without_mesh_errors(Corrected experiment, const MeshErrors& errors);

}  // namespace aspic

// An exact follower pressure on any patch, for statics.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mesh/surface.h"
#include "verification/models.h"

namespace aspic::verify {

// Nodal forces of a unit pressure on the deformed faces: 3 numbers per vertex [m^2].
std::vector<double> pressure_forces(std::span<const Face> patch, Positions x);

// The load of a pressure [Pa], with the normals at the start of each step. Repeated quasi-static steps make it exact;
// the term has no tangent because the pressure on an open patch has no potential.
std::unique_ptr<Energy> make_follower_pressure(std::vector<Face> patch, std::function<double(double time)> pressure);

// Returns the equilibrium of a model whose loads and pins reach their final size at time 1, in `steps` equal load
// steps, and further steps until the shape is steady: a change of at most `steady` times its largest displacement.
// Throws std::runtime_error with `what` if this fails.
Simulation follower_equilibrium(Model model, int steps, const std::string& what, double steady = 1e-5);

// Faces of the boundary whose corners satisfy the predicate.
std::vector<Face> faces_where(const TetMesh& mesh, const Predicate& is_part);

}  // namespace aspic::verify

// Equilibria for the checks of statics.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "mesh/surface.h"
#include "reference/models.h"

namespace aspic::verify {

// Returns the vertices of the boundary.
std::vector<int> boundary_vertices(const TetMesh& mesh);

// Returns the equilibrium of a model whose pins and loads reach their final size at time 1, in `steps` equal load
// steps. Throws std::runtime_error with `what` if one of them does not converge.
Simulation equilibrium(Model model, int steps, const std::string& what, double tolerance = 1e-10);

// dV/dx of all elasticity of the model at the state; at pinned vertices the reaction [N].
std::vector<double> elastic_forces(const Simulation& simulation);
Vec3d sum_over(const std::vector<int>& vertices, const std::vector<double>& values);  // sum of 3 numbers per vertex

// Dead load: `force`, 3 numbers per vertex [N], times factor(time), or times the time without a factor.
std::unique_ptr<Energy> make_growing_load(
    std::vector<double> force, std::function<double(double time)> factor = [](double t) { return t; });

// Nodal forces of `traction` [Pa] on all boundary triangles whose corners satisfy `is_loaded`: 3 numbers per vertex
// [N].
std::vector<double> traction_on(const TetMesh& mesh, const std::function<bool(const Vec3d&)>& is_loaded,
                                const Vec3d& traction);

// Faces of the boundary whose corners satisfy the predicate.
std::vector<Face> faces_where(const TetMesh& mesh, const Predicate& is_part);

// Limit of a sequence with errors C h^p, h halved each time, from its last three values.
struct Extrapolation {
  double order, limit;
};
Extrapolation extrapolate(const std::vector<double>& values);
// Limit from the last two values for a known p.
double richardson(const std::vector<double>& values, double order);

}  // namespace aspic::verify

// Equilibria: what the checks of statics share.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "verification/models.h"

namespace aspic::verify {

// The boundary of the mesh as vertices.
std::vector<int> boundary_vertices(const TetMesh& mesh);

// The equilibrium of a model whose pins and loads have reached their final size at time 1, approached in `steps` equal
// parts. Throws std::runtime_error, naming `what`, when a part does not converge.
Simulation equilibrium(Model model, int steps, const std::string& what, double tolerance = 1e-10);

// dV/dx of all elasticity of the model at the state: on held vertices the force of what holds them [N].
std::vector<double> elastic_forces(const Simulation& simulation);
Vec3d sum_over(const std::vector<int>& vertices, const std::vector<double>& values);  // of 3 numbers per vertex

// A dead force `force` times `factor` of the time, 3 numbers per vertex [N]; without a factor, times the time.
std::unique_ptr<Energy> make_growing_load(
    std::vector<double> force, std::function<double(double time)> factor = [](double t) { return t; });

// The forces of `traction` [Pa] over all boundary triangles whose corners satisfy `is_loaded`: 3 numbers per vertex
// [N].
std::vector<double> traction_on(const TetMesh& mesh, const std::function<bool(const Vec3d&)>& is_loaded,
                                const Vec3d& traction);

// What a sequence of values tends to whose errors are C h^p, h halved from each to the next: of the last three.
struct Extrapolation {
  double order, limit;
};
Extrapolation extrapolate(const std::vector<double>& values);
// The limit of the last two where p is known.
double richardson(const std::vector<double>& values, double order);

}  // namespace aspic::verify

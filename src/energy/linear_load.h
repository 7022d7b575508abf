// V(x) = -sum f_i . x_i: gravity, body forces, dead tractions and dead pressures (they do not follow the body). If a
// force varies in time, its work includes the change of V at the current positions.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "energy/energy.h"
#include "mesh/surface.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// Returns the term of constant forces, 3 per vertex [N]. `name` appears in reports.
std::unique_ptr<Energy> make_linear_load(std::string name, std::vector<double> force);
// Adds the forces at the given time [s] to `force`, 3 per vertex [N].
using AddForces = std::function<void(double time, std::span<double> force)>;
// Returns the term of the sum of constant forces, 3 per vertex [N], and varying ones.
std::unique_ptr<Energy> make_linear_load(std::string name, std::vector<double> constant, AddForces varying);

// Both add nodal forces to `force`, 3 per vertex [N], which equal the load for the shape functions.
// `force_density`: uniform in the tet [N/m^3].
void add_body_force(const TetMesh& mesh, int tet, const Vec3d& force_density, std::span<double> force);
// `traction`: uniform on a face of the vertices X at rest [Pa]. A pressure p is the traction -p n.
void add_traction(const std::vector<Vec3d>& X, const Face& face, const Vec3d& traction, std::span<double> force);

// A pressure [Pa] on boundary triangles of linear tets, against their outward normals and per area of the rest shape.
std::unique_ptr<Energy> make_dead_pressure(const TetMesh& mesh, std::span<const Face> patch, double pressure);

}  // namespace aspic

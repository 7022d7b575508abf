// Selects vertices by position and evaluates functions at all vertices.
#pragma once
#include <functional>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Condition on a point X of the rest shape [m].
using Predicate = std::function<bool(const Vec3d& X)>;

// Returns the vertices that satisfy the predicate, ascending.
std::vector<int> vertices_where(const TetMesh& mesh, const Predicate& predicate);

// Returns f(X) at the rest position X [m] of every vertex, 3 values per vertex.
std::vector<double> at_vertices(const TetMesh& mesh, const std::function<Vec3d(const Vec3d& X)>& f);

// Returns X of every vertex, 3 values per vertex [m].
std::vector<double> rest_positions(const TetMesh& mesh);

}  // namespace aspic

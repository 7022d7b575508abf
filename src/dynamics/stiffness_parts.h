// Parts of a model that need convergence tests of their own, because their forces have different orders of magnitude.
#pragma once
#include <span>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Returns the part of each vertex, numbered in the order of their first vertices. Vertices of one part are connected by
// tets or belong to one body, and their stiffnesses (modulus times edge) are within a factor of 100: those of the
// stiffest vertex, or 100 times less, or 100^2 times less, ... `modulus`: of the material at each vertex [Pa].
std::vector<int> parts_of(const TetMesh& mesh, std::span<const double> modulus);

// For computing parts of a distributed mesh.
// Returns the longest edge of the linear tets, triangles and segments at each vertex [m]. Unlike the volume, it does
// not underestimate slivers.
std::vector<double> longest_edge(const TetMesh& mesh);
// Returns the exponent n of a vertex whose stiffness is about 100^n times less than the stiffest one.
int softness_level(double stiffest, double stiffness);

}  // namespace aspic

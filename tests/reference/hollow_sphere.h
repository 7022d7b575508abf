// Meshes of a hollow sphere.
#pragma once
#include "mesh/tet_mesh.h"

namespace aspic::verify {

// Unit sphere: an octahedron whose triangles are subdivided into four, `cuts` times.
TriMesh octahedral_sphere(int cuts);
// Its part with X, Y, Z >= 0.
TriMesh octant(const TriMesh& sphere);

// Layers of prisms over a triangulated part of the unit sphere, from radius a to b. Each prism is cut into three tets
// by the order of its corner indices, so that neighbors match.
TetMesh hollow_sphere(const TriMesh& surface, int layers, double a, double b);

}  // namespace aspic::verify

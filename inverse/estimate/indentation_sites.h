// Sites for indentations on the free surface of a body.
#pragma once
#include <span>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct IndentationSite {
  int vertex = 0;
  Vec3d inward{};  // unit vector
};
// `count` sites for an indenter of this radius: free surface vertices where the surface is about flat over its
// width, each as far as possible from the previous ones.
std::vector<IndentationSite> indentation_sites(const TetMesh& mesh, std::span<const int> fixed, double radius,
                                               int count);

}  // namespace aspic

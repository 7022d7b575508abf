// Contents of a mesh file before it is classified as solid or surface.
#pragma once
#include <span>
#include <vector>

#include "mesh/mesh_groups.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct MeshContent {
  std::vector<Vec3d> vertices;
  std::vector<Tet> tets;
  std::vector<int> region;  // label of each tet; may be empty
  std::vector<Triangle> triangles;
  // Mid-edge nodes of each tet in any order, {-1, ...} for a linear one; empty: all are linear.
  std::vector<MidNodes> mids = {};
  MeshGroups groups = {};              // of a mesh of tets
  std::vector<Segment> segments = {};  // of lines
};

// Splits a polygon of at least three corners into a fan of triangles.
inline void add_fan(std::span<const int> corners, std::vector<Triangle>& triangles) {
  for (size_t i = 2; i < corners.size(); ++i) triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

}  // namespace aspic

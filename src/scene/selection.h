// Selects vertices, boundary triangles or tets of a body by `where`.
#pragma once
#include <string>
#include <vector>

#include "mesh/surface.h"
#include "mesh/tet_mesh.h"
#include "scene/value.h"

namespace aspic {

struct SelectionScope {
  const TetMesh& mesh;                           // the placed rest shape of one body, with its own indices
  Vec3d up;                                      // against gravity, of length 1
  std::string body;                              // for messages
  const std::vector<double>* painted = nullptr;  // the values that `where` names at each vertex, if any
};

// An empty selection throws InvalidInput with the extent of the body.
std::vector<int> select_vertices(const Value& where, const SelectionScope& scope);
std::vector<int> select_tets(const Value& where, const SelectionScope& scope);
std::vector<Triangle> select_triangles(const Value& where, const SelectionScope& scope,
                                       const std::vector<Triangle>& boundary);
std::vector<Face> select_faces(const Value& where, const SelectionScope& scope, const std::vector<Face>& boundary);

}  // namespace aspic

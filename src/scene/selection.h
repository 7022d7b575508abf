// Selects vertices, boundary triangles or tets of a body by `where`.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "mesh/box.h"
#include "mesh/mesh_groups.h"
#include "mesh/surface.h"
#include "mesh/tet_mesh.h"
#include "scene/value.h"

namespace aspic {

// The body of which a mesh is a part, if several processes hold the body together. Numbers of the whole body are those
// of the user.
class WholeBody {
 public:
  virtual ~WholeBody() = default;
  virtual int vertex_count() const = 0;
  virtual int number_of_vertex(int part_vertex) const = 0;  // number in the whole body
  virtual int number_of_tet(int part_tet) const = 0;
  virtual int vertex_of_part(int number) const = 0;  // -1: the part does not have the vertex
  virtual bool is_own(int part_vertex) const = 0;    // each vertex is the own one of one part
  virtual const Box& box() const = 0;                // of the rest shape
  // Returns the least and the largest height along `up`, of length 1 [m].
  virtual std::pair<double, double> heights(const Vec3d& up) const = 0;
  // Called for each selection, in the same order in all parts. `error`: what to report if no part selects anything.
  virtual void note_selection(const std::string& error, bool is_selected_here) const = 0;
};

struct SelectionScope {
  const TetMesh& mesh;                           // the placed rest shape of one body, with its own indices
  Vec3d up;                                      // against gravity, of length 1
  std::string body;                              // for messages
  const std::vector<double>* painted = nullptr;  // the values that `where` names at each vertex, if any
  const WholeBody* whole = nullptr;              // null: the mesh is the whole body
  const MeshGroups* groups = nullptr;            // of the mesh file; null: none
};

// An empty selection throws InvalidInput with the extent of the body.
std::vector<int> select_vertices(const Value& where, const SelectionScope& scope);
std::vector<int> select_tets(const Value& where, const SelectionScope& scope);
std::vector<Triangle> select_triangles(const Value& where, const SelectionScope& scope,
                                       const std::vector<Triangle>& boundary);
std::vector<Face> select_faces(const Value& where, const SelectionScope& scope, const std::vector<Face>& boundary);

}  // namespace aspic

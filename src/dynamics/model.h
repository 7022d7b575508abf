// A model contains everything that is constant during a simulation: meshes, mass, the terms of V, pins.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/share.h"
#include "energy/angle_row.h"
#include "energy/energy.h"
#include "energy/mass.h"
#include "energy/tet_elasticity.h"
#include "mesh/numbering.h"
#include "mesh/tet_mesh.h"

namespace aspic {

class Barrier;
class Friction;
class Wind;

// Range of a body in the mesh. Its vertices and elements are consecutive. A body has tets, or is a sheet or a rod.
struct BodyRange {
  std::string name;  // in reports and files
  int first_vertex = 0, vertex_count = 0;
  int first_tet = 0, tet_count = 0;
  int first_triangle = 0, triangle_count = 0;  // in TetMesh::sheet

  int first_segment = 0, segment_count = 0;  // in TetMesh::rods

  bool is_sheet() const { return triangle_count > 0; }
  bool is_rod() const { return segment_count > 0; }
  int first_element(const TetMesh& mesh) const {
    if (is_rod()) return mesh.first_segment() + first_segment;
    return is_sheet() ? mesh.tet_count() + first_triangle : first_tet;
  }
  int element_count() const { return tet_count + triangle_count + segment_count; }
};

// Returns the position of a point at the time [s], given its position at the start [m].
using Motion = std::function<Vec3d(const Vec3d& start, double time)>;

// A Dirichlet condition: prescribes the displacements of vertices along some directions, as those of x(t) = motion(x at
// the start, t). Requires that all directions that pins prescribe at one vertex are linearly independent.
struct Pin {
  std::string name;                    // in reports
  std::vector<int> vertices;           // in the order of the mesh; rows of angles for prescribed twist
  Motion motion;                       // empty: fixed at the start
  std::vector<Vec3d> directions = {};  // orthonormal; empty: all
};

struct Model {
  TetMesh mesh;  // all bodies, one after another
  // The user's numbering of vertices and tets, for messages and files. Everything in the model and the state is in the
  // order of the mesh.
  Numbering numbering;
  std::vector<BodyRange> bodies;  // cover the mesh, or the own vertices of a share, ascending
  std::vector<double> density;    // one per element [kg/m^3]
  // Fields to export with the results, by name, one value per element: "young" [Pa], "poisson" [1].
  std::vector<std::pair<std::string, std::vector<double>>> tet_fields;
  std::unique_ptr<MassMatrix> mass;                        // of all bodies
  std::vector<std::unique_ptr<TetElasticity>> elasticity;  // one per body
  std::vector<std::unique_ptr<Energy>> loads;              // other terms of V: gravity, springs, tractions
  std::vector<std::unique_ptr<Energy>> damping;            // incremental potentials that dissipate
  std::vector<Pin> pins;                                   // Dirichlet conditions
  const Barrier* contact = nullptr;                        // one of the loads; null: no contact
  const Friction* friction = nullptr;                      // one of the damping terms; null: no friction
  const Wind* wind = nullptr;                              // one of the damping terms; null: no wind
  // If several processes hold the model, value(), min_det_F() and the counts of its terms are those of the whole model.
  Share share;
  // Rows of angles at the edges of shells and the segments of rods, after those of the vertices. They are part of the
  // state and of the energies, but not of the mesh: files and selections do not contain them, and only the pins of
  // twist do. A part of a model, see Share, has none.
  std::vector<AngleRow> angle_rows;

  // Rows of the state and of the Hessian, each of 3 degrees of freedom: one per vertex, then the rows of angles.
  int rows() const { return mesh.vertex_count() + static_cast<int>(angle_rows.size()); }
  int own_rows() const { return share.own(rows()); }
  int own_vertices() const { return share.own(mesh.vertex_count()); }
  // Returns the vertex of a row: of a row of angles, a vertex of its first edge.
  int vertex_of_row(int row) const {
    const int angle = row - mesh.vertex_count();
    return angle < 0 ? row : angle_rows[angle].vertex;
  }
  // Returns the entries of the vertices, from a vector with those of all rows.
  std::vector<double> of_vertices(std::span<const double> rows) const {
    const auto first = rows.begin();
    return {first, first + 3 * static_cast<std::ptrdiff_t>(mesh.rest.size())};
  }
};

// Returns the masses of the rows of angles of all bodies, or of one [kg]. Those of other bodies are 0.
std::vector<double> angle_masses(const Model& model, const BodyRange* body = nullptr);

}  // namespace aspic

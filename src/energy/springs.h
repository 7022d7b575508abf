// Springs between vertices and points in space, and between pairs of vertices.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "energy/energy.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// Spring between a vertex and a moving point.
struct PointSpring {
  int vertex = 0;                            // of the mesh
  double stiffness = 0;                      // k [N/m]: V = k/2 |x - target(t)|^2
  std::function<Vec3d(double time)> target;  // [m]
};
// Returns the sum of V over the springs; targets are evaluated once per step. `name` appears in reports.
std::unique_ptr<Energy> make_point_springs(std::string name, std::vector<PointSpring> springs);

// Spring between two vertices.
struct Spring {
  int a = 0, b = 0;        // two vertices of the mesh
  double rest_length = 0;  // l0 [m]
  double stiffness = 0;    // k [N/m]: V = k/2 (|xa - xb| - l0)^2
};
// Returns the sum of V over the springs. `name` appears in reports.
std::unique_ptr<Energy> make_springs(std::string name, std::vector<Spring> springs);

// Returns one spring of the stiffness [N/m] along each edge of tets [first, first + count), relaxed at rest.
std::vector<Spring> edge_springs(const TetMesh& mesh, int first, int count, double stiffness);

}  // namespace aspic

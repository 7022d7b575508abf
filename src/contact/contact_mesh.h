// The surfaces that may touch, with all their points, edges and triangles in one numbering.
#pragma once
#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

using Edge = std::array<int, 2>;

// Writes the positions of all points of an obstacle at a time [s], from those at the start [m].
using ObstacleMotion = std::function<void(double time, std::span<const Vec3d> start, std::span<Vec3d> x)>;

// A body or an obstacle.
struct ContactPart {
  std::string name;
  bool is_obstacle = false;  // its points are not variables
  int first_point = 0, point_count = 0;
  double mean_edge = 0;      // [m]
  double mean_triangle = 0;  // [m^2]
  double young = 0;          // of a body, smallest of its tets [Pa]
  double friction = 0;       // coefficient
  double radius = 0;         // of a capsule or a sphere about its points; 0: another surface [m]
  ObstacleMotion motion;     // of an obstacle; empty: at rest
};

// The half-space that an infinite plane bounds.
struct ContactPlane {
  Vec3d origin, normal;  // origin: at the start. normal: unit vector into the free half-space
  int part;
  int point;  // number of the origin in the mesh
};

// The sum of a function of the distance over the triangles near a point, plus these shares of the sums over their edges
// and points, counts each nearest feature once: 1 - (number of triangles) for an edge, and for a point 1 - (number of
// triangles) - (sum over its edges). On a closed surface these are -1 and 1, on the border of an open one 0.
struct ContactMesh {
  std::vector<ContactPart> parts;
  std::vector<Vec3d> rest;                   // of each point: at rest, or of an obstacle at time 0 [m]
  std::vector<int> row;                      // of each point: its vertex of the model; -1: of an obstacle
  std::vector<int> part;                     // of each point
  std::vector<double> area;                  // of each point: a third of its triangles [m^2]
  std::vector<int> point_share;              // of each point
  std::vector<Triangle> triangles;           // points
  std::vector<Edge> edges;                   // points, ascending
  std::vector<int> edge_share;               // of each edge
  std::vector<double> edge_area;             // of each edge: a third of its triangles [m^2]
  std::vector<std::array<int, 3>> edges_of;  // of each triangle: edges opposite to its corners

  std::vector<ContactPlane> planes;

  int point_count() const { return static_cast<int>(rest.size()); }
  int triangle_count() const { return static_cast<int>(triangles.size()); }
  int edge_count() const { return static_cast<int>(edges.size()); }

  // Adds a surface. `triangles` refer to `X`; `row` gives the vertex of the model of each X, or is empty for an
  // obstacle. Points without triangles are left out.
  void add(const ContactPart& part, std::span<const Vec3d> X, std::span<const Triangle> surface,
           std::span<const int> row);
  // Adds the points within part.radius of the segment between the ends, which may be equal: an obstacle.
  void add_capsule(const ContactPart& part, const std::array<Vec3d, 2>& ends);
  // Adds a plane, whose motion moves its origin.
  void add_plane(const ContactPart& part, const Vec3d& origin, const Vec3d& normal);

  double area_at_rest(const Triangle& t) const;  // [m^2]
};

}  // namespace aspic

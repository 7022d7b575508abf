// Surfaces that may touch, with all their points, edges and triangles in one numbering.
#pragma once
#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

using Edge = std::array<int, 2>;

// Writes the positions of all points of an obstacle at a time [s], given those at the start [m].
using ObstacleMotion = std::function<void(double time, std::span<const Vec3d> start, std::span<Vec3d> x)>;

// A body or an obstacle.
struct ContactPart {
  std::string name;
  bool is_obstacle = false;  // its points are not variables
  int first_point = 0, point_count = 0;
  double mean_edge = 0;      // [m]
  double mean_triangle = 0;  // [m^2]
  double young = 0;          // smallest Young's modulus of a body; of a thin one reduced, see scene_contact.cpp [Pa]
  double friction = 0;       // coefficient
  double offset = 0;         // distance of the surface from the points: half the thickness of a sheet, or the radius of
                             // a rod, a capsule or a sphere [m]
  bool is_round = false;     // a capsule or a sphere
  bool is_hollow = false;    // encloses nothing: a sheet or a rod
  bool is_rod = false;       // its triangles are segments: the last two corners are equal
  double self_offset = 0;    // least gap of a sheet or a rod to itself, see allowed_self_offset() [m]
  ObstacleMotion motion;     // motion of an obstacle; empty: at rest
};

// The half-space bounded by an infinite plane.
struct ContactPlane {
  Vec3d origin, normal;  // origin at the start; unit normal into the free half-space
  int part;
  int point;  // index of the origin in the mesh
};

// Consider the sum of a function of the distance over the triangles near a point. Adding these shares of the sums over
// their edges and points counts each nearest feature once: 1 - (number of triangles) for an edge, and 1 - (number of
// triangles) - (sum over its edges) for a point. In the interior of a surface these are -1 and 1, on its border 0. For
// rods, the segments take the place of the triangles.
struct ContactMesh {
  std::vector<ContactPart> parts;
  std::vector<Vec3d> rest;                   // at rest, or of an obstacle at time 0 [m]
  std::vector<int> row;                      // vertex of the model; -1: of an obstacle
  std::vector<int> part;                     // part of each point
  std::vector<double> area;                  // a third of the triangles at each point [m^2]
  std::vector<int> point_share;              // share of each point
  std::vector<Triangle> triangles;           // point indices
  std::vector<Edge> edges;                   // point indices, ascending
  std::vector<int> edge_share;               // share of each edge
  std::vector<double> edge_area;             // a third of the triangles at each edge [m^2]
  std::vector<std::array<int, 3>> edges_of;  // edges of each triangle, opposite to its corners

  std::vector<ContactPlane> planes;

  int point_count() const { return static_cast<int>(rest.size()); }
  int triangle_count() const { return static_cast<int>(triangles.size()); }
  int edge_count() const { return static_cast<int>(edges.size()); }

  // Adds a surface. `triangles` refer to `X`; `row`: vertex of the model for each X, or empty for an obstacle. Points
  // without triangles are omitted.
  void add(const ContactPart& part, std::span<const Vec3d> X, std::span<const Triangle> surface,
           std::span<const int> row);
  // Adds a rod of radius part.offset. Its areas are those of a band as wide as its diameter.
  void add_rod(const ContactPart& part, std::span<const Vec3d> X, std::span<const Segment> segments,
               std::span<const int> row);
  // Adds an obstacle that consists of the points within part.offset of the segment between the ends, which may be
  // equal.
  void add_capsule(const ContactPart& part, const std::array<Vec3d, 2>& ends);
  // Adds a plane. Its motion moves its origin.
  void add_plane(const ContactPart& part, const Vec3d& origin, const Vec3d& normal);

  std::string pair_name(const std::array<int, 2>& pair) const;  // such as "ear and foot"
  double area_at_rest(const Triangle& t) const;                 // of a segment: length times diameter [m^2]
};

}  // namespace aspic

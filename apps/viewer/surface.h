// The displayed surface: its dependence on the vertices of the model, and the tets behind it.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace aspic::viewer {

inline constexpr uint32_t kNoVertex = 0xffffffff;  // replaces the user's number for a point of a fine skin

// A point of the surface of a rod: a vertex of the model plus an offset, which turns with the mean tangent there.
struct TubePoint {
  int vertex, before, after;  // of the model
  Vec3d tangent, offset;      // at rest; offset [m]

  Vec3d position(std::span<const double> x) const;
};

struct Surface {
  bool is_fine = false;  // a skin that differs from the boundary of the tets
  std::vector<Vec3d> rest;
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> edges;
  std::vector<int> tet;               // behind each triangle
  std::vector<Carrier> carrier;       // model vertices that carry each vertex
  std::vector<int> tets_start, tets;  // tets at each vertex, to average values per tet
  std::vector<TubePoint> tube;        // of the last vertices

  int first_of_tube() const { return vertex_count() - static_cast<int>(tube.size()); }

  int vertex_count() const { return static_cast<int>(rest.size()); }
  int triangle_count() const { return static_cast<int>(triangles.size()); }
  std::span<const int> tets_at(int vertex) const;
  int anchor(int vertex) const;                                        // the model vertex with the largest weight
  uint32_t user_number(int vertex, const Numbering& numbering) const;  // kNoVertex for a point of a fine skin
  Vec3d carried(int vertex, std::span<const double> field) const;      // a field with 3 entries per vertex of the model
  Vec3d position(int vertex, std::span<const double> x) const;         // the same, and the radius of rods
  bool has_same_shape(const Surface& other) const;                     // equal triangles and number of vertices
};

double size_of(const Surface& surface);  // diagonal of the bounding box at rest [m]
bool has_fine_skin(const Scene& scene);
Surface fine_surface(const Scene& scene);  // fine skins of all bodies, and rods
Surface boundary_of(const Model& model);   // boundary of the tets of all bodies, sheets and rods

// A point of the surface in barycentric coordinates of a tet, or of a triangle with its first corner repeated.
struct TetPoint {
  Tet vertices{};
  std::array<double, 4> weights{};
};
TetPoint tet_point(const Surface& surface, const TetMesh& mesh, int triangle, const Vec3d& corner_weights);

// A point of a surface: a triangle and barycentric coordinates.
struct SurfacePoint {
  int triangle = 0;
  Vec3d weights{};
};
SurfacePoint nearest_surface_point(const Surface& surface, const Vec3d& rest);
Vec3d rest_point(const Surface& surface, const SurfacePoint& point);
// Returns the nearest point of another surface at rest.
SurfacePoint same_point(const Surface& from, const SurfacePoint& point, const Surface& to);

}  // namespace aspic::viewer

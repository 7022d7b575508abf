// The surface that is shown: how its vertices hang on those of the model, and which tets lie behind it.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace aspic::viewer {

inline constexpr uint32_t kNoVertex = 0xffffffff;  // the user's number of a point of a fine skin

struct Surface {
  bool is_fine = false;  // a skin apart from the boundary of the tets
  std::vector<Vec3d> rest;
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> edges;
  std::vector<int> tet;                        // behind each triangle
  std::vector<Tet> carrier;                    // model vertices that carry each vertex
  std::vector<std::array<double, 4>> weights;  // and how much
  std::vector<int> tets_start, tets;           // at each vertex: for averages of values per tet

  int vertex_count() const { return static_cast<int>(rest.size()); }
  int triangle_count() const { return static_cast<int>(triangles.size()); }
  std::span<const int> tets_at(int vertex) const;
  int anchor(int vertex) const;  // the model vertex that carries most of it
  Vec3d position(int vertex, std::span<const double> x) const;
  bool has_same_shape(const Surface& other) const;  // the same triangles of as many vertices
};

bool has_fine_skin(const Scene& scene);
Surface fine_surface(const Scene& scene);  // of all bodies
Surface boundary_of(const Model& model);   // of all bodies

// A point of the surface as a point of a tet.
struct TetPoint {
  Tet vertices{};
  std::array<double, 4> weights{};
};
TetPoint tet_point(const Surface& surface, const TetMesh& mesh, int triangle, const Vec3d& corner_weights);

// The triangle of a surface nearest to a point of space at rest, and the weights of its corners there.
struct SurfacePoint {
  int triangle = 0;
  Vec3d weights{};
};
SurfacePoint nearest_surface_point(const Surface& surface, const Vec3d& rest);
Vec3d rest_point(const Surface& surface, const SurfacePoint& point);
// The point of another surface in the same place at rest.
SurfacePoint same_point(const Surface& from, const SurfacePoint& point, const Surface& to);

}  // namespace aspic::viewer

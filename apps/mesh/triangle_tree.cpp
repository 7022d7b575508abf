#include "triangle_tree.h"

#include <cmath>

#include "mesh/triangle_shape.h"

namespace aspic {
namespace {

std::vector<Box> boxes(const TriMesh& mesh) {
  std::vector<Box> boxes(mesh.triangles.size());
  for (size_t t = 0; t < boxes.size(); ++t)
    for (int v : mesh.triangles[t]) boxes[t].add(mesh.vertices[v]);
  return boxes;
}

Vec3d area_vector(const TriMesh& mesh, int triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return 0.5 * cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
}

}  // namespace

double area(const TriMesh& mesh, int triangle) {
  const Vec3d n = area_vector(mesh, triangle);
  return norm(n);
}

Vec3d unit_normal(const TriMesh& mesh, int triangle) {
  const Vec3d n = area_vector(mesh, triangle);
  const double length = norm(n);
  return length > 0 ? (1 / length) * n : Vec3d{};
}

TriangleTree::TriangleTree(const TriMesh& mesh) : mesh_(&mesh), tree_(boxes(mesh)) {}

// Returns the distance at which the line crosses the triangle, including its edges; infinity if it does not. [Moeller
// and Trumbore 1997]
double TriangleTree::crossing(int triangle, const Vec3d& origin, const Vec3d& direction) const {
  constexpr double kEdge = 1e-9;
  const auto& [a, b, c] = mesh_->triangles[triangle];
  const Vec3d u = mesh_->vertices[b] - mesh_->vertices[a], v = mesh_->vertices[c] - mesh_->vertices[a];
  const Vec3d p = cross(direction, v);
  const double determinant = dot(u, p);
  if (determinant == 0) return Box::kInfinity;
  const Vec3d s = origin - mesh_->vertices[a], q = cross(s, u);
  const double first = dot(s, p) / determinant, second = dot(direction, q) / determinant;
  if (!(first >= -kEdge && second >= -kEdge && first + second <= 1 + kEdge)) return Box::kInfinity;
  return dot(v, q) / determinant;
}

TriangleTree::Hit TriangleTree::first_hit(const Vec3d& origin, const Vec3d& direction, double beyond) const {
  Hit hit;
  tree_.for_each_on_ray(origin, direction, hit.distance, [&](int triangle) {
    const double distance = crossing(triangle, origin, direction);
    if (distance > beyond && distance < hit.distance) hit = {distance, triangle};
  });
  return hit;
}

double TriangleTree::distance(const Vec3d& x, double reach) const {
  double nearest = reach * reach;
  bool is_found = false;
  tree_.for_each_near(x, nearest, [&](int triangle) {
    const auto& [a, b, c] = mesh_->triangles[triangle];
    const Vec3d away = x - nearest_point(x, mesh_->vertices[a], mesh_->vertices[b], mesh_->vertices[c]);
    if (dot(away, away) <= nearest) nearest = dot(away, away), is_found = true;
  });
  return is_found ? std::sqrt(nearest) : Box::kInfinity;
}

bool TriangleTree::contains(const Vec3d& x) const {
  constexpr Vec3d kDirections[] = {
      {{0.5407, 0.3119, 0.7813}}, {{-0.2711, 0.9241, 0.2693}}, {{0.8123, -0.4517, -0.3691}}};
  int votes = 0;
  for (const Vec3d& direction : kDirections) {
    const double reach = Box::kInfinity;
    int crossings = 0;
    tree_.for_each_on_ray(x, direction, reach, [&](int triangle) {
      const double distance = crossing(triangle, x, direction);
      if (distance > 0 && distance < reach) ++crossings;
    });
    votes += crossings % 2;
  }
  return votes >= 2;
}

}  // namespace aspic

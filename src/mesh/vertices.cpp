#include "mesh/vertices.h"

namespace aspic {

std::vector<int> vertices_where(const TetMesh& mesh, const Predicate& predicate) {
  std::vector<int> vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (predicate(mesh.rest[v])) vertices.push_back(v);
  return vertices;
}

std::vector<double> at_vertices(const TetMesh& mesh, const std::function<Vec3d(const Vec3d& X)>& f) {
  std::vector<double> values;
  values.reserve(3 * mesh.rest.size());
  for (const Vec3d& X : mesh.rest) {
    const Vec3d v = f(X);
    values.insert(values.end(), {v[0], v[1], v[2]});
  }
  return values;
}

std::vector<double> rest_positions(const TetMesh& mesh) {
  return at_vertices(mesh, [](const Vec3d& X) { return X; });
}

}  // namespace aspic

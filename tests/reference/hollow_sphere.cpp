#include "reference/hollow_sphere.h"

#include <algorithm>
#include <map>

#include "mesh/tet_shape.h"

namespace aspic::verify {

TriMesh octahedral_sphere(int cuts) {
  TriMesh sphere{{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{-1, 0, 0}}, {{0, -1, 0}}, {{0, 0, -1}}},
                 {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}}};
  for (int i = 0; i < cuts; ++i) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [place, is_new] = middles.emplace(std::minmax(a, b), sphere.vertex_count());
      const Vec3d sum = sphere.vertices[a] + sphere.vertices[b];
      if (is_new) sphere.vertices.push_back((1 / norm(sum)) * sum);
      return place->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : sphere.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    sphere.triangles = finer;
  }
  return sphere;
}

TriMesh octant(const TriMesh& sphere) {
  TriMesh part;
  std::map<int, int> index;
  for (Triangle t : sphere.triangles) {
    const bool is_inside = std::all_of(t.begin(), t.end(), [&](int v) {
      const Vec3d& X = sphere.vertices[v];
      return std::min({X[0], X[1], X[2]}) > -1e-9;
    });
    if (!is_inside) continue;
    for (int& v : t) {
      const auto [place, is_new] = index.emplace(v, part.vertex_count());
      if (is_new) part.vertices.push_back(sphere.vertices[v]);
      v = place->second;
    }
    part.triangles.push_back(t);
  }
  return part;
}

TetMesh hollow_sphere(const TriMesh& surface, int layers, double a, double b) {
  TetMesh mesh;
  const int n = surface.vertex_count();
  for (int k = 0; k <= layers; ++k)
    for (const Vec3d& X : surface.vertices) mesh.rest.push_back(((a + (b - a) * k / layers) / norm(X)) * X);
  for (int k = 0; k < layers; ++k)
    for (Triangle t : surface.triangles) {
      std::sort(t.begin(), t.end());
      const int in = k * n, out = in + n;
      for (Tet tet :
           {Tet{in + t[0], in + t[1], in + t[2], out + t[2]}, Tet{in + t[0], in + t[1], out + t[1], out + t[2]},
            Tet{in + t[0], out + t[0], out + t[1], out + t[2]}}) {
        mesh.tets.push_back(tet);
        if (volume(mesh, mesh.tet_count() - 1) < 0) std::swap(mesh.tets.back()[0], mesh.tets.back()[1]);
      }
    }
  return mesh;
}

}  // namespace aspic::verify

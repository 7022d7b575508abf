#include "estimate/indentation_sites.h"

#include <algorithm>
#include <limits>

#include "mesh/surface.h"

namespace aspic {
namespace {

struct Patch {
  Vec3d center{}, area{};  // outward, of length area [m^2]
};

std::vector<Patch> patches(const TetMesh& mesh, std::span<const Triangle> surface) {
  std::vector<Patch> result;
  for (const auto& [a, b, c] : surface) {
    const auto& X = mesh.rest;
    result.push_back({(1.0 / 3) * (X[a] + X[b] + X[c]), 0.5 * cross(X[b] - X[a], X[c] - X[a])});
  }
  return result;
}

struct Normal {
  Vec3d mean{};         // unit vector, outward
  double flatness = 0;  // 1: all surrounding normals are equal
};

Normal normal_around(const std::vector<Patch>& all, const std::vector<Triangle>& surface, const TetMesh& mesh, int v,
                     double radius) {
  Vec3d sum{};
  double area = 0;
  for (size_t k = 0; k < all.size(); ++k) {
    const bool touches = std::find(surface[k].begin(), surface[k].end(), v) != surface[k].end();
    if (!touches && norm(all[k].center - mesh.rest[v]) > radius) continue;
    sum = sum + all[k].area;
    area += norm(all[k].area);
  }
  const double size = norm(sum);
  return {size > 0 ? (1 / size) * sum : Vec3d{}, area > 0 ? size / area : 0};
}

std::vector<IndentationSite> flat_sites(const TetMesh& mesh, const std::vector<Triangle>& surface,
                                        const std::vector<int>& vertices, double radius, double flatness) {
  const std::vector<Patch> all = patches(mesh, surface);
  std::vector<IndentationSite> sites;
  for (const int v : vertices)
    if (const Normal n = normal_around(all, surface, mesh, v, radius); n.flatness >= flatness)
      sites.push_back({v, -1.0 * n.mean});
  return sites;
}

std::vector<int> free_vertices(const TetMesh& mesh, const std::vector<Triangle>& surface, std::span<const int> fixed,
                               double radius) {
  std::vector<char> is_fixed(mesh.rest.size(), 0), is_on_surface(mesh.rest.size(), 0), is_beside(mesh.rest.size(), 0);
  for (const int v : fixed) is_fixed[v] = 1;
  for (const Triangle& t : surface) {
    const bool is_held =
        std::any_of(t.begin(), t.end(), [&](int v) { return is_fixed[v] != 0; });  // an indenter would press on it
    for (const int v : t) is_on_surface[v] = 1, is_beside[v] |= is_held ? 1 : 0;
  }
  std::vector<int> result;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const auto is_near = [&](int f) { return norm(mesh.rest[f] - mesh.rest[v]) <= radius; };
    if (is_on_surface[v] && !is_beside[v] && std::none_of(fixed.begin(), fixed.end(), is_near)) result.push_back(v);
  }
  return result;
}

}  // namespace

std::vector<IndentationSite> indentation_sites(const TetMesh& mesh, std::span<const int> fixed, double radius,
                                               int count) {
  const std::vector<Triangle> surface = boundary_triangles(mesh, 0, mesh.tet_count());
  const std::vector<int> vertices = free_vertices(mesh, surface, fixed, radius);
  std::vector<IndentationSite> all;
  for (const double flatness : {0.9, 0.7, 1e-3})
    if (all = flat_sites(mesh, surface, vertices, radius, flatness); !all.empty()) break;

  std::vector<IndentationSite> chosen;
  std::vector<double> distance(all.size(), std::numeric_limits<double>::infinity());
  Vec3d mean{};
  for (const IndentationSite& s : all) mean = mean + (1.0 / static_cast<double>(all.size())) * mesh.rest[s.vertex];
  for (size_t i = 0; i < all.size(); ++i) distance[i] = norm(mesh.rest[all[i].vertex] - mean);  // initially far outside
  while (static_cast<int>(chosen.size()) < count && !all.empty()) {
    const size_t next = std::max_element(distance.begin(), distance.end()) - distance.begin();
    if (!chosen.empty() && !(distance[next] > 0)) break;
    if (chosen.empty()) std::fill(distance.begin(), distance.end(), std::numeric_limits<double>::infinity());
    chosen.push_back(all[next]);
    for (size_t i = 0; i < all.size(); ++i)
      distance[i] = std::min(distance[i], norm(mesh.rest[all[i].vertex] - mesh.rest[all[next].vertex]));
  }
  return chosen;
}

}  // namespace aspic

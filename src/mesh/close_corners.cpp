#include "mesh/close_corners.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

#include "mesh/box.h"
#include "mesh/topology.h"

namespace aspic {
namespace {

bool has_finite_coordinates(const Vec3d& x) { return std::isfinite(x[0] + x[1] + x[2]); }

Box box_of(const TriMesh& mesh) {
  Box box;
  for (const Vec3d& x : mesh.vertices)
    if (has_finite_coordinates(x)) box.add(x);
  return box;
}

std::vector<char> on_open_edges(const TriMesh& mesh) {
  std::vector<char> is_open(mesh.vertices.size(), 0);
  for_each_edge(edge_uses(mesh.triangles), [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first == 1) is_open[first->edge[0]] = is_open[first->edge[1]] = 1;
  });
  return is_open;
}

using SparseCell = std::array<int64_t, 3>;

// Points that are farther apart than a distance, by cells of that size.
class SparsePoints {
 public:
  SparsePoints(const Box& box, double distance) : lower_(box.lower), distance_(distance) {}

  // Returns the number of the first point within the distance, or adds `x` as the point `number`.
  int first_near(const Vec3d& x, int number, const std::vector<Vec3d>& points) {
    SparseCell cell;
    for (int i = 0; i < 3; ++i) cell[i] = static_cast<int64_t>(std::floor((x[i] - lower_[i]) / distance_));
    int first = number;
    for (int64_t k = 0; k < 27; ++k) {
      const auto near = cells_.find({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
      if (near == cells_.end()) continue;
      for (const int other : near->second)
        if (other < first && norm(points[other] - x) <= distance_) first = other;
    }
    if (first == number) cells_[cell].push_back(number);
    return first;
  }

 private:
  Vec3d lower_;
  double distance_;
  std::map<SparseCell, std::vector<int>> cells_;
};

}  // namespace

double corner_tolerance(const TriMesh& mesh) {
  const Box box = box_of(mesh);
  return kCornerTolerance * norm(box.upper - box.lower);
}

std::vector<int> first_agreeing_corner(const TriMesh& mesh) {
  std::vector<int> first(mesh.vertices.size());
  std::iota(first.begin(), first.end(), 0);
  const double distance = corner_tolerance(mesh);
  if (!(distance > 0) || !std::isfinite(distance)) return first;
  const std::vector<char> is_open = on_open_edges(mesh);
  SparsePoints points(box_of(mesh), distance);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (is_open[v] && has_finite_coordinates(mesh.vertices[v]))
      first[v] = points.first_near(mesh.vertices[v], v, mesh.vertices);
  return first;
}

}  // namespace aspic

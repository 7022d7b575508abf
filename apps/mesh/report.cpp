#include "report.h"

#include <cstdio>
#include <map>

#include "mesh/doctor.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return std::string(text) + '\n';
}

// Mean over the tets of their smallest dihedral angle [degrees].
double average_smallest_dihedral(const TetMesh& mesh) {
  double sum = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) sum += dihedral_range(corners(mesh, t))[0];
  return sum / mesh.tet_count();
}

double average_edge(const TetMesh& mesh) {
  double sum = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const TetCorners X = corners(mesh, t);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) sum += norm(X[a] - X[b]) / 6;
  }
  return sum / mesh.tet_count();
}

}  // namespace

std::string quality_report(const TetMesh& mesh, double seconds) {
  const MeshQuality q = quality(mesh);
  std::string text = line("vertices        %d", mesh.vertex_count()) + line("tets            %d", mesh.tet_count());
  std::map<int, int> regions;
  for (int label : mesh.region) ++regions[label];
  for (const auto& [label, count] : regions) text += line("  region %-6d %d tets", label, count);
  text += line("volume          %.6g in %d component%s", q.total_volume, q.components, q.components == 1 ? "" : "s");
  text += line("edge length     %.4g on average", average_edge(mesh));
  text += line("dihedral angle  smallest %.1f, largest %.1f, average of the smallest per tet %.1f degrees",
               q.min_dihedral, q.max_dihedral, average_smallest_dihedral(mesh));
  text += line("mean ratio      smallest %.3f, average %.3f (1: regular tet)", q.min_mean_ratio, q.average_mean_ratio);
  return text + line("time            %.2f s", seconds);
}

}  // namespace aspic

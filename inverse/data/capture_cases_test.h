// A small data set for tests: a box that rests on z = 0, indented from above.
#pragma once
#include <cmath>

#include "data/data_set.h"
#include "data/surface_projection.h"
#include "io/folder_test.h"
#include "io/mesh_file.h"
#include "mesh/generators.h"

namespace aspic {

inline TetMesh test_box() { return make_box({{0, 0, 0}}, {{0.1, 0.08, 0.06}}, {5, 4, 3}); }

// Data set of a smooth motion that grows with the depth, without noise; similar to an equilibrium.
inline DataSet test_data(int indentations = 3, int depths = 2) {
  DataSet data;
  data.name = "box";
  const TetMesh user = test_box();
  data.numbering = locality_numbering(user);
  Experiment& e = data.experiment;
  e.mesh = from_user(data.numbering, user);
  e.density.assign(e.mesh.tets.size(), 1000);
  for (int v = 0; v < e.mesh.vertex_count(); ++v)
    if (e.mesh.rest[v][2] == 0) e.fixed.push_back(v);
  const SurfaceProjection surface(e.mesh);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 6; ++j) {
      const Vec3d p = {{0.0061 + 0.0125 * i, 0.0047 + 0.0135 * j, 0.07}};
      e.markers.push_back(surface.nearest(p).point);
      data.marker_names.push_back("m" + std::to_string(i) + std::to_string(j));
    }
  data.marker_gap.assign(e.markers.size(), 0.0);
  for (int p = 0; p < indentations; ++p)
    for (int d = 1; d <= depths; ++d) {
      LoadCase load;
      load.name = "poke " + std::to_string(p + 1) + ", depth " + std::to_string(d);
      load.group = "poke " + std::to_string(p + 1);
      load.indenter = Indenter{IndenterShape::sphere, IndenterContact::bonded, 0.01, 1e8};
      load.touch = {{{0.03 + 0.02 * p, 0.03 + 0.01 * (p % 2), 0.07}}, {{0, 0, -1}}, {}};
      const double depth = 0.003 * d;
      load.pose = load.touch;
      load.pose.center[2] -= depth;
      for (int m = 0; m < static_cast<int>(e.markers.size()); ++m) {
        const Vec3d X = position(e.markers[m], e.mesh.rest);
        const double far = std::hypot(X[0] - load.touch.center[0], X[1] - load.touch.center[1]) / 0.03;
        load.positions.push_back({m, X - Vec3d{{0, 0, depth * std::exp(-far * far)}}, {{1e-5, 1e-5, 2e-5}}});
      }
      load.force = Vec3d{{0.01, 0, -0.5 * d}};  // E seems to be about 7.4e3 Pa
      load.force_sigma = {{0.01, 0.01, 0.02}};
      e.cases.push_back(std::move(load));
    }
  return data;
}

}  // namespace aspic

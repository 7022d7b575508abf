// A block of two layers, held below and indented from above: a data set whose material is known, without noise.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "data/data_set.h"
#include "mesh/generators.h"
#include "mesh/surface.h"

namespace aspic {

inline constexpr double kSoftLayer = 1e4, kStiffLayer = 3e4;  // E [Pa] of region 1 above, region 2 below; nu = 0.4

inline Vec3d at_rest(const Experiment& e, int marker) {
  Vec3d X{};
  for (int k = 0; k < 3; ++k) X = X + e.markers[marker].weights[k] * e.mesh.rest[e.markers[marker].vertices[k]];
  return X;
}

// 0.1 m wide; markers at the vertices of its surface that are free; three indentations to two depths each.
inline Experiment indented_block(int cells) {
  Experiment e;
  e.mesh = make_box({{0, 0, 0}}, {{0.1, 0.1, 0.1}}, {cells, cells, cells});
  for (int t = 0; t < e.mesh.tet_count(); ++t) {
    double height = 0;
    for (const int v : e.mesh.tets[t]) height += e.mesh.rest[v][1] / 4;
    e.mesh.region.push_back(height > 0.05 ? 1 : 2);
  }
  e.density.assign(e.mesh.tets.size(), 1000);
  for (int v = 0; v < e.mesh.vertex_count(); ++v)
    if (e.mesh.rest[v][1] < 1e-9) e.fixed.push_back(v);
  std::vector<char> is_seen(e.mesh.rest.size());
  for (const Triangle& t : boundary_triangles(e.mesh, 0, e.mesh.tet_count()))
    for (int k = 0; k < 3; ++k) {
      if (is_seen[t[k]] || e.mesh.rest[t[k]][1] < 1e-9) continue;
      is_seen[t[k]] = 1;
      SurfacePoint marker{t, {}};
      marker.weights[k] = 1;
      e.markers.push_back(marker);
    }
  const double places[][2] = {{0.03, 0.03}, {0.07, 0.04}, {0.05, 0.07}};
  for (int indentation = 0; indentation < 3; ++indentation)
    for (const double depth : {0.004, 0.008}) {
      LoadCase load;
      load.group = "poke " + std::to_string(indentation + 1);
      load.name = load.group + ", " + std::to_string(std::lround(1000 * depth)) + " mm";
      load.indenter = Indenter{IndenterShape::sphere, IndenterContact::bonded, 0.025, 1e8};
      load.touch.center = {{places[indentation][0], 0.12, places[indentation][1]}};
      load.touch.axis = {{0, -1, 0}};
      load.pose = load.touch;
      load.pose.center[1] -= depth;
      for (int m = 0; m < static_cast<int>(e.markers.size()); ++m)
        load.positions.push_back({m, at_rest(e, m), {{1e-4, 1e-4, 1e-4}}});
      load.force = Vec3d{};
      load.force_sigma = {{0.02, 0.02, 0.02}};
      e.cases.push_back(load);
    }
  return e;
}

// Replaces the readings by those for these moduli of the layers.
inline void measure(Experiment& e) {
  const ParameterMap map(e.mesh, "neo_hookean",
                         std::vector<MaterialParameters>(e.mesh.tets.size(), {lame_from_young_poisson(1e4, 0.4), {}}),
                         {{.quantity = "young", .parameterization = Parameterization::regions}});
  Misfit model(e, map);
  std::vector<double> r(static_cast<size_t>(model.residual_count()));
  if (!model.evaluate(std::vector<double>{std::log(kSoftLayer), std::log(kStiffLayer)}, r)) return;
  for (size_t c = 0; c < e.cases.size(); ++c) {
    const CasePrediction& prediction = model.prediction(static_cast<int>(c));
    for (size_t i = 0; i < prediction.markers.size(); ++i) e.cases[c].positions[i].position = prediction.markers[i];
    e.cases[c].force = prediction.wrench.force;
  }
}

inline DataSet measured_block(int cells) {
  DataSet data{.name = "block", .experiment = {indented_block(cells)}};
  measure(data.experiment);
  return data;
}

}  // namespace aspic

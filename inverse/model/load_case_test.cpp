#include "model/load_case.h"

#include <gtest/gtest.h>

#include "mesh/generators.h"

namespace aspic {
namespace {

// A block on z = 0, touched at its side by a bonded indenter with a layer much stiffer than the block. Part of the
// footprint is on triangles with held corners.
Experiment indented_beside_support(double height) {
  Experiment e;
  e.mesh = make_box({{0, 0, 0}}, {{0.1, 0.1, 0.1}}, {6, 6, 6});
  e.density.assign(e.mesh.tets.size(), 1000);
  for (int v = 0; v < e.mesh.vertex_count(); ++v)
    if (e.mesh.rest[v][2] < 1e-9) e.fixed.push_back(v);
  LoadCase load{.name = "poke", .group = "poke"};
  load.indenter = Indenter{IndenterShape::disc, IndenterContact::bonded, 0.02, 1e12};
  load.touch = {.center = {{0, 0.05, height}}, .axis = {{1, 0, 0}}};
  load.pose = load.touch;
  load.pose.center[0] += 0.002;
  load.force = Vec3d{};
  load.force_sigma = {{0.1, 0.1, 0.1}};
  e.cases.push_back(std::move(load));
  return e;
}

double force_along_x(const Experiment& e, double young) {
  const std::vector<MaterialParameters> material(e.mesh.tets.size(), {lame_from_young_poisson(young, 0.4), {}});
  LoadedBody body(e, e.cases[0], "neo_hookean", material, {});
  EXPECT_TRUE(body.solve(material, {})) << body.failure();
  return body.prediction().wrench.force[0];
}

TEST(LoadedBody, BondedIndenterDoesNotPressHeldCorners) {
  for (const double height : {0.03, 0.05}) {
    const Experiment e = indented_beside_support(height);
    const double soft = force_along_x(e, 1e4), stiff = force_along_x(e, 2e4);
    EXPECT_GT(soft, 0);
    EXPECT_NEAR(stiff / soft, 2, 0.03) << "the force belongs to the body, not to the layer, at height " << height;
  }
}

}  // namespace
}  // namespace aspic

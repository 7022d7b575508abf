#include "dynamics/modes.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

Model free_box() { return make_model(make_box({{0, 0, 0}}, {{3, 1, 1}}, {6, 2, 2}), {}); }

Modes modes_at_rest(const Model& model, int count) { return vibration_modes(model, at_rest(model.mesh).q, count); }

TEST(VibrationModes, FreeBodyHasSixRigidModes) {
  const Modes found = modes_at_rest(free_box(), 10);
  ASSERT_EQ(found.status, ModesStatus::converged);
  EXPECT_EQ(found.rigid, 6);
  EXPECT_EQ(found.modes[5].frequency, 0);
  EXPECT_GT(found.modes[6].frequency, 1);
}

TEST(VibrationModes, SingleTetHasSixElasticModes) {
  TetMesh mesh;
  mesh.rest = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
  mesh.tets = {{0, 1, 2, 3}};
  const Modes found = modes_at_rest(make_model(mesh, {}), 100);
  ASSERT_EQ(found.status, ModesStatus::converged);
  EXPECT_EQ(found.rigid, 6);
  EXPECT_EQ(found.modes.size(), 12u);
}

TEST(VibrationModes, BodiesOfVeryDifferentStiffnessAreAllRigid) {
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2});
  const int tets = mesh.tet_count(), vertices = mesh.vertex_count();
  for (int t = 0; t < tets; ++t) {
    Tet tet = mesh.tets[t];
    for (int& v : tet) v += vertices;
    mesh.tets.push_back(tet);
  }
  for (int v = 0; v < vertices; ++v) mesh.rest.push_back(mesh.rest[v] + Vec3d{{3, 0, 0}});
  Model model = make_model(mesh, {.young = 1e6, .density = 1e-3});
  for (int t = tets; t < 2 * tets; ++t) model.density[t] = 1e4;
  model.mass = std::make_unique<MassMatrix>(model.mesh, model.density, MassKind::consistent);
  const Modes found = modes_at_rest(model, 13);
  ASSERT_EQ(found.status, ModesStatus::converged);
  EXPECT_EQ(found.rigid, 12);
}

// Quarter turns map this mesh to itself, so both bending directions have the same frequency.
TEST(VibrationModes, SquareColumnHasPairs) {
  Model model = make_model(make_box({{-0.5, -0.5, 0}}, {{0.5, 0.5, 6}}, {2, 2, 12}, BoxCut::five), {});
  model.pins.push_back({"foot", vertices_where(model.mesh, [](const Vec3d& X) { return X[2] == 0; }), {}});
  const Modes found = modes_at_rest(model, 2);
  ASSERT_EQ(found.status, ModesStatus::converged);
  EXPECT_NEAR(found.modes[1].frequency / found.modes[0].frequency, 1, 1e-9);
}

TEST(VibrationModes, PinsAreFixed) {
  Model model = free_box();
  const std::vector<int> wall = vertices_where(model.mesh, [](const Vec3d& X) { return X[0] == 0; });
  model.pins.push_back({"rail", wall, {}, {Vec3d{{1, 0, 0}}}});
  const Modes found = modes_at_rest(model, 5);
  ASSERT_EQ(found.status, ModesStatus::converged);
  EXPECT_EQ(found.rigid, 3);  // two translations and a rotation in the plane
  for (const Mode& mode : found.modes)
    for (const int v : wall) EXPECT_EQ(mode.shape[3 * v], 0);
}

TEST(VibrationModes, RejectModelWithoutFreeVertices) {
  Model model = free_box();
  model.pins.push_back({"all", vertices_where(model.mesh, [](const Vec3d&) { return true; }), {}});
  EXPECT_EQ(modes_at_rest(model, 5).status, ModesStatus::all_held);
}

TEST(VibrationModes, RejectUnstablePositions) {
  const Model model = free_box();
  std::vector<double> x = at_rest(model.mesh).q;
  for (size_t i = 0; i < x.size(); i += 3) x[i] *= 0.3;
  EXPECT_EQ(vibration_modes(model, x, 5).status, ModesStatus::indefinite);
}

TEST(VibrationModes, StopAtDeadline) {
  const Model model = free_box();
  double now = 0;
  const WallClock clock = [&] { return now += 1; };
  EXPECT_EQ(vibration_modes(model, at_rest(model.mesh).q, 5, StopToken(clock, 3)).status, ModesStatus::interrupted);
}

TEST(VibrationModes, AreBitReproducibleForAnyThreadCount) {
  const Model model = free_box();
  set_thread_count(1);
  const Modes one = modes_at_rest(model, 8);
  set_thread_count(3);
  const Modes three = modes_at_rest(model, 8);
  for (int k = 0; k < 8; ++k) {
    EXPECT_EQ(one.modes[k].frequency, three.modes[k].frequency) << k;
    EXPECT_EQ(one.modes[k].shape, three.modes[k].shape) << k;
  }
}

}  // namespace
}  // namespace aspic

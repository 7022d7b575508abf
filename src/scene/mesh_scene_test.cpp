// Meshes without a scene.
#include "scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/mesh_file.h"
#include "mesh/generators.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(MeshAlone, FallsOntoFloor) {
  const TestFolder folder;
  write_mesh(folder / "tower.msh", make_box({{0, 0, 0}}, {{40, 100, 40}}, {3, 8, 3}));
  Scene scene = load_scene(folder / "tower.msh");
  EXPECT_EQ(scene.name, "tower");
  EXPECT_EQ(scene.steps, 200);
  EXPECT_THAT(scene.notes, Contains(AllOf(HasSubstr("100"), HasSubstr("becomes 1 m"))));
  EXPECT_THAT(scene.notes, Contains(HasSubstr("material.young = 2e+05 Pa")));
  EXPECT_THAT(scene.notes, Contains(HasSubstr("a floor 0.2 m below the body")));
  EXPECT_TRUE(scene.simulation.model().pins.empty());
  int contacts = 0;
  for (int step = 0; step < 40; ++step) {
    const StepReport report = scene.simulation.step();
    EXPECT_TRUE(is_success(report.status));
    contacts += report.contacts;
  }
  EXPECT_GT(contacts, 0);
  for (size_t k = 1; k < scene.simulation.state().q.size(); k += 3) EXPECT_GT(scene.simulation.state().q[k], -0.2);
}

// Contact needs other integrators, and pins that are overridden must exist.
TEST(MeshAlone, IsPinnedIfOverridesNeedPins) {
  const TestFolder folder;
  write_mesh(folder / "tower.msh", make_box({{0, 0, 0}}, {{40, 100, 40}}, {3, 8, 3}));
  Scene scene = load_scene(folder / "tower.msh", {.overrides = {"time.integrator=\"trapezoid\""}});
  EXPECT_EQ(scene.simulation.model().contact, nullptr);
  EXPECT_EQ(scene.simulation.model().pins[0].vertices.size(), 16u);
  EXPECT_THAT(scene.notes, Contains(HasSubstr("as if glued to the ground")));
  double speed = 0;
  for (int step = 0; step < 3; ++step) EXPECT_TRUE(is_success(scene.simulation.step().status));
  for (size_t i = 0; i < scene.simulation.state().q.size(); i += 3)
    speed = std::max(speed, scene.simulation.state().qdot[i] * -1);
  EXPECT_GT(speed, 0.1);  // the top swings back, meters per second
}

TEST(MeshAlone, IsPinnedIfItIntersectsItself) {
  const TestFolder folder;
  TetMesh two = make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2});
  const TetMesh inside = make_box({{0.5, 0.5, 0.5}}, {{1.5, 1.6, 1.7}}, {2, 2, 2});
  for (const Tet& t : inside.tets) two.tets.push_back({t[0] + 27, t[1] + 27, t[2] + 27, t[3] + 27});
  two.rest.insert(two.rest.end(), inside.rest.begin(), inside.rest.end());
  write_mesh(folder / "two.msh", two);
  Scene scene = load_scene(folder / "two.msh");
  EXPECT_THAT(scene.notes,
              Contains(AllOf(HasSubstr("pin: "), HasSubstr("because its surface intersects itself near ("))));
  EXPECT_TRUE(is_success(scene.simulation.step().status));
}

// A body that widens upwards from its pins needs a stiffer material than a column of its height.
TEST(MeshAlone, StiffnessCarriesItsWeight) {
  const TestFolder folder;
  TetMesh funnel = make_box({{-0.5, 0, -0.5}}, {{0.5, 1, 0.5}}, {4, 8, 4});
  for (Vec3d& X : funnel.rest) X = {{X[0] * (0.1 + X[1]), X[1], X[2] * (0.1 + X[1])}};
  write_mesh(folder / "funnel.msh", funnel);
  Scene scene = load_scene(folder / "funnel.msh", {.overrides = {"deform.displacement=[0,0,0]"}});
  EXPECT_THAT(scene.notes, Contains(HasSubstr("sinks by about 5 %")));
  EXPECT_THAT(scene.resolved, HasSubstr("neo_hookean_log"));
  for (int step = 0; step < 40; ++step) EXPECT_TRUE(is_success(scene.simulation.step().status));
  double deepest = 0;
  for (int v = 0; v < scene.simulation.model().mesh.vertex_count(); ++v)
    deepest = std::max(deepest, scene.simulation.model().mesh.rest[v][1] - scene.simulation.state().q[3 * v + 1]);
  EXPECT_GT(deepest, 0.01);
  EXPECT_LT(deepest, 0.1);
}

TEST(MeshAlone, NamesFreeParts) {
  const TestFolder folder;
  TetMesh two = make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2});
  const TetMesh above = make_box({{0, 1.5, 0}}, {{1, 2, 1}}, {2, 1, 2});
  for (const Tet& t : above.tets) two.tets.push_back({t[0] + 27, t[1] + 27, t[2] + 27, t[3] + 27});
  two.rest.insert(two.rest.end(), above.rest.begin(), above.rest.end());
  write_mesh(folder / "two.msh", two);
  EXPECT_THAT(load_scene(folder / "two.msh", {.overrides = {"deform.displacement=[0,0,0]"}}).notes,
              Contains(AllOf(HasSubstr("2 parts"), HasSubstr("no pin holds 1 of them (the first holds tet 48)"))));
}

TEST(MeshAlone, OverridesReplaceDefaultsAndTheirNotes) {
  const TestFolder folder;
  write_mesh(folder / "tower.msh", make_box({{0, 0, 0}}, {{40, 100, 40}}, {1, 2, 1}));
  const Scene scene = load_scene(folder / "tower.msh", {.overrides = {"scale=0.001", "material.young=5e4"}});
  EXPECT_NEAR(rest(scene, scene.simulation.model().mesh.vertex_count() - 1)[1], 0.1, 1e-15);
  EXPECT_THAT(scene.notes, Not(Contains(HasSubstr("becomes 1 m"))));
  EXPECT_THAT(scene.notes, Not(Contains(HasSubstr("material.young"))));
  EXPECT_THAT(scene.resolved, HasSubstr("young = 50000.0"));
  EXPECT_THAT(refusal_of(folder / "tower.msh", {.overrides = {"material.yuong=1"}}), HasSubstr("'young'"));
}

TEST(MeshAlone, ResolvedSceneGivesTheSameBits) {
  const TestFolder folder;
  write_mesh(folder / "tower.mesh", make_box({{0, 0, 0}}, {{0.4, 1.3, 0.4}}, {2, 4, 2}));
  Scene scene = load_scene(folder / "tower.mesh");
  write_inputs(scene, folder / "run");
  Scene again = load_scene(folder.write("run/scene.toml", scene.resolved));
  EXPECT_EQ(scene.resolved, again.resolved);
  scene.simulation.step();
  again.simulation.step();
  EXPECT_EQ(scene.simulation.state().q, again.simulation.state().q);
}

// A mesher that copies a prepared mesh to the path after "-o".
fs::path fake_mesher(const TestFolder& folder, const fs::path& prepared) {
  const fs::path script =
      folder.write("mesher", "#!/bin/sh\necho \"$1: it is thin\"\nwhile [ \"$1\" != -o ]; do shift; done\ncp '" +
                                 prepared.string() + "' \"$2\"\n");
  fs::permissions(script, fs::perms::owner_all);
  return script;
}

TEST(MeshAlone, SurfaceIsFilledOnce) {
  const TestFolder folder;
  write_mesh(folder / "tets.mesh", make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}));
  write_mesh(folder / "cube.obj", read_tri_mesh(folder / "tets.mesh"));
  const fs::path mesher = fake_mesher(folder, folder / "tets.mesh");
  Scene scene = load_scene(folder / "cube.obj", {.mesher = mesher});
  EXPECT_THAT(scene.notes, Contains(HasSubstr("a surface; filled with 48 tets")));
  EXPECT_THAT(scene.notes, Contains("cube.obj: it is thin"));
  EXPECT_EQ(scene.skins[0].rest.vertex_count(), 26);
  EXPECT_THAT(scene.resolved, AllOf(HasSubstr("inputs/cube.msh"), HasSubstr("inputs/cube.skin.obj")));

  write_inputs(scene, folder / "run");
  Scene again = load_scene(folder.write("run/scene.toml", scene.resolved), {.mesher = "/nowhere/mesher"});
  EXPECT_EQ(scene.resolved, again.resolved);
  scene.simulation.step();
  again.simulation.step();
  EXPECT_EQ(scene.simulation.state().q, again.simulation.state().q);
}

TEST(MeshAlone, LinesAreARod) {
  const TestFolder folder;
  Scene level = load_scene(folder.write("cable.obj", "v 0 0 0\nv 1 0 0\nv 2 0.1 0\nv 3 0 0\nl 4 3 2 1\n"));
  EXPECT_THAT(level.notes, Contains(HasSubstr("rod.radius = 0.01 m")));
  EXPECT_THAT(level.notes, Contains(HasSubstr("swings from its end, vertex 3")));
  EXPECT_EQ(level.simulation.model().mesh.rods.size(), 3u);
  for (int step = 0; step < 20; ++step) EXPECT_TRUE(is_success(level.simulation.step().status));
  const Scene upright = load_scene(folder.write("hair.obj", "v 0 0 0\nv 0 1 0\nv 0.1 2 0\nl 1 2 3\n"));
  EXPECT_THAT(upright.notes, Contains(HasSubstr("so that the rod hangs")));
  EXPECT_EQ(upright.simulation.model().pins[0].vertices.size(), 1u);
  EXPECT_THAT(refusal_of(folder.write("point.obj", "v 0 0 0\nv 0 0 0\nl 1 2\n")), HasSubstr("all vertices coincide"));
}

TEST(MeshAlone, OpenSurfaceIsRejected) {
  const TestFolder folder;
  folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
  EXPECT_THAT(refusal_of(folder / "open.obj"), AllOf(HasSubstr("open.obj"), HasSubstr("open")));
}

}  // namespace
}  // namespace aspic

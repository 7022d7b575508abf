#include "scene/body_rod.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "contact/barrier.h"
#include "mesh/rod_shapes.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using ::testing::HasSubstr;

const std::string kRope = R"(
gravity = [0.0, 0.0, -9.81]
[time]
step = 0.01
duration = 0.1
[[body]]
name = "rope"
material = { young = 1e7, poisson = 0.3, density = 1000.0 }
)";

TEST(RodScene, PolylineOfAnObjFileFalls) {
  const TestFolder folder;
  folder.write("rope.obj", "v 0 0 0\nv 0.1 0 0\nv 0.2 0 0\nv 0.3 0.1 0\nl 1 2 3 4\n");
  Scene scene = load_scene(folder.write("rope.toml", kRope + "mesh = \"rope.obj\"\nrod = { radius = 0.002 }\n"));
  const Model& model = scene.simulation.model();
  EXPECT_EQ(model.mesh.rods.size(), 3);
  EXPECT_EQ(model.rows(), 5);
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(is_success(scene.simulation.step().status));
  EXPECT_NEAR(positions(scene)[2], -9.81 * 0.01 * 0.01 * 6, 1e-9);
}

TEST(RodScene, ReadsLinesOfVtu) {
  const TestFolder folder;
  folder.write("rope.vtu", R"(<VTKFile type="UnstructuredGrid" version="1.0"><UnstructuredGrid>
<Piece NumberOfPoints="3" NumberOfCells="1"><Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 2 0 0</DataArray></Points><Cells>
<DataArray type="Int32" Name="connectivity" format="ascii">0 1 2</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">3</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">4</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)");
  const Scene scene = load_scene(folder.write("rope.toml", kRope + "mesh = \"rope.vtu\"\nrod = { radius = 0.01 }\n"));
  EXPECT_EQ(scene.simulation.model().mesh.rods.size(), 2);
}

// The twist of the last segment is prescribed, that between two pinned vertices is held.
TEST(RodScene, TwistIsPrescribedAtTheEnds) {
  const TestFolder folder;
  Scene scene = load_scene(folder.write(
      "rope.toml", kRope + "shape = { line = { to = [1.0, 0.0, 0.0], size = 0.1 } }\n"
                           "rod = { radius = 0.01, twist_last = \"5 * t\" }\n[[body.pin]]\nwhere = \"x < 0.11\"\n"
                           "[[body.pin]]\nwhere = \"x > 0.89\"\n"));
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(is_success(scene.simulation.step().status));
  const Model& model = scene.simulation.model();
  EXPECT_EQ(model.pins.size(), 4);
  const std::vector<double>& q = scene.simulation.state().q;
  EXPECT_EQ(q[3 * 11], 0);
  EXPECT_NEAR(q[3 * 11 + 9], 0.01 * 0.5, 1e-15);
}

TEST(RodScene, RefusesBranchesAndKeysOfSolids) {
  const TestFolder folder;
  folder.write("tree.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 1 1 0\nl 1 2 3\nl 2 4\n");
  const auto refusal = [&](const std::string& text) { return refusal_of(folder.write("rope.toml", text)); };
  const std::string line = "shape = { line = { to = [1.0, 0.0, 0.0], size = 0.1 } }\nrod = { radius = 0.01 }\n";
  EXPECT_THAT(refusal(kRope + "mesh = \"tree.obj\"\nrod = { radius = 0.01 }\n"), HasSubstr("meet at vertex 1"));
  EXPECT_THAT(refusal(kRope + line + "order = 2\n"), HasSubstr("has `rod`"));
  EXPECT_THAT(refusal(kRope + line + "damping = { stiffness = 0.1 }\n"), HasSubstr("damping.stiffness"));
  EXPECT_THAT(refusal(kRope + "shape = { line = { to = [1.0, 0.0, 0.0], size = 0.1 } }\n"), HasSubstr("add rod"));
}

// A rope falls across a pinned bar; vertices of neither are near the crossing.
TEST(RodScene, RodsCarryEachOther) {
  const TestFolder folder;
  Scene scene = load_scene(folder.write("cross.toml", R"(
gravity = [0.0, 0.0, -9.81]
[time]
step = 0.01
duration = 0.4
[contact]
friction = 0.3
[[body]]
name = "bar"
rod = { radius = 0.005 }
shape = { line = { from = [-0.1, 0.01, 0.0], to = [0.12, 0.01, 0.0], size = 0.04 } }
material = { young = 1e8, poisson = 0.3, density = 1000.0 }
[[body.pin]]
where = "all"
[[body]]
name = "rope"
rod = { radius = 0.005 }
shape = { line = { from = [0.01, -0.1, 0.02], to = [0.01, 0.12, 0.02], size = 0.04 } }
material = { young = 1e8, poisson = 0.3, density = 1000.0 }
)"));
  for (int k = 0; k < 40; ++k) ASSERT_TRUE(is_success(scene.simulation.step().status));
  const Model& model = scene.simulation.model();
  const ContactSummary contact = model.contact->summary(scene.simulation.state().q, 0);
  EXPECT_GT(contact.contacts, 0);
  EXPECT_GT(contact.min_gap, 0);
  EXPECT_NEAR(scene.simulation.state().q[3 * static_cast<size_t>(model.bodies[1].first_vertex) + 2], 0.01, 0.005);
}

TEST(RodShapes, ChainsSegmentsFromEndToEnd) {
  const std::vector<Segment> open = chained(4, {{2, 1}, {3, 2}, {1, 0}});
  EXPECT_EQ(open, (std::vector<Segment>{{3, 2}, {2, 1}, {1, 0}}));
  const std::vector<Segment> closed = chained(3, {{1, 2}, {0, 1}, {0, 2}});
  EXPECT_EQ(closed, (std::vector<Segment>{{1, 2}, {2, 0}, {0, 1}}));
  EXPECT_EQ(make_ring(1, 0.5).rods.size(), 13);
  EXPECT_EQ(make_helix(1, 0.1, 2, 0.5).rods.size(), 25);
}

}  // namespace
}  // namespace aspic

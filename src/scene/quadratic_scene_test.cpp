// Scenes with order = 2.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "io/vtu.h"
#include "mesh/tet_nodes.h"
#include "results/run_directory.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kQuadraticCube = kCube + "order = 2\n";  // 27 corners, 98 edges
const std::string kHeld = "[[body.pin]]\nwhere = \"x < 0.1\"\n";

TEST(QuadraticScene, AddsNodesAfterUsersVertices) {
  const Scene scene = load(kQuadraticCube);
  const Model& model = scene.simulation.model();
  ASSERT_EQ(model.mesh.vertex_count(), 125);
  for (int t = 0; t < model.mesh.tet_count(); ++t)
    for (const int v : model.mesh.tets[t]) EXPECT_LT(model.numbering.vertex.to_user(v), 27);
  EXPECT_NE(scene.resolved.find("order = 2"), std::string::npos);
}

TEST(QuadraticScene, LinearAndQuadraticBodiesMix) {
  std::string linear = kCube;
  linear.replace(linear.find("cube"), 4, "other");
  const Scene scene = load(linear + "translate = [5, 0, 0]\n" + kQuadraticCube);
  const TetMesh& mesh = scene.simulation.model().mesh;
  EXPECT_EQ(nodes_of(mesh, 0).count, 4);
  EXPECT_EQ(nodes_of(mesh, mesh.tet_count() - 1).count, 10);
  EXPECT_EQ(mesh.vertex_count(), 27 + 125);
}

TEST(QuadraticScene, ListOfPinnedCornersIncludesNodesBetweenThem) {
  const Scene scene = load(kQuadraticCube + "[[body.pin]]\nwhere = { vertices = [0, 1, 3, 4] }\n");
  const std::vector<int>& pinned = scene.simulation.model().pins[0].vertices;
  EXPECT_EQ(pinned.size(), 9u);  // a face of a cell: four corners, four edges and a diagonal
  for (const int v : pinned) EXPECT_EQ(scene.simulation.model().mesh.rest[v][0], 0);
}

TEST(QuadraticScene, FreeFallIsExact) {
  for (const std::string mass : {"consistent", "lumped"}) {
    Scene scene = load("gravity = [0, 0, -10]\nsolver = { mass = \"" + mass + "\" }\n" + kQuadraticCube);
    const std::vector<double> before = scene.simulation.state().q;
    for (int i = 0; i < 3; ++i) scene.simulation.step();
    const double fall = 10 * 1e-4 * (1 + 2 + 3);  // backward Euler, h = 0.01 s
    for (size_t i = 0; i < before.size(); ++i)
      EXPECT_NEAR(scene.simulation.state().q[i], before[i] - (i % 3 == 2 ? fall : 0), 1e-5 * fall) << mass;
  }
}

TEST(QuadraticScene, FrameStoresQuadraticCells) {
  const TestFolder folder;
  Scene scene = load_scene(folder.write("beam.toml", "time = { duration = 0.02 }\n" + kQuadraticCube + kHeld));
  RunDirectory run = RunDirectory::create(folder.path() / "run", scene, ExistingRun::refuse);
  for (int i = 0; i < scene.steps; ++i) run.on_step(scene.simulation.step(), scene.simulation);
  run.finish(scene.simulation);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path() / "run")) {
    if (entry.path().extension() != ".vtu") continue;
    const Vtu vtu = read_vtu(entry.path());
    ASSERT_EQ(vtu.mesh.mids.size(), vtu.mesh.tets.size());
    EXPECT_EQ(vtu.mesh.rest.size(), 125u);
    return;
  }
  FAIL() << "no frame";
}

TEST(QuadraticScene, BitsDoNotDependOnThreadCount) {
  const int before = thread_count();
  std::vector<std::vector<double>> ends;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    Scene scene = load(kQuadraticCube + kHeld);
    for (int i = 0; i < 3; ++i) scene.simulation.step();
    ends.push_back(scene.simulation.state().q);
  }
  set_thread_count(before);
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(QuadraticScene, UniformLoadsHaveExactResultants) {
  Scene scene = load("gravity = [0, 0, 0]\n" + kQuadraticCube + kHeld +
                     "[[body.traction]]\nwhere = \"x > 0.99\"\nvalue = [3, 0, 0]\n"
                     "[[body.force]]\nwhere = \"all\"\nvalue = [0, 2, 0]\n");
  std::vector<double> g(3 * 125, 0.0);
  const Model& model = scene.simulation.model();
  for (const auto& load : model.loads) ActiveTerm(*load).add_gradient(scene.simulation.state().q, 1, g);
  Vec3d sum{};
  for (int v = 0; v < 125; ++v) sum = sum + vertex(g, v);
  EXPECT_LT(distance(sum, {{-3, -2, 0}}), 1e-13);
}

TEST(QuadraticScene, RefusesWhatNeedsLinearTets) {
  EXPECT_THAT(refusal(kQuadraticCube + "[[body.spring]]\nedges = true\nstiffness = 1\n"),
              AllOf(HasSubstr("beam.toml:6"), HasSubstr("order = 2")));
  EXPECT_THAT(refusal(kQuadraticCube + "elastic = false\n"), AllOf(HasSubstr("beam.toml:4"), HasSubstr("elastic")));
  EXPECT_THAT(refusal(kCube + "order = 3\n"), HasSubstr("order"));
}

}  // namespace
}  // namespace aspic

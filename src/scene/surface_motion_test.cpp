// Pins and springs that follow a recorded surface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/base64.h"
#include "io/folder_test.h"
#include "io/mesh_examples_test.h"
#include "io/mesh_file.h"
#include "io/pc2.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "scene/placement.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kSingle = 3e-7;  // round-off of a point cache in a box of size 2

TriMesh cube_surface() { return boundary_surface(make_box({{0, 0, 0}}, {{1, 1, 1}}, {3, 3, 3})).surface; }

using Moved = std::vector<AffineMap>;  // one per frame

void record(const TestFolder& folder, const Moved& frames) {
  const TriMesh surface = cube_surface();
  write_mesh(folder / "rest.ply", surface);
  Pc2File cache = Pc2File::create(folder / "moving.pc2", surface.vertex_count());
  for (const AffineMap& map : frames) {
    std::vector<double> x;
    for (const Vec3d& X : surface.vertices)
      for (int axis = 0; axis < 3; ++axis) x.push_back(map(X)[axis]);
    cache.append(x);
  }
  cache.close();
}

const std::string kFollow = "motion = { recording = { file = \"moving.pc2\", mesh = \"rest.ply\", fps = 10 } }\n";
const std::string kPinned = "[[body.pin]]\nwhere = \"x < 0.6\"\n" + kFollow;  // on the surface and inside

Scene cube_with(const TestFolder& folder, const std::string& rest, const std::string& head = "") {
  return load_scene(folder.write("s.toml", head + kCube + rest));
}

AffineMap turned(double angle, const Vec3d& shift) { return {rotation({{1, 2, -1}}, angle), shift}; }

TEST(SurfaceMotion, PinsFollowRigidMotionExactly) {
  const TestFolder folder;
  const Moved frames = {{}, turned(0.5, {{0.1, 0, 0.2}}), turned(1.4, {{0.3, -0.2, 0}})};
  record(folder, frames);
  const Scene scene = cube_with(folder, kPinned);
  const Model& model = scene.simulation.model();
  ASSERT_GT(model.pins[0].vertices.size(), 17U);
  for (const int v : model.pins[0].vertices) {
    const Vec3d& X = model.mesh.rest[v];
    for (const int k : {0, 1, 2}) EXPECT_LT(distance(model.pins[0].motion(X, 0.1 * k), frames[k](X)), kSingle);
    EXPECT_LT(distance(model.pins[0].motion(X, 9), frames[2](X)), kSingle);  // constant after the last sample
  }
  EXPECT_THAT(scene.notes, testing::Not(testing::Contains(HasSubstr("jumps"))));
}

TEST(SurfaceMotion, PinsMoveLinearlyBetweenSamples) {
  const TestFolder folder;
  const AffineMap moved{identity3<double>(), {{1, 2, 4}}};
  record(folder, {{}, moved});
  const Scene scene = cube_with(folder, kPinned);
  const Pin& pin = scene.simulation.model().pins[0];
  const Vec3d X = scene.simulation.model().mesh.rest[pin.vertices[0]];
  EXPECT_LT(distance(pin.motion(X, 0.025), X + Vec3d{{0.25, 0.5, 1}}), kSingle);
}

TEST(SurfaceMotion, PinsFollowTheJointsOfAGltfFile) {
  const TestFolder folder;
  folder.write("arm.gltf", gltf_arm());
  const std::string recording = "{ file = \"arm.gltf\", mesh = \"arm.gltf\", fps = 10 }";
  const Scene scene =
      cube_with(folder, "[[body.pin]]\nwhere = \"z < 0.1\"\nmotion = { recording = " + recording + " }\n");
  const Pin& pin = scene.simulation.model().pins[0];
  EXPECT_LT(distance(pin.motion({{0, 0, 0}}, 1), {{0, 0, 5}}), kSingle);
  EXPECT_LT(distance(pin.motion({{1, 1, 0}}, 1), {{1.5, 1.5, 5}}), 1e-6);
}

TEST(SurfaceMotion, ResultsOfAGltfFileHoldItsBuffer) {
  const TestFolder folder;
  const std::string text = gltf_arm(), mark = "data:application/octet-stream;base64,";
  const size_t begin = text.find(mark), end = text.find('"', begin);
  std::string bytes;
  std::string_view coded = std::string_view(text).substr(begin + mark.size(), end - begin - mark.size());
  ASSERT_TRUE(decode_base64(coded, SIZE_MAX, bytes));
  folder.write("the arm.bin", bytes);
  folder.write("arm.gltf", text.substr(0, begin) + "the%20arm.bin" + text.substr(end));
  const Scene scene = cube_with(folder,
                                "[[body.pin]]\nwhere = \"z < 0.1\"\nmotion = { recording = { file = \"arm.gltf\", "
                                "mesh = \"arm.gltf\", fps = 10 } }\n");
  write_inputs(scene, folder / "run");
  folder.write("run/scene.toml", scene.resolved);
  std::filesystem::remove(folder / "the arm.bin");
  EXPECT_EQ(load_scene(folder / "run/scene.toml").resolved, scene.resolved);
}

TEST(SurfaceMotion, AttachedVerticesFollowARecordedObstacle) {
  const TestFolder folder;
  const Moved frames = {{}, turned(0.5, {{0.1, 0, 0.2}})};
  record(folder, frames);
  TriMesh band = cube_surface();
  for (Vec3d& X : band.vertices) X = X + 0.2 * (X - Vec3d{{0.5, 0.5, 0.5}});
  write_mesh(folder / "band.ply", band);
  const auto scene = [&](const std::string& placement) {
    return folder.write("s.toml",
                        "[[obstacle]]\nname = \"arm\"\nmesh = \"rest.ply\"\nrecording = { file = \"moving.pc2\", fps = "
                        "10 }\n[[body]]\nname = \"band\"\nmesh = \"band.ply\"\nshell = { thickness = 1e-3 }\n" +
                            placement +
                            "[[attach]]\npoints = { body = \"band\", where = \"all\" }\nto = { obstacle = \"arm\" }\n");
  };
  const Scene follows = load_scene(scene(""));
  const Model& model = follows.simulation.model();
  for (const Vec3d& X : model.mesh.rest) EXPECT_LT(distance(model.pins[0].motion(X, 0.1), frames[1](X)), kSingle);
  EXPECT_THAT(refusal_of(scene("translate = [0.01, 0, 0]\n")),
              AllOf(HasSubstr("s.toml:12:"), HasSubstr("`translate` of it and of body 'band' differ")));
}

TEST(SurfaceMotion, RecordingIsPlacedWithBody) {
  const TestFolder folder;
  const AffineMap moved = turned(0.7, {{0.1, 0.2, 0.3}});
  record(folder, {{}, moved});
  const std::string place = "scale = 2\nrotate = { axis = [0, 1, 1], angle_deg = 70 }\ntranslate = [3, 0, 1]\n";
  const Scene scene = cube_with(folder, place + kPinned.substr(0, 13) + "where = \"all\"\n" + kFollow);
  const AffineMap placed{2.0 * rotation({{0, 1, 1}}, 70 * 3.14159265358979 / 180), {{3, 0, 1}}};
  const Model& model = scene.simulation.model();
  const TetMesh cube = make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2});
  for (int v = 0; v < cube.vertex_count(); ++v)
    EXPECT_LT(distance(model.pins[0].motion(rest(scene, v), 0.1), placed(moved(cube.rest[v]))), 4 * kSingle);
}

TEST(SurfaceMotion, SpringsFollowAndPullTheBody) {
  const TestFolder folder;
  const AffineMap moved{identity3<double>(), {{0.5, 0, 0}}};
  record(folder, {{}, moved});
  Scene scene = cube_with(folder, "[[body.spring]]\nstiffness = 1e7\nwhere = \"all\"\n" + kFollow,
                          "gravity = [0, 0, 0]\n[time]\nstep = 0.02\n");
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(is_success(scene.simulation.step().status));
  const std::vector<double> x = positions(scene);
  for (int v = 0; v < 27; ++v) EXPECT_LT(distance(vertex(x, v), rest(scene, v) + Vec3d{{0.5, 0, 0}}), 1e-3);
}

// A body that starts deformed still follows the points next to its rest shape.
TEST(SurfaceMotion, AttachmentIsThatOfRestShape) {
  const TestFolder folder;
  const AffineMap pose{identity3<double>(), {{2, 0, 0}}};
  record(folder, {pose, pose});
  const Scene scene = cube_with(folder, "deform = { displacement = [2, 0, 0] }\n" + kPinned);
  const Model& model = scene.simulation.model();
  for (const int v : model.pins[0].vertices) {
    const Vec3d start = pose(model.mesh.rest[v]);
    EXPECT_LT(distance(model.pins[0].motion(start, 0.05), start), 3 * kSingle);
  }
}

TEST(SurfaceMotion, ResolvedSceneIsTheSame) {
  const TestFolder folder;
  record(folder, {{}, turned(0.2, {})});
  Scene scene = cube_with(folder, kPinned);
  write_inputs(scene, folder / "run");
  Scene again = load_scene(folder.write("run/scene.toml", scene.resolved));
  EXPECT_EQ(again.resolved, scene.resolved);
  for (int i = 0; i < 3; ++i) scene.simulation.step(), again.simulation.step();
  EXPECT_EQ(positions(again), positions(scene));
}

TEST(SurfaceMotion, MistakesAreExplained) {
  const TestFolder folder;
  record(folder, {{}, {}});
  const auto refused = [&](const std::string& motion) {
    return refusal_of(
        folder.write("s.toml", kCube + "[[body.pin]]\nwhere = \"all\"\nmotion = { recording = { " + motion + " } }\n"));
  };
  EXPECT_EQ(refused("file = \"moving.pc2\", mesh = \"rest.ply\""), "");
  EXPECT_THAT(refused("file = \"moving.pc2\""), AllOf(HasSubstr("s.toml:6:"), HasSubstr("needs `mesh`")));
  EXPECT_THAT(refused("file = \"rest.ply\", mesh = \"rest.ply\""), HasSubstr("not a point cache"));
  EXPECT_THAT(refused("file = \"moving.pc2\", mesh = \"moving.pc2\""), HasSubstr("no mesh format"));
  write_mesh(folder / "other.obj", boundary_surface(make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1})).surface);
  EXPECT_THAT(refused("file = \"moving.pc2\", mesh = \"other.obj\""),
              AllOf(HasSubstr("s.toml:6:"), HasSubstr("56 points, but the mesh has 8 vertices")));
  record(folder, {{1e-3 * identity3<double>(), {{NAN, 0, 0}}}});
  EXPECT_THAT(refused("file = \"moving.pc2\", mesh = \"rest.ply\""), HasSubstr("point 0 of sample 0 is not finite"));
  record(folder, {{}});
  TriMesh small = cube_surface();
  for (Vec3d& X : small.vertices) X = 0.01 * X;
  write_mesh(folder / "rest.ply", small);
  EXPECT_THAT(refused("file = \"moving.pc2\", mesh = \"rest.ply\""), HasSubstr("m away from this surface"));
  const auto obstacle = [&](const std::string& keys) {
    return refusal_of(folder.write("s.toml", kCube + "[[obstacle]]\nmesh = \"rest.ply\"\n" + keys));
  };
  EXPECT_THAT(obstacle(kFollow), HasSubstr("its own `recording`"));
  EXPECT_THAT(obstacle("recording = { file = \"moving.pc2\", mesh = \"rest.ply\" }\n"), HasSubstr("remove this one"));
}

}  // namespace
}  // namespace aspic

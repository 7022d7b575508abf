// Stiffness and pins that are painted on a surface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "io/folder_test.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "mesh/tet_shape.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

using Paint = std::function<double(const Vec3d&)>;

std::string painted_ply(const TriMesh& surface, const Paint& paint, const std::string& name = "paint") {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(surface.vertex_count()) +
                     "\nproperty double x\nproperty double y\nproperty double z\nproperty double " + name +
                     "\nelement face " + std::to_string(surface.triangle_count()) +
                     "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3d& X : surface.vertices)
    text += number_text(X[0]) + " " + number_text(X[1]) + " " + number_text(X[2]) + " " + number_text(paint(X)) + "\n";
  for (const auto& [a, b, c] : surface.triangles)
    text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  return text;
}

TriMesh cube_surface(int cells) {
  return boundary_surface(make_box({{0, 0, 0}}, {{1, 1, 1}}, {cells, cells, cells})).surface;
}

std::string cube(int cells, const std::string& rest) {
  const std::string n = std::to_string(cells);
  return "[[body]]\nname = \"cube\"\nshape = { box = { upper = [1, 1, 1], cells = [" + n + ", " + n + ", " + n +
         "] } }\n" + rest;
}

constexpr const char* kYoung = "material = { young = { file = \"cube.ply\", name = \"paint\", range = [1e4, 1e6] } }\n";

std::vector<double> young_of(const Scene& scene) {
  return scene.simulation.model().numbering.tet.to_user(scene.simulation.model().tet_fields[0].second);
}

// Linear functions are harmonic, and linear elements reproduce them.
TEST(PaintedFields, ReproducesLinearPaint) {
  const TestFolder folder;
  folder.write("cube.ply", painted_ply(cube_surface(3), [](const Vec3d& X) { return 0.2 + 0.5 * X[0] - 0.1 * X[1]; }));
  const Scene scene = load_scene(folder.write("s.toml", cube(5, kYoung)));
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {5, 5, 5});
  const std::vector<double> young = young_of(scene);
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const Vec3d X = centroid(mesh, t);
    const double exact = 1e4 + (1e6 - 1e4) * (0.2 + 0.5 * X[0] - 0.1 * X[1]);
    EXPECT_NEAR(young[t], exact, 1e-9 * exact);
  }
}

// x^2 - y^2 is harmonic; the error of linear elements falls with the square of the edge length.
TEST(PaintedFields, ConvergesToHarmonicFunction) {
  const Paint harmonic = [](const Vec3d& X) { return 1 + X[0] * X[0] - X[1] * X[1]; };
  double errors[2];
  for (const int i : {0, 1}) {
    const int cells = 5 * (i + 1);
    const TestFolder folder;
    folder.write("cube.ply", painted_ply(cube_surface(cells), harmonic));
    const Scene scene = load_scene(folder.write("s.toml", cube(cells, kYoung)));
    const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {cells, cells, cells});
    const std::vector<double> young = young_of(scene);
    double sum = 0;
    for (int t = 0; t < mesh.tet_count(); ++t) {
      const double error = (young[t] - 1e4) / (1e6 - 1e4) - harmonic(centroid(mesh, t));
      sum += error * error / mesh.tet_count();
    }
    errors[i] = std::sqrt(sum);
  }
  EXPECT_LT(errors[0], 0.02);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.4);
}

TEST(PaintedFields, FollowsPlacementOfBody) {
  const TestFolder folder;
  folder.write("cube.ply", painted_ply(cube_surface(2), [](const Vec3d& X) { return X[2]; }));
  const std::string place =
      "scale = [2, 3, 0.5]\nrotate = { axis = [1, 2, 3], angle_deg = 50 }\ntranslate = [1, 0, -4]\n";
  const Scene placed = load_scene(folder.write("s.toml", cube(4, place + kYoung)));
  const Scene plain = load_scene(folder.write("s.toml", cube(4, kYoung)));
  const std::vector<double> a = young_of(placed), b = young_of(plain);
  for (size_t t = 0; t < a.size(); ++t) EXPECT_NEAR(a[t], b[t], 1e-9 * b[t]);
}

TEST(PaintedFields, StaysWithinPaintedRange) {
  const TestFolder folder;
  folder.write("cube.ply", painted_ply(cube_surface(4), [](const Vec3d& X) { return X[0] > 0.4 ? 1 : 0; }));
  const std::vector<double> young = young_of(load_scene(folder.write("s.toml", cube(6, kYoung))));
  EXPECT_GE(*std::min_element(young.begin(), young.end()), 1e4);
  EXPECT_LE(*std::max_element(young.begin(), young.end()), 1e6 * (1 + 1e-15));
}

std::vector<int> pinned(const Scene& scene) {
  std::vector<int> vertices;
  for (const int v : scene.simulation.model().pins[0].vertices)
    vertices.push_back(scene.simulation.model().numbering.vertex.to_user(v));
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

TEST(PaintedFields, SelectsVerticesAboveThreshold) {
  const TestFolder folder;
  folder.write("cube.ply", painted_ply(cube_surface(3), [](const Vec3d& X) { return X[0]; }));
  const auto with = [&](const std::string& where) {
    return load_scene(folder.write("s.toml", cube(4, "[[body.pin]]\nwhere = " + where + "\n")));
  };
  EXPECT_EQ(pinned(with("{ file = \"cube.ply\", name = \"paint\", above = 0.7 }")), pinned(with("\"x > 0.7\"")));
  EXPECT_EQ(pinned(with("{ file = \"cube.ply\", name = \"paint\" }")), pinned(with("\"x > 0.51\"")));
}

TEST(PaintedFields, ScaleTheStiffnessOfSprings) {
  const TestFolder folder;
  folder.write("cube.ply", painted_ply(cube_surface(3), [](const Vec3d& X) { return X[0]; }));
  const auto spring = [](const std::string& where, double stiffness) {
    return "[[body.spring]]\nwhere = " + where + "\nstiffness = " + number_text(stiffness) + "\n";
  };
  const auto stepped = [&](const std::string& springs) {
    Scene scene = load_scene(folder.write("s.toml", cube(4, springs)));
    scene.simulation.step();
    return positions(scene);
  };
  const std::vector<double> painted = stepped(spring("{ file = \"cube.ply\", name = \"paint\", above = 0.3 }", 400));
  const std::vector<double> listed = stepped(spring("\"x > 0.3 && x < 0.6\"", 200) +
                                             spring("\"x > 0.6 && x < 0.8\"", 300) + spring("\"x > 0.8\"", 400));
  ASSERT_EQ(painted.size(), listed.size());
  for (size_t i = 0; i < painted.size(); ++i) EXPECT_NEAR(painted[i], listed[i], 1e-9);
  EXPECT_THAT(
      refusal_of(folder.write("s.toml", cube(4, spring("{ file = \"cube.ply\", name = \"paint\", above = -1 }", 400)))),
      AllOf(HasSubstr("s.toml:"), HasSubstr("painted value 0"), HasSubstr("above = 0")));
}

TEST(PaintedFields, SelectsTrianglesAndTetsWithAllCorners) {
  const TestFolder folder;
  folder.write("cube.ply", painted_ply(cube_surface(3), [](const Vec3d& X) { return X[0]; }));
  std::string listed;
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {4, 4, 4});
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.rest[v][0] > 0.4) listed += (listed.empty() ? "" : ", ") + std::to_string(v);
  const auto with = [&](const std::string& where) {
    const std::string text = "[[body.traction]]\nvalue = [1, 0, 0]\nwhere = " + where +
                             "\n[[body.force]]\nvalue = [0, 1, 0]\nwhere = " + where;
    Scene scene = load_scene(folder.write("s.toml", "gravity = [0, 0, 0]\n" + cube(4, text + "\n")));
    scene.simulation.step();
    return positions(scene);
  };
  EXPECT_EQ(with("{ file = \"cube.ply\", name = \"paint\", above = 0.4 }"), with("{ vertices = [" + listed + "] }"));
}

TEST(PaintedFields, ResolvedSceneIsTheSame) {
  const TestFolder folder;
  folder.write("cube.ply", painted_ply(cube_surface(3), [](const Vec3d& X) { return X[0] * X[1]; }));
  const std::string pin = "[[body.pin]]\nwhere = { file = \"cube.ply\", name = \"paint\", above = 0.6 }\n";
  const Scene scene = load_scene(folder.write("s.toml", cube(4, kYoung + pin)));
  write_inputs(scene, folder / "run");
  const Scene again = load_scene(folder.write("run/scene.toml", scene.resolved));
  EXPECT_EQ(again.resolved, scene.resolved);
  EXPECT_EQ(young_of(again), young_of(scene));
  EXPECT_EQ(scene.input_files.size(), 1U);  // both keys share the file
  folder.write("run/inputs/cube.painted1.ply", painted_ply(cube_surface(3), [](const Vec3d&) { return 0.7; }));
  EXPECT_THAT(refusal_of(folder / "run/scene.toml"), AllOf(HasSubstr("hash"), HasSubstr("changed")));
}

TEST(PaintedFields, MistakesAreExplained) {
  const TestFolder folder;
  const Paint height = [](const Vec3d& X) { return X[1]; };
  folder.write("cube.ply", painted_ply(cube_surface(2), height));
  folder.write("young.csv", "1\n");
  const auto field = [&](const std::string& table) {
    return refusal_of(folder.write("s.toml", cube(2, "material = { young = { " + table + " } }\n")));
  };
  const auto where = [&](const std::string& table) {
    return refusal_of(folder.write("s.toml", cube(2, "[[body.pin]]\nwhere = { " + table + " }\n")));
  };
  EXPECT_THAT(field("file = \"cube.ply\", name = \"pain\", range = [1, 2]"),
              AllOf(HasSubstr("s.toml:4:"), HasSubstr("cube.ply"), HasSubstr("did you mean 'paint'?")));
  EXPECT_THAT(field("file = \"cube.ply\""), AllOf(HasSubstr("s.toml:4:"), HasSubstr("needs `name`")));
  EXPECT_THAT(field("file = \"cube.ply\", name = \"paint\", range = [1, -2]"), HasSubstr("must be > 0"));
  EXPECT_THAT(field("file = \"cube.ply\", name = \"paint\", range = [1]"), HasSubstr("two numbers"));
  EXPECT_THAT(field("file = \"cube.pl\", name = \"paint\""), HasSubstr("did you mean 'cube.ply'?"));
  EXPECT_THAT(where("file = \"young.csv\", name = \"paint\""), HasSubstr("a painted surface is a PLY file"));
  EXPECT_THAT(where("file = \"cube.ply\""), HasSubstr("name"));
  EXPECT_THAT(where("file = \"cube.ply\", name = \"paint\", above = 1"),
              AllOf(HasSubstr("s.toml:5:"), HasSubstr("the largest value of \"paint\" is 1, not above 1")));
  TriMesh elsewhere = cube_surface(2);
  for (Vec3d& X : elsewhere.vertices) X = 1e-3 * X;  // kilometers for a body in meters
  folder.write("cube.ply", painted_ply(elsewhere, height));
  EXPECT_THAT(where("file = \"cube.ply\", name = \"paint\""),
              AllOf(HasSubstr("up to 1.73 m away"), HasSubstr("same units")));
  for (Vec3d& X : elsewhere.vertices) X = 1e6 * X;  // millimeters; its corner is that of the body
  folder.write("cube.ply", painted_ply(elsewhere, height));
  EXPECT_THAT(where("file = \"cube.ply\", name = \"paint\""),
              AllOf(HasSubstr("the diagonal of this surface is 1732 m"), HasSubstr("same units")));
  folder.write("cube.ply", painted_ply(cube_surface(2), [](const Vec3d&) { return NAN; }));
  EXPECT_THAT(where("file = \"cube.ply\", name = \"paint\""), AllOf(HasSubstr("cube.ply:11"), HasSubstr("nan")));
  folder.write("cube.ply", painted_ply({{{{0, 0, 1e300}}, {{1, 0, 0}}, {{0, 1, 0}}}, {{0, 1, 2}}}, height));
  EXPECT_THAT(where("file = \"cube.ply\", name = \"paint\""), HasSubstr("beyond 1e30 m"));
}

}  // namespace
}  // namespace aspic

// From files to simulations.
#include "scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/mesh_file.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "scene/test_folder_test.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kCube = "[[body]]\nname = \"cube\"\nshape = { box = { upper = [1, 1, 1], cells = [2, 2, 2] } }\n";

Scene load(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const TestFolder folder;
  return load_scene(folder.write("beam.toml", text), {.overrides = overrides});
}

std::string refusal_of(const fs::path& path, const SceneOptions& options = {}) {
  try {
    load_scene(path, options);
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "";
}

std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const TestFolder folder;
  return refusal_of(folder.write("beam.toml", text), {.overrides = overrides});
}

Vec3d vertex(const std::vector<double>& values, int i) {
  return {{values[3 * i], values[3 * i + 1], values[3 * i + 2]}};
}

double distance(const Vec3d& a, const Vec3d& b) { return std::sqrt(dot(a - b, a - b)); }

const std::vector<fs::path>& scene_files() {
  static const std::vector<fs::path> files = [] {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(fs::path(ASPIC_SOURCE_DIR) / "scenes"))
      if (entry.path().extension() == ".toml" && entry.path().stem() != "bunny") found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
  }();
  return files;
}

class SceneFile : public ::testing::TestWithParam<fs::path> {};

TEST_P(SceneFile, LoadsAndTakesTwoConvergedSteps) {
  Scene scene = load_scene(GetParam());
  EXPECT_GT(scene.steps, 0);
  EXPECT_EQ(scene.name, GetParam().stem());
  for (int step = 0; step < 2; ++step) {
    const StepReport report = scene.simulation.step();
    EXPECT_TRUE(is_success(report.status)) << to_string(report.status);
    EXPECT_GT(report.min_det_F, 0);
  }
}

TEST_P(SceneFile, ResolvedSceneGivesTheSameBits) {
  const TestFolder folder;
  Scene scene = load_scene(GetParam());
  write_inputs(scene, folder / "run");
  Scene again = load_scene(folder.write("run/scene.toml", scene.resolved));
  EXPECT_EQ(scene.resolved, again.resolved);
  scene.simulation.step();
  again.simulation.step();
  EXPECT_EQ(scene.simulation.state().q, again.simulation.state().q);
  EXPECT_EQ(scene.simulation.state().qdot, again.simulation.state().qdot);
}

TEST_P(SceneFile, IsShort) {
  const std::string text = read_file(GetParam());
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 35);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneFile, ::testing::ValuesIn(scene_files()),
                         [](const auto& file) { return file.param.stem().string(); });

TEST(SceneReference, IsTheCommittedPage) {
  const fs::path page = fs::path(ASPIC_SOURCE_DIR) / "docs" / "scene.md";
  if (std::getenv("ASPIC_UPDATE_DOCS")) write_file(page, scene_reference());
  EXPECT_EQ(read_file(page), scene_reference()) << "ASPIC_UPDATE_DOCS=1 test_scene writes docs/scene.md anew";
}

TEST(Scene, CombinesBodiesInOrder) {
  const Scene scene = load(kCube +
                           "[[body]]\nshape = { box = { lower = [2, 0, 0], upper = [3, 1, 1], cells = [1, 1, 1]"
                           ", cut = \"five\" } }\nmaterial = { density = 10 }\n");
  const Model& model = scene.simulation.model();
  ASSERT_EQ(model.bodies.size(), 2u);
  EXPECT_EQ(model.bodies[1].first_vertex, 27);
  EXPECT_EQ(model.bodies[1].vertex_count, 8);
  EXPECT_EQ(model.bodies[1].first_tet, 48);
  EXPECT_EQ(model.bodies[1].tet_count, 5);
  EXPECT_NEAR(model.mass->total(), 1010, 1e-9);
  EXPECT_EQ(scene.skins.size(), 2u);
  std::vector<double> carried(3 * scene.skins[1].rest.vertex_count());
  carry(scene.skins[1].embedding, scene.simulation.state().q, carried);
  EXPECT_EQ(vertex(carried, 0).a[0], scene.skins[1].rest.vertices[0][0]);
  EXPECT_THAT(scene.simulation.potential_names(), ElementsAre("elasticity_cube", "elasticity_body2", "gravity"));
}

TEST(Scene, StepsCoverTheDuration) {
  EXPECT_EQ(load("[time]\nstep = 0.01\nduration = 2\n" + kCube).steps, 200);
  EXPECT_EQ(load("[time]\nstep = 0.03\nduration = 0.1\n" + kCube).steps, 4);
  EXPECT_EQ(load("[time]\nduration = 0\n" + kCube).steps, 0);
}

TEST(Scene, PlacesTheRestShapeByScaleThenRotationThenTranslation) {
  const Scene scene = load(kCube +
                           "scale = [1, 2, 3]\nrotate = { axis = [0, 0, 5], angle_deg = 90 }\n"
                           "translate = [10, 0, 0]\n");
  // Vertex (1, 1, 1) of the box: scaled (1, 2, 3), turned (-2, 1, 3), moved (8, 1, 3).
  const Vec3d corner = scene.simulation.model().mesh.rest[26];
  EXPECT_LT(distance(corner, {{8, 1, 3}}), 1e-14);
}

TEST(Scene, EulerAnglesTurnAboutXThenYThenZ) {
  const Scene scene = load(kCube + "rotate = { euler_deg = [90, 0, 90] }\n");
  // (0, 1, 0) -> (0, 0, 1) about x -> (0, 0, 1) about z.
  EXPECT_LT(distance(scene.simulation.model().mesh.rest[6], {{0, 0, 1}}), 1e-15);
}

TEST(Scene, DeformsRelativeToRestAboutTheCentre) {
  const auto corner = [](const std::string& deform) {
    return vertex(load(kCube + "deform = { " + deform + " }\n").simulation.state().q, 26);
  };
  EXPECT_LT(distance(corner("scale = 2"), {{1.5, 1.5, 1.5}}), 1e-15);
  EXPECT_LT(distance(corner("scale = [1, 2, 1]"), {{1, 1.5, 1}}), 1e-15);
  EXPECT_LT(distance(corner("matrix = [[1, 1, 0], [0, 1, 0], [0, 0, 1]]"), {{1.5, 1, 1}}), 1e-15);
  EXPECT_LT(distance(corner("displacement = [\"0.1 * Y\", 0.2, 0]"), {{1.1, 1.2, 1}}), 1e-15);
  // The top turns by +90 degrees, the bottom by -90 degrees, about the axis through (0.5, 0.5).
  EXPECT_LT(distance(corner("twist = { axis = [0, 0, 1], angle_deg = 180 }"), {{0, 1, 1}}), 1e-15);
}

TEST(Scene, DisplacementFileGivesEachVertexItsOwn) {
  const TestFolder folder;
  std::string csv = "x,y,z\n";
  for (int i = 0; i < 27; ++i) csv += std::to_string(i) + ",0,0.5\n";
  folder.write("u.csv", csv);
  const std::string text = kCube + "scale = 100\ndeform = { file = \"u.csv\" }\n";
  const Scene scene = load_scene(folder.write("beam.toml", text));
  EXPECT_EQ(vertex(scene.simulation.state().q, 26).a[0], 126);
  EXPECT_THAT(scene.resolved, HasSubstr("inputs/cube.displacement.csv"));
  folder.write("u.csv", "1,2,3\n");
  EXPECT_THAT(refusal_of(folder / "beam.toml"), HasSubstr("1 lines of numbers; one for a vertex is needed, 27 in all"));
  folder.write("u.csv", "1,2,3\n1,2,nan\n");
  EXPECT_THAT(refusal_of(folder / "beam.toml"), AllOf(HasSubstr("u.csv:2:"), HasSubstr("nan")));
}

TEST(Scene, InitialVelocityFollowsFormulasAndSpin) {
  const Scene scene = load(kCube + "velocity = [\"Y\", 2, 0]\nangular_velocity = [0, 0, 3]\n");
  // At (1, 1, 1), half a metre from the centre of mass along x and y.
  EXPECT_LT(distance(vertex(scene.simulation.state().qdot, 26), {{1 - 1.5, 2 + 1.5, 0}}), 1e-12);
}

TEST(Scene, GravityActsOnTheMassOfEachVertex) {
  Scene scene = load("gravity = [0, 0, -2]\n[time]\nstep = 0.1\n" + kCube);
  scene.simulation.step();
  for (int v = 0; v < 27; ++v) EXPECT_NEAR(scene.simulation.state().qdot[3 * v + 2], -0.2, 1e-9);
}

TEST(Scene, TractionAndPressureAddUpToForceTimesArea) {
  // A free cube of mass 1000 kg: total force 50 N/m^2 * 1 m^2 along x gives v = F h / m.
  const auto velocity = [](const std::string& load_text) {
    Scene scene = load("gravity = [0, 0, 0]\n[time]\nstep = 0.1\n" + kCube + load_text);
    scene.simulation.step();
    const Model& model = scene.simulation.model();
    Vec3d momentum{};
    for (int v = 0; v < 27; ++v)
      momentum = momentum + model.mass->vertex_mass()[v] * vertex(scene.simulation.state().qdot, v);
    return (1 / model.mass->total()) * momentum;
  };
  const Vec3d expected{{50 * 0.1 / 1000, 0, 0}};
  EXPECT_LT(distance(velocity("[[body.traction]]\nwhere = \"x > 0.999\"\nvalue = [50, 0, 0]\n"), expected), 1e-12);
  EXPECT_LT(distance(velocity("[[body.traction]]\nwhere = \"x < 0.001\"\npressure = \"50\"\n"), expected), 1e-12);
  EXPECT_LT(distance(velocity("[[body.force]]\nvalue = [50, 0, 0]\n"), expected), 1e-12);
  EXPECT_LT(distance(velocity("[[body.traction]]\nwhere = \"all\"\npressure = 50\n"), {{0, 0, 0}}), 1e-12);
}

TEST(Scene, PinsMoveAsTold) {
  const auto end = [](const std::string& motion, int steps) {
    Scene scene = load("gravity = [0, 0, 0]\n[time]\nstep = 0.1\n" + kCube +
                       "[[body.pin]]\nwhere = \"all\"\nmotion = " + motion + "\n");
    for (int i = 0; i < steps; ++i) scene.simulation.step();
    return vertex(scene.simulation.state().q, 26);
  };
  EXPECT_EQ(distance(end("\"fixed\"", 2), {{1, 1, 1}}), 0);
  EXPECT_LT(distance(end("{ linear = { velocity = [1, 0, 0] } }", 2), {{1.2, 1, 1}}), 1e-12);
  EXPECT_LT(distance(end("{ linear = { velocity = [1, 0, 0], until = 0.1 } }", 2), {{1.1, 1, 1}}), 1e-12);
  EXPECT_LT(distance(end("{ rotate = { axis = [0, 0, 1], rate_deg = 450 } }", 2), {{0, 1, 1}}), 1e-12);
  EXPECT_LT(distance(end("{ rotate = { axis = [0, 0, 1], center = [0, 0, 0], rate_deg = 450 } }", 2), {{-1, 1, 1}}),
            1e-12);
  EXPECT_LT(distance(end("{ displacement = [\"t * Y\", 0, 0] }", 2), {{1.2, 1, 1}}), 1e-12);
  EXPECT_LT(
      distance(end("{ keyframes = [{ time = 0, displacement = [0, 0, 0] }, { time = 0.4, displacement = [0, 1, 0] "
                   "}] }",
                   1),
               {{1, 1.25, 1}}),
      1e-12);
}

TEST(Scene, AMotionThatDoesNotStartAtZeroIsNoted) {
  const Scene scene = load(kCube + "[[body.pin]]\nwhere = \"y < 0.1\"\nmotion = { displacement = [0.5, 0, 0] }\n");
  EXPECT_THAT(scene.notes, Contains(HasSubstr("jumps by 0.5 m")));
}

TEST(Scene, SelectionsMeanWhatTheySay) {
  const auto pinned = [](const std::string& where) {
    return load(kCube + "[[body.pin]]\nwhere = " + where + "\n").simulation.model().pins[0].vertices.size();
  };
  EXPECT_EQ(pinned("\"y > 0.9 && X < 0.1\""), 3u);
  EXPECT_EQ(pinned("{ box = { lower = [0, 0, 0], upper = [0.5, 0.5, 0.5] } }"), 8u);
  EXPECT_EQ(pinned("{ sphere = { center = [0, 0, 0], radius = 0.5 } }"), 4u);
  EXPECT_EQ(pinned("{ vertices = [3, 1, 4, 1] }"), 3u);
  EXPECT_EQ(pinned("{ lowest = 0 }"), 9u);
  EXPECT_EQ(pinned("{ highest = 0.5 }"), 18u);
}

TEST(Scene, LowestFollowsGravity) {
  const Scene scene = load("gravity = [3, 0, 0]\n" + kCube + "[[body.pin]]\nwhere = { lowest = 0 }\n");
  for (const int v : scene.simulation.model().pins[0].vertices) EXPECT_EQ(scene.simulation.model().mesh.rest[v][0], 1);
}

TEST(Scene, ASelectionOfNothingIsRefusedWithTheExtent) {
  EXPECT_THAT(refusal(kCube + "[[body.pin]]\nwhere = \"y > 9\"\n"),
              AllOf(HasSubstr("beam.toml:5:9"), HasSubstr("\"y > 9\""), HasSubstr("no vertex of body 'cube'"),
                    HasSubstr("from (0, 0, 0) to (1, 1, 1)")));
  EXPECT_THAT(refusal(kCube + "[[body.pin]]\nwhere = { vertices = [27] }\n"),
              AllOf(HasSubstr("27"), HasSubstr("beyond the last vertex of body 'cube', 26")));
  EXPECT_THAT(refusal(kCube + "[[body.traction]]\nwhere = { vertices = [0, 1] }\npressure = 1\n"),
              HasSubstr("no boundary triangle"));
  EXPECT_THAT(refusal(kCube + "[[body.force]]\nwhere = \"z > 5\"\nvalue = [0, 0, 0]\n"), HasSubstr("no tet"));
  EXPECT_THAT(refusal(kCube + "[[body.pin]]\nwhere = \"1 / x\"\n"), AllOf(HasSubstr(":5:"), HasSubstr("inf")));
}

TEST(Scene, AVertexInTwoPinsIsRefusedWithBothNames) {
  EXPECT_THAT(
      refusal(kCube + "[[body.pin]]\nname = \"left\"\nwhere = \"x < 0.1\"\n[[body.pin]]\nname = \"low\"\nwhere = "
                      "\"y < 0.1\"\n"),
      AllOf(HasSubstr("beam.toml:9:9"), HasSubstr("'left'"), HasSubstr("'low'"), HasSubstr("(0, 0, 0)")));
}

TEST(Scene, ParametersVaryFromTetToTet) {
  const TestFolder folder;
  std::string csv;
  for (int t = 0; t < 48; ++t) csv += std::to_string(1000 + t) + "\n";
  folder.write("rho.csv", csv);
  const Scene scene = load_scene(folder.write(
      "beam.toml", kCube + "material = { density = { file = \"rho.csv\" }, young = \"1e5 * (1 + X)\" }\n"));
  EXPECT_EQ(scene.simulation.model().density[47], 1047);
  EXPECT_THAT(scene.resolved, AllOf(HasSubstr("inputs/cube.density.csv"), HasSubstr("fnv1a:")));
  folder.write("rho.csv", "1\n" + csv);
  EXPECT_THAT(refusal_of(folder / "beam.toml"), HasSubstr("49 lines of numbers"));
  csv.replace(0, 4, "-100");
  folder.write("rho.csv", csv);
  EXPECT_THAT(refusal_of(folder / "beam.toml"), AllOf(HasSubstr("density = -100 in tet 0"), HasSubstr("must be > 0")));
  EXPECT_THAT(refusal(kCube + "material = { poisson = \"X\" }\n"), HasSubstr("poisson = "));
  EXPECT_THAT(refusal(kCube + "material = { young = \"1 / 0\" }\n"), HasSubstr("inf"));
}

TEST(Scene, RegionsMapLabelsToValues) {
  const TestFolder folder;
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
  mesh.region = {1, 1, 1, 7, 7, 7};
  write_mesh(folder / "cube.msh", mesh);
  const auto with = [&](const std::string& regions) {
    return folder.write("beam.toml",
                        "[[body]]\nmesh = \"cube.msh\"\nmaterial = { density = { regions = " + regions + " } }\n");
  };
  const Scene scene = load_scene(with("{ 1 = 100, 7 = 300 }"));
  EXPECT_EQ(scene.simulation.model().density, (std::vector<double>{100, 100, 100, 300, 300, 300}));
  EXPECT_THAT(refusal_of(with("{ 1 = 100 }")), AllOf(HasSubstr("region 7 is missing"), HasSubstr("1, 7")));
  EXPECT_THAT(refusal_of(with("{ 1 = 100, 7 = 1, 8 = 2 }")), HasSubstr("no region 8"));
}

TEST(Scene, ExtraParametersBelongToTheirMaterial) {
  EXPECT_THAT(refusal(kCube + "material = { model = \"neo_hookean\", ratio = 1 }\n"), HasSubstr("ratio"));
}

TEST(Scene, LockingIsNoted) {
  EXPECT_THAT(load(kCube + "material = { poisson = 0.49 }\n").notes, Contains(HasSubstr("lock above 0.45")));
  EXPECT_THAT(load(kCube + "material = { poisson = 0.45 }\n").notes, Not(Contains(HasSubstr("lock"))));
}

TEST(Scene, FilesAreConfinedToTheFolderAndTheOneAbove) {
  const TestFolder folder;
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
  fs::create_directories(folder / "a/b/scenes");
  fs::create_directories(folder / "a/b/assets");
  write_mesh(folder / "a/b/assets/cube.msh", mesh);
  write_mesh(folder / "a/cube.msh", mesh);
  const auto with = [&](const std::string& name) {
    return folder.write("a/b/scenes/s.toml", "[[body]]\nmesh = \"" + name + "\"\n");
  };
  EXPECT_EQ(refusal_of(with("../assets/cube.msh")), "");
  EXPECT_THAT(refusal_of(with("../../cube.msh")), AllOf(HasSubstr("s.toml:2:8"), HasSubstr("outside")));
  EXPECT_THAT(refusal_of(with("../assets/../../cube.msh")), HasSubstr("outside"));
  const std::string absolute = (folder / "a/cube.msh").string();
  EXPECT_THAT(refusal_of(with(absolute)), HasSubstr("outside"));
  EXPECT_EQ(refusal_of(with(absolute), {.allow_outside = true}), "");
  EXPECT_EQ(refusal_of(with("missing.msh"), {.overrides = {"mesh=" + absolute}}), "");
  EXPECT_THAT(refusal_of(with("../assets/cub.msh")), AllOf(HasSubstr("does not exist"), HasSubstr("'cube.msh'")));
  EXPECT_THAT(refusal_of(with("../assets")), HasSubstr("is a folder"));
}

TEST(Scene, AChangedMeshIsNoticedByItsHash) {
  const TestFolder folder;
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
  write_mesh(folder / "cube.msh", mesh);
  const Scene scene = load_scene(folder.write("s.toml", "[[body]]\nmesh = \"cube.msh\"\n"));
  write_inputs(scene, folder / "run");
  const fs::path resolved = folder.write("run/scene.toml", scene.resolved);
  EXPECT_EQ(refusal_of(resolved), "");
  write_mesh(folder / "run/inputs/cube.msh", make_box({{0, 0, 0}}, {{1, 1, 1.001}}, {1, 1, 1}));
  EXPECT_THAT(refusal_of(resolved), AllOf(HasSubstr("mesh_hash"), HasSubstr("changed")));
}

TEST(Scene, ABrokenMeshStopsWithTheDoctorsWords) {
  const TestFolder folder;
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
  std::swap(mesh.tets[2][0], mesh.tets[2][1]);
  write_mesh(folder / "cube.msh", mesh);
  const fs::path path = folder.write("s.toml", "[[body]]\nmesh = \"cube.msh\"\n");
  EXPECT_THAT(refusal_of(path), AllOf(HasSubstr("cube"), HasSubstr("inverted")));
}

TEST(Scene, SpringsJoinBodies) {
  Scene scene =
      load("gravity = [0, 0, 0]\n" + kCube +
           "[[body.spring]]\nbetween = [[26, 0]]\nto_body = \"other\"\nstiffness = 10\nrest_length = 0\n" +
           "[[body]]\nname = \"other\"\nshape = { box = { lower = [2, 1, 1], upper = [3, 2, 2], cells = [1, 1, "
           "1] } }\n");
  scene.simulation.step();
  EXPECT_GT(scene.simulation.state().qdot[3 * 26], 0);
  EXPECT_LT(scene.simulation.state().qdot[3 * 27], 0);
  EXPECT_THAT(refusal(kCube + "[[body.spring]]\nbetween = [[0, 99]]\nstiffness = 1\n"), HasSubstr("99"));
  EXPECT_THAT(refusal(kCube + "[[body.spring]]\nbetween = [[1, 1]]\nstiffness = 1\n"), HasSubstr("to itself"));
  EXPECT_THAT(refusal(kCube + "[[body.spring]]\nbetween = [[0, 1]]\nto_body = \"cub\"\nstiffness = 1\n"),
              HasSubstr("did you mean 'cube'?"));
}

TEST(Scene, SpringsToPointsPullTowardsTheirTarget) {
  Scene scene = load("gravity = [0, 0, 0]\n" + kCube +
                     "[[body.spring]]\nwhere = { vertices = [26] }\ntarget = [5, 1, 1]\nstiffness = 10\n");
  scene.simulation.step();
  EXPECT_GT(scene.simulation.state().qdot[3 * 26], 0);
}

TEST(Scene, ABodyWithoutElasticityFallsApart) {
  Scene scene = load("gravity = [0, 0, 0]\n" + kCube + "elastic = false\nvelocity = [\"X\", 0, 0]\n");
  scene.simulation.step();
  EXPECT_NEAR(scene.simulation.state().qdot[3 * 26], 1, 1e-12);
}

TEST(Scene, GeneratedShapesAreBounded) {
  EXPECT_THAT(refusal("[[body]]\nshape = { sphere = { radius = 1, size = 1e-4 } }\n"), HasSubstr("larger size"));
  EXPECT_THAT(refusal("[[body]]\nshape = { box = { upper = [1, 1, 1], cells = [9999, 9999, 9999] } }\n"),
              HasSubstr("tets; at most"));
  EXPECT_THAT(refusal("[[body]]\nshape = { box = { upper = [1, 1, 1], size = 1e-300 } }\n"), HasSubstr("larger size"));
}

TEST(Scene, MissingOrUnreadableFilesAreNamed) {
  const TestFolder folder;
  EXPECT_THAT(refusal_of(folder / "none.toml"), HasSubstr("none.toml"));
  EXPECT_THAT(refusal_of(folder / "none.msh"), HasSubstr("none.msh"));
}

TEST(MeshAlone, GetsDefaultsThatAreStated) {
  const TestFolder folder;
  write_mesh(folder / "tower.msh", make_box({{0, 0, 0}}, {{40, 100, 40}}, {3, 8, 3}));
  Scene scene = load_scene(folder / "tower.msh");
  EXPECT_EQ(scene.name, "tower");
  EXPECT_EQ(scene.steps, 200);
  EXPECT_THAT(scene.notes, Contains(AllOf(HasSubstr("100"), HasSubstr("becomes 1 m"))));
  EXPECT_THAT(scene.notes, Contains(HasSubstr("material.young = 2e+05 Pa")));
  EXPECT_EQ(scene.simulation.model().pins[0].vertices.size(), 16u);
  double reach = 0;
  for (int step = 0; step < 3; ++step) EXPECT_TRUE(is_success(scene.simulation.step().status));
  for (size_t i = 0; i < scene.simulation.state().q.size(); i += 3)
    reach = std::max(reach, scene.simulation.state().qdot[i] * -1);
  EXPECT_GT(reach, 0.1);  // the top swings back, metres per second
}

TEST(MeshAlone, OverridesReplaceDefaultsAndTheirNotes) {
  const TestFolder folder;
  write_mesh(folder / "tower.msh", make_box({{0, 0, 0}}, {{40, 100, 40}}, {1, 2, 1}));
  const Scene scene = load_scene(folder / "tower.msh", {.overrides = {"scale=0.001", "material.young=5e4"}});
  EXPECT_NEAR(scene.simulation.model().mesh.rest.back()[1], 0.1, 1e-15);
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

// A mesher that copies a prepared mesh to where it is told, with "-o".
fs::path fake_mesher(const TestFolder& folder, const fs::path& prepared) {
  const fs::path script = folder.write(
      "mesher", "#!/bin/sh\nwhile [ \"$1\" != -o ]; do shift; done\ncp '" + prepared.string() + "' \"$2\"\n");
  fs::permissions(script, fs::perms::owner_all);
  return script;
}

TEST(MeshAlone, ASurfaceIsFilledOnceAndItsTetsAreKept) {
  const TestFolder folder;
  write_mesh(folder / "tets.mesh", make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}));
  write_mesh(folder / "cube.obj", read_tri_mesh(folder / "tets.mesh"));
  const fs::path mesher = fake_mesher(folder, folder / "tets.mesh");
  Scene scene = load_scene(folder / "cube.obj", {.mesher = mesher});
  EXPECT_THAT(scene.notes, Contains(HasSubstr("a surface; filled with 48 tets")));
  EXPECT_EQ(scene.skins[0].rest.vertex_count(), 26);
  EXPECT_THAT(scene.resolved, AllOf(HasSubstr("inputs/cube.msh"), HasSubstr("inputs/cube.skin.obj")));

  write_inputs(scene, folder / "run");
  Scene again = load_scene(folder.write("run/scene.toml", scene.resolved), {.mesher = "/nowhere/mesher"});
  EXPECT_EQ(scene.resolved, again.resolved);
  scene.simulation.step();
  again.simulation.step();
  EXPECT_EQ(scene.simulation.state().q, again.simulation.state().q);
}

TEST(MeshAlone, AnOpenSurfaceIsRefused) {
  const TestFolder folder;
  folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
  EXPECT_THAT(refusal_of(folder / "open.obj"), AllOf(HasSubstr("open.obj"), HasSubstr("open")));
}

TEST(Scene, ASkinIsPlacedAndCarriedWithItsBody) {
  const TestFolder folder;
  const TetMesh fine = make_box({{0.25, 0.25, 0.25}}, {{0.75, 0.75, 0.75}}, {3, 3, 3});
  write_mesh(folder / "skin.obj", boundary_surface(fine).surface);
  write_mesh(folder / "cage.msh", make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}));
  const Scene scene = load_scene(
      folder.write("s.toml", "[[body]]\nmesh = \"cage.msh\"\nskin = \"skin.obj\"\nscale = 2\ntranslate = [1, 0, 0]\n"));
  const Skin& skin = scene.skins[0];
  EXPECT_EQ(skin.embedding.outside, 0);
  std::vector<double> carried(3 * skin.rest.vertex_count());
  carry(skin.embedding, scene.simulation.state().q, carried);
  for (int v = 0; v < skin.rest.vertex_count(); ++v) {
    EXPECT_LT(distance(vertex(carried, v), skin.rest.vertices[v]), 1e-14);
    EXPECT_GE(skin.rest.vertices[v][0], 1.5);
  }
  folder.write("s.toml", "[[body]]\nmesh = \"cage.msh\"\nmesh_size = 3\n");
  EXPECT_THAT(refusal_of(folder / "s.toml"), HasSubstr("remove mesh_size"));
}

}  // namespace
}  // namespace aspic

// Meshes, skins and numbers from files.
#include "scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/mesh_file.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Scene, DisplacementFileMovesEachVertex) {
  const TestFolder folder;
  std::string csv = "x,y,z\n";
  for (int i = 0; i < 27; ++i) csv += std::to_string(i) + ",0,0.5\n";
  folder.write("u.csv", csv);
  const std::string text = kCube + "scale = 100\ndeform = { file = \"u.csv\" }\n";
  const Scene scene = load_scene(folder.write("beam.toml", text));
  EXPECT_EQ(vertex(positions(scene), 26).a[0], 126);
  EXPECT_THAT(scene.resolved, HasSubstr("inputs/cube.displacement.csv"));
  folder.write("u.csv", "1,2,3\n");
  EXPECT_THAT(refusal_of(folder / "beam.toml"), HasSubstr("1 lines of numbers; one for a vertex is needed, 27 in all"));
  folder.write("u.csv", "1,2,3\n1,2,nan\n");
  EXPECT_THAT(refusal_of(folder / "beam.toml"), AllOf(HasSubstr("u.csv:2:"), HasSubstr("nan")));
}

TEST(Scene, ParametersVaryByTet) {
  const TestFolder folder;
  std::string csv;
  for (int t = 0; t < 48; ++t) csv += std::to_string(1000 + t) + "\n";
  folder.write("rho.csv", csv);
  const Scene scene = load_scene(folder.write(
      "beam.toml", kCube + "material = { density = { file = \"rho.csv\" }, young = \"1e5 * (1 + X)\" }\n"));
  const Model& model = scene.simulation.model();
  EXPECT_EQ(model.density[model.numbering.tet.from_user(47)], 1047);
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
  const Model& model = scene.simulation.model();
  EXPECT_EQ(model.numbering.tet.to_user(model.density), (std::vector<double>{100, 100, 100, 300, 300, 300}));
  EXPECT_THAT(refusal_of(with("{ 1 = 100 }")), AllOf(HasSubstr("region 7 is missing"), HasSubstr("1, 7")));
  EXPECT_THAT(refusal_of(with("{ 1 = 100, 7 = 1, 8 = 2 }")), HasSubstr("no region 8"));
}

TEST(Scene, ExtraParametersBelongToTheirMaterial) {
  EXPECT_THAT(refusal(kCube + "material = { model = \"neo_hookean\", ratio = 1 }\n"), HasSubstr("ratio"));
}

TEST(Scene, FilesAreConfinedToFolderAndParent) {
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

TEST(Scene, ChangedMeshIsDetectedByHash) {
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

TEST(Scene, BrokenMeshIsRejectedWithDiagnosis) {
  const TestFolder folder;
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
  std::swap(mesh.tets[2][0], mesh.tets[2][1]);
  write_mesh(folder / "cube.msh", mesh);
  const fs::path path = folder.write("s.toml", "[[body]]\nmesh = \"cube.msh\"\n");
  EXPECT_THAT(refusal_of(path), AllOf(HasSubstr("cube"), HasSubstr("inverted")));
}

TEST(Scene, LongWorkIsAnnounced) {
  const auto announced = [](const std::string& cells) {
    const TestFolder folder;
    std::vector<std::string> announcements;
    const std::string text =
        "[[body]]\nname = \"box\"\nshape = { box = { upper = [1, 1, 1], cells = " + cells + " } }\n";
    load_scene(folder.write("s.toml", text),
               {.announce = [&](const std::string& what) { announcements.push_back(what); }});
    return announcements;
  };
  EXPECT_THAT(announced("[2, 2, 2]"), testing::IsEmpty());
  EXPECT_THAT(announced("[50, 50, 20]"),
              testing::ElementsAre("checking 300000 tets of body 'box'", HasSubstr("setting up")));
}

TEST(Scene, TetsBeyondLimitAreRejectedBeforeGeneration) {
  const TestFolder folder;
  const auto refused = [&](const std::string& text, bool counts_files) -> std::string {
    const TetLimit limit{.tets = 1000, .why = "fit here", .counts_files = counts_files};
    try {
      load_scene(folder.write("s.toml", text), {.limit = limit});
      return "";
    } catch (const InvalidInput& e) {
      return e.what();
    }
  };
  const auto body = [](const std::string& name, const std::string& what) {
    return "[[body]]\nname = \"" + name + "\"\n" + what + "\n";
  };
  const std::string box = "shape = { box = { upper = [1, 1, 1], cells = [5, 5, 5] } }";  // 750 tets
  EXPECT_EQ(refused(body("a", box), false), "");
  EXPECT_THAT(refused(body("a", box) + body("b", box), false),
              AllOf(HasSubstr("about 1.5e+03 tets"), HasSubstr("at most 1000 fit here"), HasSubstr("fewer cells")));
  write_mesh(folder / "box.msh", make_box({{0, 0, 0}}, {{1, 1, 1}}, {6, 6, 6}));
  EXPECT_EQ(refused(body("a", "mesh = \"box.msh\""), false), "");
  EXPECT_THAT(refused(body("a", "mesh = \"box.msh\""), true), AllOf(HasSubstr("box.msh"), HasSubstr("coarser")));
}

TEST(Scene, TetsBeyondMemoryAreRejectedBeforeGeneration) {
  const TestFolder folder;
  const auto refused = [&](const std::string& shape, const TetLimit& limit = {}) {
    return refusal_of(folder.write("s.toml", "[[body]]\n" + shape + "\n"), {.limit = limit});
  };
  EXPECT_THAT(refused("shape = { box = { upper = [1, 1, 1], cells = [10000, 10000, 10000] } }"),
              AllOf(HasSubstr("s.toml:2:"), HasSubstr("about 6e+12 tets"), HasSubstr("fewer cells")));
  EXPECT_THAT(refused("shape = { cylinder = { radius = 1e-6, height = 1e6, size = 1e-3 } }"),
              HasSubstr("about 1.8e+10 tets"));
  EXPECT_THAT(refused("shape = { torus = { major_radius = 1e6, minor_radius = 1e-6, size = 1e-3 } }"),
              HasSubstr("tets; at most"));
  const std::string box = "shape = { box = { upper = [1, 1, 1], cells = [5, 5, 5] } }";  // 750 tets
  EXPECT_THAT(refused(box, {.memory = 300'000}),
              AllOf(HasSubstr("about 750 tets need at least 0.000375 GB; 0.0003 GB of memory are free"),
                    HasSubstr("fewer cells")));
  EXPECT_EQ(refused(box, {.memory = 400'000}), "");
  const std::string quadratic = box + "\norder = 2";
  EXPECT_THAT(refused(quadratic, {.memory = 2'000'000}),
              HasSubstr("order = 2: about 750 tets need at least 0.00225 GB"));
  EXPECT_EQ(refused(quadratic, {.memory = 2'300'000}), "");
  write_mesh(folder / "box.msh", make_box({{0, 0, 0}}, {{1, 1, 1}}, {5, 5, 5}));
  EXPECT_THAT(refused("mesh = \"box.msh\"", {.memory = 300'000}), AllOf(HasSubstr("box.msh"), HasSubstr("coarser")));
}

TEST(Scene, TooManyStepsAreRejected) {
  const TestFolder folder;
  const auto refused = [&](const std::string& time) {
    return refusal_of(folder.write("s.toml", "[time]\n" + time + "\n" + kCube));
  };
  EXPECT_THAT(refused("duration = 1e9\nstep = 1e-9"), HasSubstr("needs 1e+18 steps"));
  EXPECT_THAT(refused("duration = 1e400"), HasSubstr("s.toml:2:"));
  EXPECT_THAT(refused("step = nan"), HasSubstr("s.toml:2:"));
  EXPECT_THAT(refused("duration = inf"), HasSubstr("s.toml:2:"));
}

TEST(Scene, LinksToOutsideAreRejected) {
  const TestFolder folder;
  fs::create_directories(folder / "a/b/scenes");
  write_mesh(folder / "cube.msh", make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}));
  write_mesh(folder / "a/b/inside.msh", make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}));
  fs::create_symlink(folder / "cube.msh", folder / "a/b/scenes/cube.msh");
  fs::create_symlink("../inside.msh", folder / "a/b/scenes/inside.msh");
  fs::create_directory_symlink(folder / ".", folder / "a/b/scenes/meshes");
  const auto with = [&](const std::string& name) {
    return folder.write("a/b/scenes/s.toml", "[[body]]\nmesh = \"" + name + "\"\n");
  };
  EXPECT_THAT(refusal_of(with("cube.msh")), AllOf(HasSubstr("s.toml:2:8"), HasSubstr("is a link to outside")));
  EXPECT_THAT(refusal_of(with("meshes/cube.msh")), HasSubstr("is a link to outside"));
  EXPECT_EQ(refusal_of(with("inside.msh")), "");
  EXPECT_EQ(refusal_of(with("cube.msh"), {.allow_outside = true}), "");
  EXPECT_EQ(refusal_of(with("x.msh"), {.overrides = {"mesh=" + (folder / "a/b/scenes/cube.msh").string()}}), "");
}

TEST(Scene, MissingOrUnreadableFilesAreNamed) {
  const TestFolder folder;
  EXPECT_THAT(refusal_of(folder / "none.toml"), HasSubstr("none.toml"));
  EXPECT_THAT(refusal_of(folder / "none.msh"), HasSubstr("none.msh"));
}

TEST(Scene, SkinIsPlacedAndCarriedWithBody) {
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

TEST(Scene, SkinInOtherUnitsIsRefusedWithDistance) {
  const TestFolder folder;
  write_mesh(folder / "cage.msh", make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}));
  folder.write("s.toml", "[[body]]\nmesh = \"cage.msh\"\nskin = \"skin.obj\"\n");
  const auto refusal_at = [&](double scale) {
    write_mesh(folder / "skin.obj",
               boundary_surface(make_box({{0, 0, 0}}, {{scale, scale, scale}}, {1, 1, 1})).surface);
    return refusal_of(folder / "s.toml");
  };
  EXPECT_THAT(refusal_at(1e-3), AllOf(HasSubstr("s.toml:3:"), HasSubstr("the tets reach 1.73 m beyond the skin, whose "
                                                                        "diagonal is 0.00173 m")));
  EXPECT_THAT(refusal_at(1e3), HasSubstr("the skin reaches 1.73e+03 m beyond the tets"));
  EXPECT_EQ(refusal_at(0.2), "") << "a detail of the body";
}

}  // namespace
}  // namespace aspic

// Cavities of a scene: states, columns, mistakes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/mesh_file.h"
#include "mesh/box.h"
#include "mesh/generators.h"
#include "results/run_directory.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

// A cube of 3 x 3 x 3 cells without the middle ones of `hollow` cells along x.
TetMesh hollow_cube(double begin, double end) {
  const TetMesh full = make_box({{0, 0, 0}}, {{3, 3, 3}}, {3, 3, 3});
  TetMesh mesh{full.rest, {}, {}};
  for (const Tet& tet : full.tets) {
    Vec3d c{};
    for (const int v : tet) c = c + 0.25 * full.rest[v];
    const bool is_middle = c[1] > 1 && c[1] < 2 && c[2] > 1 && c[2] < 2;
    if (!(is_middle && c[0] > begin && c[0] < end)) mesh.tets.push_back(tet);
  }
  return mesh;
}

class SceneCavities : public testing::Test {
 protected:
  // The scene of a hollow cube; in `open` the hollow reaches the face x = 3.
  std::string scene(const std::string& cavity, bool open = false) {
    write_mesh(folder_.path() / "hollow.mesh", hollow_cube(1, open ? 3 : 2));
    return folder_
        .write("hollow.toml",
               "gravity = [0, 0, 0]\n[time]\nstep = 1\nintegrator = \"quasi_static\"\n[[body]]\nname = "
               "\"cube\"\nmesh = \"hollow.mesh\"\nmaterial = { young = 1e4 }\n[[body.pin]]\nwhere = \"x < "
               "0.1\"\n[[body.cavity]]\n" +
                   cavity)
        .string();
  }
  std::string refusal_of_cavity(const std::string& cavity, bool open = false) {
    return refusal_of(scene(cavity, open));
  }

  TestFolder folder_;
};

TEST_F(SceneCavities, FindTheInnerSurface) {
  for (const char* where : {"", "where = \"max(abs(x - 1.5), max(abs(y - 1.5), abs(z - 1.5))) < 0.6\"\n"}) {
    Scene gas = load_scene(scene(std::string(where) + "gas = \"1 + t\"\npressure = 3000\n"), {});
    EXPECT_THAT(gas.notes, Contains(HasSubstr("cavity of body 'cube': 1e+06 ml at the start, with 0 Pa"))) << where;
    const StepReport report = gas.simulation.step();
    EXPECT_TRUE(is_success(report.status));
    ASSERT_EQ(report.cavities.size(), 1u);
    const auto [volume, pressure] = report.cavities[0];
    EXPECT_NEAR((3000 + pressure) * volume, 6000, 1e-6);
    Scene liquid = load_scene(scene(std::string(where) + "liquid = 1.2\n"), {});
    EXPECT_TRUE(is_success(liquid.simulation.step().status));
    EXPECT_NEAR(liquid.simulation.start_report().cavities[0].volume, 1.2, 1e-3);
  }
}

TEST_F(SceneCavities, AreColumnsOfResults) {
  Scene loaded = load_scene(scene("liquid = \"1 + 0.1*t\"\n"), {});
  RunDirectory run = RunDirectory::create(folder_.path() / "run", loaded, ExistingRun::refuse);
  run.on_step(loaded.simulation.step(), loaded.simulation);
  run.finish(loaded.simulation);
  const std::string table = read_file((folder_.path() / "run/steps.csv").string());
  EXPECT_THAT(table, HasSubstr(",volume_cavity,pressure_cavity,"));
}

TEST(SceneCavity, NeedsAnInnerSurface) {
  EXPECT_THAT(refusal(kCube + "[[body.cavity]]\ngas = 1\n"),
              AllOf(HasSubstr("beam.toml:4:"), HasSubstr("0 inner surfaces")));
}

TEST_F(SceneCavities, MistakesAreNamed) {
  EXPECT_THAT(refusal_of_cavity("gas = 1\n", true), HasSubstr("no opening connects"));
  EXPECT_THAT(refusal_of_cavity("gas = 1\nwhere = \"all\"\n"), HasSubstr("enclose the body"));
  EXPECT_THAT(refusal_of_cavity("gas = 1\nwhere = \"x > 1.5 && max(abs(y - 1.5), abs(z - 1.5)) < 0.6\"\n"),
              AllOf(HasSubstr("open"), HasSubstr("rim")));
  EXPECT_THAT(refusal_of_cavity("gas = 1\nliquid = 1\n"), AllOf(HasSubstr("gas"), HasSubstr("liquid")));
  EXPECT_THAT(refusal_of_cavity("gas = \"X\"\n"), HasSubstr("may use only t"));
  EXPECT_THAT(refusal_of_cavity("gas = \"-1\"\n"), HasSubstr("negative"));
  Scene emptied = load_scene(scene("liquid = \"1 - 2*t\"\n"), {});
  EXPECT_THROW(emptied.simulation.step(), InvalidInput);
  EXPECT_THAT(refusal_of_cavity("liquid = 1\nbulk_modulus = 0\n"), HasSubstr("bulk_modulus"));
}

const std::string kBalloon =
    "gravity = [0, 0, 0]\n[time]\nstep = 0.1\n[[body]]\nname = \"skin\"\nshape = { sphere = { radius = 0.1, size = "
    "0.05 } "
    "}\nshell = { thickness = 1e-3 }\nmaterial = { young = 1e6, density = 1000 }\n[[body.cavity]]\n";

TEST(SheetCavity, GasDoesTheWorkOfALedger) {
  Scene scene = load(kBalloon + "gas = \"1 + t\"\n", {"contact.friction=0"});
  const double start = scene.simulation.start_report().cavities[0].volume;
  EXPECT_NEAR(start, 4 * std::numbers::pi / 3 * 1e-3, 0.2 * start);
  for (int i = 1; i <= 5; ++i) {
    const StepReport report = scene.simulation.step();
    ASSERT_TRUE(is_success(report.status));
    const auto [volume, pressure] = report.cavities[0];
    EXPECT_NEAR((101325 + pressure) * volume, 101325 * (1 + 0.1 * i) * start, 1e-9 * 101325 * start);
    EXPECT_LT(std::abs(report.ledger_error), 1e-10 * 101325 * start);
  }
}

TEST(SheetCavity, LiquidFillsTheGivenVolume) {
  Scene scene = load(kBalloon + "liquid = 1\nvolume = 6e-3\n");
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(is_success(scene.simulation.step().status));
  EXPECT_NEAR(scene.simulation.start_report().cavities[0].volume, 6e-3, 1e-4);
}

// A flat pillow of two discs with a common border, whose triangles do not agree on a side.
std::string pillow(int around) {
  std::string obj;
  const auto vertex = [&](double r, int i, double z) {
    const double angle = 2 * std::numbers::pi * i / around;
    obj +=
        "v " + number_text(r * std::cos(angle)) + " " + number_text(r * std::sin(angle)) + " " + number_text(z) + "\n";
  };
  for (int i = 0; i < around; ++i) vertex(0.2, i, 0);
  for (const double z : {1e-3, -1e-3}) {
    for (int i = 0; i < around; ++i) vertex(0.1, i, z);
    vertex(0, 0, z);
  }
  const auto face = [&](int a, int b, int c) {
    obj += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) + "\n";
  };
  for (const int first : {around, 2 * around + 1})
    for (int i = 0; i < around; ++i) {
      const int j = (i + 1) % around;
      face(i, j, first + i), face(first + i, j, first + j), face(first + j, first + i, first + around);
    }
  return obj;
}

TEST(SheetCavity, AirbagInflatesBetweenPlanes) {
  const TestFolder folder;
  folder.write("pillow.obj", pillow(12));
  Scene scene = load_scene(
      folder.write("airbag.toml",
                   "gravity = [0, 0, -9.81]\n[time]\nstep = 0.01\n[contact]\nfriction = 0.3\n[[obstacle]]\nname = "
                   "\"floor\"\nplane = { normal = [0, 0, 1], origin = [0, 0, -0.02] }\n[[obstacle]]\nname = "
                   "\"dash\"\nplane = { normal = [0, 0, -1], origin = [0, 0, 0.04] }\n[[body]]\nname = \"bag\"\nmesh = "
                   "\"pillow.obj\"\nshell = { thickness = 3e-4, moment = 1e-5 }\nmaterial = { young = 1e7, density = "
                   "800 }\n[[body.cavity]]\ngas = \"0.02 + 10 * t\"\nvolume = 6e-3\n"),
      {});
  const double flat = scene.simulation.start_report().cavities[0].volume;
  EXPECT_LT(flat, 2e-4);
  StepReport report;
  for (int i = 0; i < 10; ++i) {
    report = scene.simulation.step();
    ASSERT_TRUE(is_success(report.status)) << i << to_string(report.status);
    EXPECT_TRUE(report.contacts == 0 || report.min_gap > 0);
  }
  const auto [volume, pressure] = report.cavities[0];
  EXPECT_GT(volume, 10 * flat);
  EXPECT_NEAR((101325 + pressure) * volume, 101325 * 1.02 * 6e-3, 1e-3);
  EXPECT_GT(pressure, 1000);  // the planes leave no room for 6 l
}

TEST(SheetCavity, RefusesOpenAndBranchedSheets) {
  const TestFolder folder;
  const auto refused = [&](const std::string& obj, const std::string& more = "") {
    folder.write("sheet.obj", obj);
    return refusal_of(folder.write("bag.toml",
                                   "[[body]]\nname = \"bag\"\nmesh = \"sheet.obj\"\nshell = { thickness = "
                                   "1e-3 }\n[[body.cavity]]\ngas = 1\n" +
                                       more));
  };
  const std::string tet = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\n";
  EXPECT_THAT(refused(tet), AllOf(HasSubstr("bag.toml:5:"), HasSubstr("body 'bag' is open at its edge from vertex 0 at "
                                                                      "(0, 0, 0) to vertex 2 at (0, 1, 0)")));
  const std::string closed = tet + "f 3 1 4\n";
  EXPECT_EQ(refused(closed), "");
  EXPECT_THAT(refused(closed, "volume = 0\n"), HasSubstr("volume = 0; must be > 0"));
  EXPECT_THAT(refused(closed + "v 1 1 1\nf 1 2 5\n"), HasSubstr("is branched at its edge from vertex 0"));
  EXPECT_THAT(refused(closed + "v 5 0 0\nv 6 0 0\nv 5 1 0\nv 5 0 1\nf 5 6 7\nf 5 6 8\nf 6 7 8\nf 7 5 8\n"),
              HasSubstr("has 2 closed surfaces; select the faces of one by where"));
}

}  // namespace
}  // namespace aspic

// Cavities of a scene: states, columns, mistakes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

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
    EXPECT_THAT(gas.notes, Contains(HasSubstr("cavity of body 'cube': 1e+06 ml at the start"))) << where;
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

}  // namespace
}  // namespace aspic

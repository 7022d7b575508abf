// Contact and obstacles of scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "contact/barrier.h"
#include "dynamics/step_derivatives.h"
#include "io/atomic_file.h"
#include "io/folder_test.h"
#include "io/mesh_file.h"
#include "io/vtu.h"
#include "results/run_directory.h"
#include "scene/scene.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kFloor = "\n[[obstacle]]\nplane = { origin = [0, -0.5, 0] }\n";

TEST(SceneContact, ObstacleSwitchesContactOn) {
  const TestFolder folder;
  const Scene scene = load_scene(folder.write("scene.toml", kCube + kFloor));
  const Barrier* contact = scene.simulation.model().contact;
  ASSERT_NE(contact, nullptr);
  ASSERT_EQ(contact->mesh().parts.size(), 2U);
  EXPECT_EQ(contact->mesh().parts[1].name, "obstacle1");
  EXPECT_THAT(scene.resolved, AllOf(HasSubstr("friction = 0.0"), HasSubstr("name = \"obstacle1\"")));
  EXPECT_EQ(load_scene(folder.write("free.toml", kCube)).simulation.model().contact, nullptr);
}

TEST(SceneContact, ResolvedSceneIsTheSame) {
  const TestFolder folder;
  const Scene scene = load_scene(folder.write("scene.toml", kCube + kFloor));
  write_inputs(scene, folder / "run");
  const Scene again = load_scene(folder.write("run/resolved.toml", scene.resolved));
  EXPECT_EQ(again.resolved, scene.resolved);
}

// Pins that an obstacle blocks end the run; they never jump to its other side.
TEST(SceneContact, PinsDoNotPassThroughObstacles) {
  const TestFolder folder;
  const std::string pins = "[[body.pin]]\nwhere = \"all\"\nmotion = { displacement = [0, \"-1000 * t\", 0] }\n";
  const std::string slab =
      "[[obstacle]]\nshape = { box = { lower = [-9, -1, -9], upper = [9, -0.9, 9], cells = [1, 1, 1] } }\n";
  Scene scene = load_scene(folder.write("scene.toml", kCube + pins + slab));
  bool has_failed = false;
  for (int i = 0; i < 3 && !has_failed; ++i) has_failed = !is_success(scene.simulation.step().status);
  EXPECT_TRUE(has_failed);
  for (size_t k = 1; k < scene.simulation.state().q.size(); k += 3) EXPECT_GT(scene.simulation.state().q[k], -0.9);
}

TEST(SceneContact, ObstacleMovesByFormula) {
  const TestFolder folder;
  const Scene scene =
      load_scene(folder.write("scene.toml", kCube + kFloor + "motion = { displacement = [0, \"-t\", 0] }\n"));
  const Barrier& contact = *scene.simulation.model().contact;
  EXPECT_TRUE(contact.has_moving_obstacle());
  EXPECT_DOUBLE_EQ(contact.points(scene.simulation.state().q, 2).back()[1], -2.5);
}

TEST(SceneContact, PairsHaveTheirFriction) {
  const std::string two = kCube + "[[body]]\nname = \"ball\"\nshape = { sphere = { radius = 0.5, size = 0.4 } }\n" +
                          "translate = [0, 3, 0]\n" + kFloor;
  const Scene scene = load(two +
                           "[contact]\nfriction = 0.4\n[[contact.pair]]\nbetween = [\"obstacle1\", \"ball\"]\n"
                           "friction = 0.1\n[[contact.pair]]\nbetween = [\"cube\", \"cube\"]\nfriction = 0\n");
  const ContactLaws& laws = scene.simulation.model().contact->laws();
  EXPECT_EQ(laws(0, 0).friction, 0);
  EXPECT_EQ(laws(0, 2).friction, 0.4);
  EXPECT_EQ(laws(1, 2).friction, 0.1);
  EXPECT_EQ(laws(2, 1).friction, 0.1);
  const auto pair = [](const std::string& names) {
    return "[[contact.pair]]\nbetween = " + names + "\nfriction = 0.1\n";
  };
  EXPECT_THAT(refusal(two + pair("[\"cube\"]")), HasSubstr("between needs two names"));
  EXPECT_THAT(refusal(two + pair("[\"cube\", \"bal\"]")), HasSubstr("'bal' (did you mean 'ball'?)"));
  EXPECT_THAT(refusal(two + pair("[\"obstacle1\", \"obstacle1\"]")), HasSubstr("name a body"));
  EXPECT_THAT(refusal(two + pair("[\"cube\", \"ball\"]") + pair("[\"ball\", \"cube\"]")), HasSubstr("earlier pair"));
}

// The order of the differences is a number only where a term is not constant.
TEST(SceneContact, DerivativesAreCheckedWhereBodiesTouch) {
  const Scene scene = load(kCube + kFloor + "[contact]\nfriction = 0.4\n");
  int checked = 0;
  for (const TermDerivatives& t : check_step_derivatives(scene.simulation)) {
    if (t.state != "touching" || (t.term != "contact" && t.term != "friction")) continue;
    ++checked;
    EXPECT_TRUE(t.report.gradient.passed && t.report.hessian.passed) << t.term;
    EXPECT_GT(t.report.gradient.order, 1) << t.term;
    EXPECT_GT(t.report.hessian.order, 1) << t.term;
  }
  EXPECT_EQ(checked, 2);
}

// At the start of a step nothing slips, where the second derivatives of friction have a kink.
TEST(SceneContact, DerivativesAreCheckedFromAStartInTouch) {
  const Scene scene =
      load(kCube + "[[obstacle]]\nplane = { origin = [0, -5e-4, 0] }\n[contact]\nfriction = 0.3\nreach = 0.01\n");
  int checked = 0;
  for (const TermDerivatives& t : check_step_derivatives(scene.simulation)) {
    EXPECT_TRUE(t.report.gradient.passed && t.report.hessian.passed) << t.term << ' ' << t.state;
    checked += t.state == "start" && t.term == "friction" && t.report.gradient.order > 1;
  }
  EXPECT_EQ(checked, 1);
}

TEST(SceneContact, DerivativesAreNotCheckedBehindAnObstacle) {
  const Scene scene = load(kCube + "[[obstacle]]\nname = \"floor\"\nplane = { origin = [0, -0.1, 0] }\n" +
                           "motion = { linear = { velocity = [0, 100, 0] } }\n[contact]\n");
  int unchecked = 0;
  for (const TermDerivatives& t : check_step_derivatives(scene.simulation)) {
    EXPECT_FALSE(t.is_wrong()) << t.term << ' ' << t.state;
    if (t.unchecked.empty()) continue;
    EXPECT_THAT(t.unchecked, testing::MatchesRegex("cube and floor overlap at \\(.*\\) m, t = .* s"));
    ++unchecked;
  }
  EXPECT_EQ(unchecked, 2);  // contact and E
}

TEST(SceneContact, RejectsBadInput) {
  EXPECT_THAT(refusal(kCube + kFloor + "motion = { rotate = { axis = [0, 1, 0], rate_deg = 9 } }\n"),
              HasSubstr("capsules do not rotate"));
  EXPECT_THAT(refusal(kCube + kFloor + "motion = { displacement = [0, \"0/t\", 0] }\n"), HasSubstr("is nan"));
  EXPECT_THAT(refusal(kCube + "\n[[obstacle]]\nplane = { normal = [0, 0, 0] }\n"), HasSubstr("normal has length 0"));
  EXPECT_THAT(refusal(kCube + "\n[[obstacle]]\nmesh = \"none.obj\"\n"), HasSubstr("none.obj"));
  EXPECT_THAT(refusal(kCube + "\n[[obstacle]]\nplane = { origin = [0, 0.5, 0] }\n"),
              HasSubstr("starts behind the plane"));
  EXPECT_THAT(refusal(kCube + "\n[contact]\nreach = 100\n"), HasSubstr("contact must begin closer"));
  EXPECT_THAT(refusal(kCube + "\n[contact]\nfriction = -1\n"), HasSubstr("must be >= 0"));
}

// The files of a run that a cube on the floor takes one step of.
class ObstacleFiles : public FolderTest {
 protected:
  ObstacleFiles() {
    const std::string floor =
        "\n[[obstacle]]\nname = \"floor\"\nplane = { origin = [0, -1e-3, 0] }\n[contact]\nreach = 0.01\n";
    const std::string slab =
        "[[obstacle]]\nname = \"slab\"\nshape = { box = { lower = [2, 0, 0], upper = [3, 1, 1], cells = [1, 1, 1] } "
        "}\n";
    const std::string output = "[output]\nobj = true\nusd = true\n";
    write_file(path("scene.toml"), kCube + floor + slab + output);
    Scene scene = load_scene(path("scene.toml"));
    RunDirectory run = RunDirectory::create(path("run"), scene, ExistingRun::refuse);
    run.on_step(scene.simulation.step(), scene.simulation);
    run.finish(scene.simulation);
  }
};

TEST_F(ObstacleFiles, FramesHavePressureAndGap) {
  const Vtu frame = read_vtu(path("run/frames/body_000001.vtu"));
  const auto& fields = frame.point_fields;
  ASSERT_EQ(fields.size(), 4U);
  EXPECT_EQ(fields[2].name, "contact_pressure");
  EXPECT_EQ(fields[3].name, "contact_gap");
  int touching = 0;
  for (size_t v = 0; v < frame.mesh.rest.size(); ++v) {
    const bool is_base = frame.mesh.rest[v][1] < 0.1;
    EXPECT_EQ(fields[2].values[v] > 0, is_base);
    EXPECT_EQ(std::isfinite(fields[3].values[v]), is_base);
    if (is_base) {
      EXPECT_NEAR(fields[3].values[v], frame.mesh.rest[v][1] + 1e-3, 1e-8);
    }
    touching += is_base;
  }
  EXPECT_EQ(touching, 9);
}

TEST_F(ObstacleFiles, AreWrittenOnceForAllFrames) {
  const Vtu all = read_vtu(path("run/obstacles/obstacles.vtu"));
  EXPECT_EQ(all.triangles.vertex_count(), 4 + 8);
  EXPECT_EQ(all.triangles.triangle_count(), 2 + 12);
  EXPECT_EQ(all.cell_fields.at(0).values.back(), 1);
  EXPECT_THAT(
      read_file(path("run/run.pvd")),
      HasSubstr("part=\"0\" file=\"frames/body_000001.vtu\"/>\n<DataSet timestep=\"0.01\" group=\"\" part=\"1\" "
                "file=\"obstacles/obstacles.vtu\"/>"));
  EXPECT_EQ(read_tri_mesh(path("run/obstacles/obstacle_slab.obj")).triangle_count(), 12);
  EXPECT_THAT(read_file(path("run/run.usda")), HasSubstr("def Mesh \"floor\""));
}

TEST_F(ObstacleFiles, OverwritingRemovesThem) {
  write_file(path("free.toml"), kCube);
  RunDirectory::create(path("run"), load_scene(path("free.toml")), ExistingRun::overwrite);
  EXPECT_FALSE(std::filesystem::exists(path("run/obstacles")));
}

}  // namespace
}  // namespace aspic

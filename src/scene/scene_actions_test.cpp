// Pins along directions, time-dependent loads, and remedies in keys of the scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "base/error.h"
#include "mesh/surface.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::string pin(const std::string& rest) { return "[[body.pin]]\n" + rest + "\n"; }

TEST(ScenePins, HoldAxesOrADirection) {
  const Scene scene =
      load(kCube + pin("where = \"x < 0.1\"\naxes = \"x\"") + pin("where = \"y < 0.1\"\naxes = \"yz\"") +
           pin("where = \"x > 0.9 && y > 0.9\"\ndirection = [3, 4, 0]"));
  const std::vector<Pin>& pins = scene.simulation.model().pins;
  ASSERT_EQ(pins.size(), 3u);
  ASSERT_EQ(pins[0].directions.size(), 1u);
  EXPECT_EQ(pins[0].directions[0][0], 1);
  EXPECT_EQ(pins[1].directions.size(), 2u);
  EXPECT_NEAR(pins[2].directions[0][1], 0.8, 1e-15);
  EXPECT_TRUE(load(kCube + pin("where = \"x < 0.1\"")).simulation.model().pins[0].directions.empty());
}

TEST(ScenePins, RollersLetTheBodySlide) {
  Scene scene = load("gravity = [1, -9.81, 0]\n" + kCube + pin("where = \"y < 0.1\"\naxes = \"y\""));
  for (int i = 0; i < 5; ++i) scene.simulation.step();
  const double h = 0.01, slid = h * h * (1 + 2 + 3 + 4 + 5);  // backward Euler
  const Model& model = scene.simulation.model();
  double center = 0;  // of mass
  for (int v = 0; v < 27; ++v) {
    const std::vector<double>& q = scene.simulation.state().q;
    if (model.mesh.rest[v][1] == 0) {
      EXPECT_EQ(q[3 * v + 1], 0);
    }
    center += q[3 * v] * model.mass->vertex_mass()[v] / model.mass->total();
  }
  EXPECT_NEAR(center, 0.5 + slid, 1e-4 * slid);
}

TEST(ScenePins, SharedVerticesMustAgree) {
  const std::string plane = pin("name = \"plane\"\nwhere = \"y < 0.1\"\naxes = \"y\"");
  const auto grip = [](const std::string& motion, const std::string& where = "x < 0.1") {
    return pin("name = \"grip\"\nwhere = \"" + where + "\"\nmotion = { displacement = " + motion + " }");
  };
  const std::string agreeing = "[\"0.1*t\", \"0.3*t*Y\", \"0.2*t\"]";
  const std::string still = "gravity = [0, 0, -10]\n";
  Scene shared = load(still + kCube + plane + grip(agreeing)), reversed = load(still + kCube + grip(agreeing) + plane);
  Scene apart = load(still + kCube + grip(agreeing) + pin("where = \"y < 0.1 && !(x < 0.1)\"\naxes = \"y\""));
  for (Scene* scene : {&shared, &reversed, &apart})
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(is_success(scene->simulation.step().status));
  for (size_t i = 0; i < positions(apart).size(); ++i) {
    EXPECT_NEAR(positions(shared)[i], positions(apart)[i], 1e-9);
    EXPECT_NEAR(positions(reversed)[i], positions(apart)[i], 1e-9);
  }
  for (const char* motion : {"[0, \"0.1*t\", 0]", "[0, \"1e-6*t^2\", \"t\"]"})
    EXPECT_THAT(refusal(kCube + plane + grip(motion)),
                AllOf(HasSubstr("'plane'"), HasSubstr("'grip'"), HasSubstr("different positions"), HasSubstr("&& !(")))
        << motion;
  EXPECT_EQ(refusal(kCube + plane + grip("[0, 0, \"t\"]", "z > 0.9")), "");
  EXPECT_THAT(refusal(kCube + pin("where = \"all\"\ndirection = [0, 0, 0]")), HasSubstr("a direction is needed"));
  EXPECT_THAT(refusal(kCube + pin("where = \"all\"\naxes = \"yx\"")), HasSubstr("axes"));
  EXPECT_THAT(refusal(kCube + pin("where = \"all\"\naxes = \"y\"\ndirection = [0, 0, 1]")), HasSubstr("direction"));
}

// Under pressure on all sides the Cauchy stress is -p I on the deformed areas, which are smaller than those of a dead
// load.
TEST(SceneLoads, PressureFollowsSurfaceDeadPressureDoesNot) {
  const auto stress_under = [](const std::string& load_text) {
    Scene scene =
        load("gravity = [0, 0, 0]\n[time]\nstep = 1\nintegrator = \"quasi_static\"\n[solver]\ntolerance = 1e-10\n" +
             kCube + "material = { young = 1e4, poisson = 0.2 }\n" + pin("where = { vertices = [0] }") + load_text);
    const StepReport report = scene.simulation.step();
    EXPECT_TRUE(is_success(report.status));
    EXPECT_LT(std::abs(report.ledger_error), 1e-9 * std::abs(report.potential_total));
    return scene.simulation.tet_fields().cauchy[0];
  };
  EXPECT_NEAR(stress_under("[[body.pressure]]\nwhere = \"all\"\nvalue = \"-1000 * t\"\n"), 1000, 1e-4);
  EXPECT_LT(stress_under("[[body.traction]]\nwhere = \"all\"\ndead_pressure = -1000\n"), 970);
  EXPECT_THAT(refusal(kCube + "[[body.pressure]]\nwhere = \"all\"\nvalue = \"100 * X\"\n"),
              AllOf(HasSubstr("beam.toml:6:"), HasSubstr("dead_pressure")));
}

TEST(SceneLoads, FollowTimeAndBalanceEnergy) {
  const std::string text =
      "gravity = [0, 0, 0]\n[time]\nstep = 0.5\nintegrator = \"quasi_static\"\n" + kCube + pin("where = \"x < 0.1\"");
  const auto pulled = [&](const std::string& load_text, int steps) {
    Scene scene = load(text + load_text);
    StepReport report;
    for (int i = 0; i < steps; ++i) report = scene.simulation.step();
    EXPECT_TRUE(is_success(report.status));
    EXPECT_LT(std::abs(report.ledger_error), 1e-9 * std::abs(report.potential_total));
    EXPECT_GT(std::abs(report.pin_work), 0) << "the load worked when it grew";
    EXPECT_NEAR(report.resultants.pins[0].force[0], -report.resultants.loads[0].force[0], 1e-3);
    return report.resultants.loads[0].force[0];
  };
  const std::string face = "[[body.traction]]\nwhere = \"x > 0.999\"\n";
  EXPECT_NEAR(pulled(face + "value = [\"100 * t\", 0, 0]\n", 2), 100, 1e-9);
  EXPECT_NEAR(pulled(face + "dead_pressure = \"-100 * t * (1 + 0 * Y)\"\n", 1), 50, 1e-9);
  EXPECT_NEAR(pulled("[[body.force]]\nvalue = [\"10 * min(t, 0.6)\", 0, 0]\n", 2), 6, 1e-9);
}

// The torque of (-Z, Y) on a square is its polar moment, 1/6 m^4.
TEST(SceneLoads, LinearFormulasAreIntegratedExactly) {
  for (const std::string order : {"1", "2"}) {
    const auto load_of = [&](const std::string& load_text) {
      Scene scene =
          load("gravity = [0, 0, 0]\n[time]\nstep = 1\nintegrator = \"quasi_static\"\n" + kCube + "order = " + order +
               "\nmaterial = { young = 1e6, poisson = 0.3 }\n" + pin("where = \"x < 0.001\"") + load_text);
      return scene.simulation.step().resultants.loads[0];
    };
    const Resultant twist =
        load_of("[[body.traction]]\nwhere = \"x > 0.999\"\nvalue = [0, \"0.5 - Z\", \"Y - 0.5\"]\n");
    EXPECT_NEAR(twist.force[1], 0, 1e-14);
    EXPECT_NEAR(twist.moment[0], 1.0 / 6, 1e-6);  // about the deformed positions
    const Resultant press = load_of("[[body.traction]]\nwhere = \"z > 0.999\"\ndead_pressure = \"X * Y\"\n");
    EXPECT_NEAR(press.force[2], -1.0 / 4, 1e-13);
    EXPECT_NEAR(press.moment[1], 1.0 / 6, 1e-5);
    const Resultant pull = load_of("[[body.force]]\nvalue = [\"Z\", 0, \"X * X\"]\n");
    EXPECT_NEAR(pull.force[0], 1.0 / 2, 1e-13);
    EXPECT_NEAR(pull.force[2], 1.0 / 3, 1e-13);
    EXPECT_NEAR(pull.moment[1], 1.0 / 3 - 1.0 / 4, 1e-5);
  }
}

// In a bent bar, the load on a patch is p times its deformed area vector, and a note states that it has no potential.
TEST(SceneLoads, PressureOnOpenPatchHasNoForcesAtItsRim) {
  Scene scene = load(
      "gravity = [0, 0, 0]\n[time]\nstep = 1\nintegrator = \"quasi_static\"\n[[body]]\nname = \"bar\"\nshape = { box = "
      "{ upper = [4, 1, 1], cells = [8, 2, 2] } }\nmaterial = { young = 1e5, poisson = 0.3 }\n" +
      pin("where = \"x < 0.001\"") + "[[body.pressure]]\nwhere = \"z > 0.999 && x > 0.999\"\nvalue = 400\n");
  EXPECT_THAT(scene.notes, Contains(HasSubstr("open patch")));
  const StepReport report = scene.simulation.step();
  ASSERT_TRUE(is_success(report.status));
  Vec3d area{};
  const Model& model = scene.simulation.model();
  for (const Face& face : boundary_faces(model.mesh, 0, model.mesh.tet_count())) {
    const auto& [a, b, c] = face.corners;
    const auto is_pressed = [&](int v) { return model.mesh.rest[v][2] > 0.999 && model.mesh.rest[v][0] > 0.999; };
    if (!is_pressed(a) || !is_pressed(b) || !is_pressed(c)) continue;
    const Vec3d x = vertex(scene.simulation.state().q, a);
    area = area + 0.5 * cross(vertex(scene.simulation.state().q, b) - x, vertex(scene.simulation.state().q, c) - x);
  }
  EXPECT_LT(distance(report.resultants.loads[0].force, -400.0 * area), 1e-9 * 1200);
  EXPECT_LT(distance(report.resultants.pins[0].force, 400.0 * area), 1e-3 * 1200);
  EXPECT_GT(std::abs(area[0]), 0.1) << "the patch has turned";
}

TEST(SceneLoads, OfSeveralKindsAddUp) {
  Scene scene = load("gravity = [0, 0, 0]\n" + kCube + "[[body.force]]\nvalue = [1, 0, 0]\n" +
                     "[[body.force]]\nvalue = [\"sin(t)\", 0, 0]\n");
  const StepReport report = scene.simulation.step();
  EXPECT_NEAR(report.resultants.loads.at(0).force[0], 1 + std::sin(0.01), 1e-12);
}

TEST(SceneLoads, FailingDuringRunNameTheirPlace) {
  Scene scene = load(kCube + "[[body.force]]\nvalue = [\"t < 0.015 ? 0 : 1/0\", 0, 0]\n");
  scene.simulation.step();
  EXPECT_THAT(message_of<InvalidInput>([&] { scene.simulation.step(); }),
              AllOf(HasSubstr("beam.toml:5:"), HasSubstr("t = 0.02")));
  EXPECT_THAT(refusal(kCube + "[[body.force]]\nvalue = [\"1 / t\", 0, 0]\n"), HasSubstr("t = 0"));
}

// "set A = 1 and set B = 2" as assignments.
std::vector<std::string> assignments(const std::string& note) {
  std::vector<std::string> all;
  const std::regex pattern("set ([a-z._]+) = ([-+0-9.e]+)");
  for (std::sregex_iterator i(note.begin(), note.end(), pattern), end; i != end; ++i)
    all.push_back((*i)[1].str() + "=" + (*i)[2].str());
  return all;
}

std::string note_with(const Scene& scene, const std::string& part) {
  for (const std::string& note : scene.notes)
    if (note.find(part) != std::string::npos) return note;
  return "";
}

TEST(SceneRemedies, NameKeysOfMaterial) {
  const auto body = [](const std::string& moduli) {
    return kCube + "material = { " + moduli + " }\n" + pin("where = \"x < 0.1\"");
  };
  for (const char* soft : {"young = 100", "shear = 40, bulk = 80", "lambda = 50, mu = 40"}) {
    const std::string note = note_with(load(body(soft)), "crushes");
    ASSERT_NE(note, "") << soft;
    EXPECT_EQ(note_with(load(body(soft), assignments(note)), "crushes"), "") << note;
  }
  for (const char* soft : {"young = 0.06", "shear = 0.04, bulk = 0.08"}) {
    const auto weightless = [&](const std::vector<std::string>& set = {}) {
      return note_with(load("gravity = [0, 0, 0]\n" + body(soft), set), "softer than any solid");
    };
    const std::string note = weightless();
    ASSERT_NE(note, "") << soft;
    EXPECT_EQ(weightless(assignments(note)), "") << note;
  }
  for (const char* stiff : {"young = 2e14", "shear = 1e14, bulk = 2e14", "lambda = 1e14, mu = 1e14"}) {
    const std::string note = note_with(load(body(stiff)), "diamond");
    ASSERT_NE(note, "") << stiff;
    EXPECT_EQ(note_with(load(body(stiff), assignments(note)), "diamond"), "") << note;
  }
}

TEST(SceneRemedies, ForNegativePoissonRatiosAreAccepted) {
  const auto notes_of = [](const std::string& moduli) {
    return note_with(load(kCube + "material = { model = \"neo_hookean\", " + moduli + " }\n"), "has no minimum");
  };
  EXPECT_THAT(notes_of("poisson = -0.5"), HasSubstr("(poisson = 0 or more"));
  EXPECT_THAT(notes_of("shear = 3e4, bulk = 5e3"), HasSubstr("(bulk = 20000 or more"));
  EXPECT_THAT(notes_of("lambda = -1e4, mu = 3e4"), HasSubstr("(lambda = 0 or more"));
  EXPECT_EQ(notes_of("shear = 3e4, bulk = 2e4"), "");
  EXPECT_EQ(notes_of("lambda = 0, mu = 3e4"), "");
}

}  // namespace
}  // namespace aspic

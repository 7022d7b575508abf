// Sheets and rods of extreme or defective input: each runs, or is rejected with its place, its value and a remedy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

struct ThinCase {
  std::string mesh;       // mesh.obj; empty: a rectangle, or a line if `body` has a rod
  std::string body;       // keys of the body
  std::string refused;    // regular expression of the message; empty: runs
  std::string more = "";  // further tables of the scene
  std::string integrator = "backward_euler";
};

const std::string kFlap = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.1 1 0\nf 1 2 3\nf 2 1 4\n";  // folded by half a turn
const std::string kTee = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n";
const std::string kThin = "shell = { thickness = 1e-3 }";
const std::string kRod = "rod = { radius = 1e-3 }";
const std::string kBall = "[contact]\n[[obstacle]]\nsphere = { center = [0.5, 0.5, -0.3], radius = 0.2 }\n";

std::string shape_of(const ThinCase& c) {
  if (!c.mesh.empty()) return "mesh = \"mesh.obj\"\n";
  if (c.body.starts_with("shape")) return "";
  return c.body.starts_with("rod") ? "shape = { line = { from = [0, 0, 0], to = [1, 0, 0], size = 0.1 } }\n"
                                   : "shape = { rectangle = { width = 0.4, height = 0.4, size = 0.1 } }\n";
}

const std::vector<ThinCase> kThinCases = {
    {kTee, kThin, ""},
    {kTee, "shell = { thickness = 1e-3, bending = \"mid_edge\" }", ":8:.*edge of 3 triangles.*hinge"},
    {kFlap, kThin, ""},
    {kFlap, "shell = { thickness = 1e-2, rest = \"flat\" }", ""},
    {kFlap, "shell = { thickness = 1e-2, rest = \"flat\", bending = \"mid_edge\" }", ""},
    {kFlap, kThin, "surfaces intersect.*move them apart", "[contact]\n"},
    {"v 0 0 0\nv 1 0 0\nv 0.5 1e-9 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n", kThin, ""},
    {"v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n", kThin, ":7:.*mesh.obj:2: a vertex coordinate is 'nan'"},
    {"", "shell = { thickness = 0.15, moment = 1e-5 }", "", kBall},
    {"", "shell = { thickness = 1e-300 }", ":8:.*thickness = 1e-300; must be from 1e-12 to 1000 times the extent"},
    {"", "shell = { thickness = 1e300 }", ":8:.*thickness = 1e\\+300; must be"},
    {"", "shell = { thickness = nan }", ":8:.*thickness = nan"},
    {"", "shell = { thickness = 1e-3, moment = 0 }", ""},
    {"", "shell = { thickness = 1e-3, moment = 0 }\n[[body.pin]]\nwhere = \"y > 0.19\"", "", "", "quasi_static"},
    {"", "shell = { thickness = 1e-3, moment = 1e300 }\n[[body.pin]]\nwhere = \"y > 0.19\"", ""},
    {"", "shell = { thickness = 1e-3, moment = nan }", ":8:.*moment = nan"},
    {"", kThin + "\nmaterial = { density = 0 }", ":9:.*density = 0; must be > 0"},
    {"", kThin + "\n" + kRod, "excludes.*keep one of"},
    {"", kThin, ":10:.*wind of 1e\\+20 m/s", "[wind]\nvelocity = [0, 0, 1e20]\n"},
    {"v 0 0 0\nv 1 0 0\nl 1 2\n", kRod + "\n[[body.pin]]\nwhere = \"x < 0.1\"", ""},
    {"v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3 1\n", kRod, ""},
    {"v 0 0 0\nv 1 0 0\nv 0 1e-9 0\nl 1 2 3\n", kRod, ":7:.*folds back on itself at vertex 1"},
    {"v 0 0 0\nv 1 0 0\nv 2 0 0\nv 1 1 0\nl 1 2 3\nl 2 4\n", kRod, ":7:.*more than two segments meet at vertex 1"},
    {"", "rod = { radius = 1e-300 }", ":8:.*radius = 1e-300; must be"},
    {"", "rod = { radius = 1e-3, natural_twist = 1e300 }", ":8:.*natural_twist = 1e\\+300; must be"},
};

TEST(ThinBody, RunsOrIsRejectedInWords) {
  const TestFolder folder;
  for (const ThinCase& c : kThinCases) {
    SCOPED_TRACE(c.mesh + c.body + c.more);
    folder.write("mesh.obj", c.mesh);
    const auto path =
        folder.write("scene.toml", "[time]\nstep = 0.01\nduration = 0.02\nintegrator = \"" + c.integrator +
                                       "\"\n[[body]]\nname = \"thin\"\n" + shape_of(c) + c.body + "\n" + c.more);
    std::string message;
    try {
      Scene scene = load_scene(path);
      for (int i = 0; i < scene.steps; ++i) EXPECT_TRUE(is_success(scene.simulation.step().status)) << i;
    } catch (const InvalidInput& e) {
      message = e.what();
    }
    EXPECT_THAT(message, c.refused.empty() ? testing::Matcher<std::string>("") : testing::ContainsRegex(c.refused));
  }
}

TEST(ThinBody, ShellOfASolidIsNoted) {
  const Scene scene =
      load("[[body]]\nname = \"box\"\nshape = { box = { upper = [1, 1, 1], cells = [1, 1, 1] } }\n" + kThin);
  EXPECT_THAT(scene.notes, testing::Contains(testing::HasSubstr("its shell is the surface of a solid, and hollow")));
}

// A strip that lies around a post twice, in contact with the post and itself.
TEST(ThinBody, WrapsAPostTwice) {
  const TestFolder folder;
  constexpr int kAround = 60;
  std::string strip;
  for (int i = 0; i <= kAround; ++i)
    for (const char* z : {" 0\n", " 0.05\n"}) {
      const double angle = 12.56 * i / kAround, r = 0.11 + 0.02 * i / kAround;
      strip += "v " + std::to_string(r * std::cos(angle)) + " " + std::to_string(r * std::sin(angle)) + z;
    }
  for (int i = 1; i < 2 * kAround; i += 2)
    strip += "f " + std::to_string(i) + " " + std::to_string(i + 2) + " " + std::to_string(i + 3) + " " +
             std::to_string(i + 1) + "\n";
  folder.write("strip.obj", strip);
  Scene scene = load_scene(folder.write(
      "scene.toml",
      "[contact]\nfriction = 0.3\n[[obstacle]]\ncapsule = { from = [0, 0, -1], to = [0, 0, 1], radius = 0.1 "
      "}\n[[body]]\nmesh = \"strip.obj\"\nshell = { thickness = 1e-3, moment = 1e-5 }\nmaterial = { young = "
      "1e6, density = 300 }\n"));
  StepReport report;
  for (int i = 0; i < 15; ++i) {
    report = scene.simulation.step();
    ASSERT_TRUE(is_success(report.status)) << i;
  }
  EXPECT_GT(report.contacts, 0);
}

}  // namespace
}  // namespace aspic

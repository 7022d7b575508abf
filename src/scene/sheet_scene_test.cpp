// Sheets in scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "contact/barrier.h"
#include "dynamics/step_derivatives.h"
#include "io/atomic_file.h"
#include "math/svd3.h"
#include "mesh/elements.h"
#include "mesh/self_intersection.h"
#include "mesh/surface.h"
#include "results/explanation.h"
#include "results/run_directory.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kSheet =
    "[solver]\ntolerance = 1e-6\n[time]\nstep = 0.02\nduration = 0.4\n[[body]]\nname = \"cloth\"\nshape = { rectangle "
    "= { "
    "width = 0.4, height = 0.4, size = 0.08 } }\nmaterial = { young = 1e5, poisson = 0.3, density = 500 }\n";
const std::string kShell = "shell = { thickness = 1e-3 }\n";

void run_steps(Scene& scene, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(is_success(scene.simulation.step().status)) << i;
}

TEST(SheetScene, MassIsDensityTimesThicknessTimesArea) {
  const Scene scene = load(kSheet + kShell);
  EXPECT_NEAR(scene.simulation.model().mass->total(), 500 * 1e-3 * 0.16, 1e-12);
}

TEST(SheetScene, HangsFromItsPinWithItsWeight) {
  Scene scene =
      load(kSheet + kShell + "[[body.pin]]\nname = \"top\"\nwhere = \"y > 0.19\"\n", {"time.integrator=quasi_static"});
  run_steps(scene, 1);
  double force = 0;
  const std::vector<double> reactions = scene.simulation.reactions();
  for (size_t i = 1; i < reactions.size(); i += 3) force += reactions[i];
  EXPECT_NEAR(force, 9.81 * 0.08, 1e-6);
}

TEST(SheetScene, EqualBitsForAnyThreadCount) {
  const auto end = [](int threads) {
    set_thread_count(threads);
    Scene scene =
        load(kSheet + kShell +
                 "translate = [0.02, 0.03, 0.11]\n[[obstacle]]\nsphere = { center = [0, 0, 0], radius = 0.1 }\n"
                 "[wind]\nvelocity = [\"3 * sin(9 * t)\", 0, 0]\n",
             {"gravity=[0,0,-9.81]", "contact.friction=0.3"});
    run_steps(scene, 8);
    return scene.simulation.state().q;
  };
  const int threads = thread_count();
  const std::vector<double> one = end(1), four = end(4);
  set_thread_count(threads);
  EXPECT_EQ(one, four);
}

// The work of the wind and the loss in drag balance the ledger.
TEST(SheetScene, WindDoesWorkInTheLedger) {
  Scene scene = load("gravity = [0, 0, 0]\n[wind]\nvelocity = [0, 0, 5]\n" + kSheet + kShell);
  double work = 0, loss = 0, error = 0;
  for (int i = 0; i < 10; ++i) {
    const StepReport report = scene.simulation.step();
    ASSERT_TRUE(is_success(report.status));
    EXPECT_TRUE(report.energy_bound == EnergyBound::holds);
    work += report.nonconservative_work, loss += report.damping_loss;
    error = std::max(error, std::abs(report.ledger_error));
  }
  EXPECT_GT(work, loss);
  EXPECT_GT(loss, 0);
  EXPECT_LT(error, 1e-12 * work);
}

// No triangle of a sheet that falls on a ball and on a second sheet ever intersects another.
TEST(SheetScene, SurfacesNeverIntersect) {
  Scene scene = load("gravity = [0, 0, -9.81]\n" + kSheet + kShell + "translate = [0.02, 0.03, 0.105]\n" +
                     "[[body]]\nname = \"second\"\nshape = { disc = { radius = 0.2, size = 0.08 } }\n" + kShell +
                     "translate = [0, 0, 0.13]\nmaterial = { young = 1e5, density = 500 }\n" +
                     "[[obstacle]]\nname = \"ball\"\nsphere = { center = [0, 0, 0], radius = 0.1 }\n");
  const Model& model = scene.simulation.model();
  double gap = INFINITY;
  for (int i = 0; i < 20; ++i) {
    const StepReport report = scene.simulation.step();
    ASSERT_TRUE(is_success(report.status)) << i;
    if (report.contacts > 0) gap = std::min(gap, report.min_gap);
    TriMesh surface{{}, boundary_surface(model.mesh).surface.triangles};
    for (int v = 0; v < model.mesh.vertex_count(); ++v)
      surface.vertices.push_back(point(scene.simulation.state().q, v));
    EXPECT_TRUE(self_intersections(surface, 1).pairs.empty()) << i;
    for (int v = 0; v < model.mesh.vertex_count(); ++v)
      EXPECT_GT(norm(surface.vertices[v]), 0.1 + 0.5e-3);  // half the thickness from the ball
  }
  EXPECT_LT(gap, 0.01);
  EXPECT_GT(gap, 0);
}

TEST(SheetScene, FramesHoldTrianglesBesideTets) {
  const TestFolder folder;
  Scene scene = load(kSheet + kShell +
                     "[[body]]\nname = \"cube\"\nshape = { box = { lower = [0, 1, 0], upper = [1, 2, 1], "
                     "cells = [1, 1, 1] } }\n");
  const TetFields fields = scene.simulation.tet_fields();
  const TetMesh& mesh = scene.simulation.model().mesh;
  EXPECT_EQ(fields.det_F.size(), static_cast<size_t>(mesh.element_count()));
  EXPECT_EQ(mesh.tet_count(), 6);
  RunDirectory run = RunDirectory::create(folder.path() / "run", scene, ExistingRun::refuse);
  run.finish(scene.simulation);
  const std::string frame = read_file(folder.path() / "run" / "frames" / "body_000000.vtu");
  EXPECT_THAT(frame, HasSubstr("NumberOfCells=\"" + std::to_string(mesh.element_count()) + "\""));
}

TEST(SheetScene, WarpIsStifferThanWeft) {
  const auto sag = [](const char* warp) {
    Scene scene = load(kSheet + "shell = { thickness = 1e-3, weave = { weft = 1e4, shear = 1e4, warp = " + warp +
                           " } }\n[[body.pin]]\nwhere = \"y > 0.19\"\n",
                       {"time.integrator=quasi_static"});
    EXPECT_TRUE(is_success(scene.simulation.step().status));
    double low = 0;
    for (size_t i = 1; i < scene.simulation.state().q.size(); i += 3)
      low = std::min(low, scene.simulation.state().q[i]);
    return -0.2 - low;
  };
  const double along = sag("[0, 1, 0]"), across = sag("[1, 0, 0]");
  EXPECT_NEAR(along, 500 * 9.81 * 0.4 * 0.4 / 2 / 1e5, 0.1 * along);  // rho g L^2 / (2 E)
  EXPECT_GT(across, 5 * along);
}

TEST(SheetScene, RefusesWhatNeedsASolid) {
  EXPECT_THAT(refusal(kSheet), AllOf(HasSubstr("rectangle"), HasSubstr("add shell")));
  EXPECT_THAT(refusal(kSheet + kShell + "order = 2\n"), HasSubstr("needs a solid"));
  EXPECT_THAT(refusal(kSheet + "elastic = false\nshell = { thickness = 1e-3, bending = \"mid_edge\" }\n"),
              HasSubstr("elastic = false excludes bending"));
  EXPECT_THAT(refusal(kSheet + kShell + "[[body.force]]\nwhere = \"all\"\nvalue = [1, 0, 0]\n"),
              HasSubstr("needs a solid"));
  EXPECT_THAT(refusal(kSheet + "shell = { thickness = 0 }\n"), HasSubstr("thickness = 0"));
  EXPECT_THAT(refusal(kSheet + "shell = {}\n"), HasSubstr("needs the key 'thickness'"));
  EXPECT_THAT(refusal(kSheet + kShell, {"material.model=stvk"}), HasSubstr("a shell is neo_hookean"));
  EXPECT_THAT(refusal(kSheet + kShell, {"material.poisson=-0.1"}), HasSubstr("at least 0"));
  EXPECT_THAT(refusal(kSheet + "shell = { thickness = 1e-3, weave = { weft = 1e4, shear = 1e4, warp = [0, 0, 1] } }\n"),
              HasSubstr("warp is normal"));
  EXPECT_THAT(refusal("[wind]\nvelocity = [1, 0, 0]\n" + kSheet + kShell, {"time.integrator=rk4"}),
              HasSubstr("wind needs an implicit one"));
  EXPECT_THAT(refusal("[wind]\nvelocity = [1, 0, 0]\n" + kCube), HasSubstr("no body is a sheet"));
}

TEST(SheetScene, RefusesDefectsOfTheMesh) {
  const TestFolder folder;
  const auto refused = [&](const std::string& obj) {
    folder.write("sheet.obj", obj);
    return refusal_of(folder.write("scene.toml", "[[body]]\nmesh = \"sheet.obj\"\n" + kShell));
  };
  EXPECT_THAT(refused("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n"),
              AllOf(HasSubstr("scene.toml:2:8"), HasSubstr("1 triangles have no area (0)")));
  EXPECT_THAT(refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n"), HasSubstr("vertices of an earlier one (1)"));
  EXPECT_THAT(refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n"), HasSubstr("1 vertices belong to no triangle"));
  EXPECT_EQ(refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "");
}

// Three sheets that share an edge, and one that is one-sided.
TEST(SheetScene, RunsWithoutManifoldOrTwoSides) {
  const TestFolder folder;
  folder.write(
      "t.obj",
      "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 1\nv 0 1 0\nv 1 1 0\nv 0 0 -1\nv 1 0 -1\nf 1 2 4 3\nf 1 2 6 5\nf 1 2 8 7\n");
  std::string moebius;
  constexpr int kAround = 24;
  for (int i = 0; i < kAround; ++i)
    for (const double s : {-0.3, 0.0, 0.3}) {
      const double t = 2 * std::numbers::pi * i / kAround, r = 1 + s * std::cos(t / 2);
      moebius += "v " + std::to_string(r * std::cos(t)) + " " + std::to_string(r * std::sin(t)) + " " +
                 std::to_string(s * std::sin(t / 2)) + "\n";
    }
  for (int i = 0; i < kAround; ++i)
    for (int k = 0; k < 2; ++k) {
      const bool turns = i == kAround - 1;
      const int a = 3 * i + k + 1, b = a + 1, next = turns ? 0 : 3 * (i + 1);
      const int c = next + (turns ? 2 - k : k) + 1, d = next + (turns ? 1 - k : k + 1) + 1;
      moebius +=
          "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(d) + " " + std::to_string(c) + "\n";
    }
  folder.write("moebius.obj", moebius);
  for (const std::string mesh : {"t.obj", "moebius.obj"}) {
    Scene scene = load_scene(folder.write(
        "scene.toml", "[contact]\n[[obstacle]]\nplane = { origin = [0, -1.5, 0] }\n[[body]]\nmesh = \"" + mesh +
                          "\"\nshell = { thickness = 0.01 }\nmaterial = { young = 1e5, density = 300 }\n"));
    run_steps(scene, 3);
  }
}

// A sheet that is fixed everywhere feels the drag on a flat plate, whatever the integrator evaluates.
TEST(SheetScene, WindPushesEquallyInAllIntegrators) {
  for (const std::string integrator : {"backward_euler", "bdf2", "tr_bdf2", "trapezoid", "midpoint", "quasi_static"}) {
    Scene scene = load("gravity = [0, 0, 0]\n[wind]\nvelocity = [0, 0, 5]\n" + kSheet + kShell +
                           "[[body.pin]]\nname = \"all\"\nwhere = \"all\"\n",
                       {"time.integrator=" + integrator});
    const StepReport report = scene.simulation.step();
    EXPECT_NEAR(report.resultants.pins[0].force[2], -0.5 * 1.2 * 1.2 * 25 * 0.16, 1e-9) << integrator;
  }
}

// The remedy of the note bends the sheet.
TEST(SheetScene, WindInThePlaneOfAFlatSheetIsNoted) {
  const auto flag = [](const std::string& velocity) {
    return load("[wind]\nvelocity = " + velocity + "\n" + kSheet + kShell + "[[body.pin]]\nwhere = \"X < -0.19\"\n");
  };
  const auto farthest_out = [](Scene scene) {
    run_steps(scene, 10);
    double distance = 0;
    for (size_t i = 2; i < scene.simulation.state().q.size(); i += 3)
      distance = std::max(distance, std::abs(scene.simulation.state().q[i]));
    return distance;
  };
  const auto is_noted = testing::Contains(HasSubstr("in the plane of this flat sheet"));
  EXPECT_THAT(flag("[5, 0, 0]").warnings, testing::Contains(HasSubstr("along the normal [0, 0, 1]")));
  EXPECT_EQ(farthest_out(flag("[5, 0, 0]")), 0);
  EXPECT_GT(farthest_out(flag("[5, 0, 0.05]")), 1e-4);
  for (const char* velocity : {"[5, 0, 0.05]", "[5, 0, \"sin(t)\"]", "[0, 0, 0]"})
    EXPECT_THAT(flag(velocity).warnings, testing::Not(is_noted)) << velocity;
}

TEST(SheetScene, ThinBodiesWithoutContactAreNoted) {
  const std::string second = "[[body]]\nname = \"second\"\nshape = { sphere = { radius = 0.2, size = 0.1 } }\n";
  const auto is_noted = testing::Contains(HasSubstr("contact is off: body 'cloth' passes through"));
  EXPECT_THAT(load(kSheet + kShell + second).notes, is_noted);
  EXPECT_THAT(load(kCube + second).notes, testing::Not(testing::Contains(HasSubstr("contact is off"))));
  EXPECT_THAT(load(kSheet + kShell).notes, testing::Not(is_noted));
  EXPECT_THAT(load("[contact]\n" + kSheet + kShell + "translate = [0, 0, 0.5]\n" + second).notes,
              testing::Not(is_noted));
}

TEST(SheetScene, ClosedSheetIsHollow) {
  const std::string ball = "[contact]\n[[body]]\nname = \"skin\"\nshape = { sphere = { radius = 0.2, size = 0.1 } }\n" +
                           kShell + "[[body]]\nname = \"core\"\nshape = { sphere = { radius = 0.1, size = 0.1 } }\n";
  EXPECT_EQ(refusal(ball), "");
}

// Sheets that lie exactly on another surface, or closer than half their thickness, leave it before the first step.
TEST(SheetScene, StartsOnWhatItTouches) {
  const std::string box = "lower = [-0.5, -0.5, -0.1], upper = [0.5, 0.5, 0], cells = [2, 2, 1]";
  const std::string second =
      "[[body]]\nname = \"second\"\nshape = { rectangle = { width = 0.4, height = 0.4, size = 0.08 } }\n" + kShell;
  for (const std::string& below :
       {std::string("[[obstacle]]\nplane = { normal = [0, 0, 1] }\n"),
        "[[obstacle]]\nshape = { box = { " + box + " } }\n",
        "[[body]]\nname = \"block\"\nshape = { box = { " + box + " } }\npin = { where = \"all\" }\n",
        std::string("[[obstacle]]\nsphere = { center = [0, 0, -0.2], radius = 0.2 }\n"), second})
    for (const char* height : {"0", "0.0003", "-0.0002"}) {
      Scene scene = load("gravity = [0, 0, -9.81]\n[contact]\n" + kSheet + kShell + "translate = [0, 0, " + height +
                         "]\n" + below);
      EXPECT_THAT(scene.notes, testing::Contains(HasSubstr("surfaces touch at the start"))) << below << height;
      run_steps(scene, 2);
    }
}

TEST(SheetScene, InelasticSheetFallsFreely) {
  Scene scene = load(kSheet + kShell + "elastic = false\nvelocity = [\"y\", 0, 0]\n");
  run_steps(scene, 5);
  const State& state = scene.simulation.state();
  for (size_t i = 0; i < state.q.size(); i += 3) {
    const Vec3d& X = scene.simulation.model().mesh.rest[i / 3];
    EXPECT_NEAR(state.qdot[i], X[1], 1e-9);
    EXPECT_NEAR(state.qdot[i + 1], -9.81 * state.time, 1e-9);
  }
}

TEST(SheetScene, DeepOverlapIsRefused) {
  const std::string ball =
      "[contact]\nstart = \"inflate\"\n[[obstacle]]\nname = \"ball\"\nsphere = { center = [0, 0, 0], radius = 0.1 }\n";
  const std::string shirt =
      "[[body]]\nname = \"shirt\"\nshape = { tube = { radius = 0.09, height = 0.1, size = 0.03 } }\n" + kShell;
  EXPECT_THAT(refusal(ball + shirt), AllOf(HasSubstr("ball and shirt, by 0.0"), HasSubstr("deform = { scale = 1.1 }"),
                                           HasSubstr("no volume")));
  const std::string block =
      "[contact]\n[[obstacle]]\nname = \"block\"\nshape = { box = { lower = [-0.1, -0.1, -1], upper = [0.1, "
      "0.1, 1], cells = [1, 1, 1] } }\n";
  EXPECT_THAT(refusal(block + shirt + "translate = [0.15, 0, 0]\n"), HasSubstr(" m, up to 0.04 m deep ("));
  EXPECT_EQ(refusal(ball + shirt + "deform = { scale = [1.2, 1.2, 1] }\n"), "");
}

TEST(SheetScene, CollapsedStartIsRefused) {
  EXPECT_THAT(refusal(kSheet + kShell + "deform = { scale = [0, 1, 1] }\n"),
              AllOf(HasSubstr("triangles are collapsed (0, 1,"), HasSubstr("smaller initial deformation")));
}

TEST(SheetScene, SheetAloneBecomesAScene) {
  const TestFolder folder;
  const std::string level = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3\nf 1 3 4\n";
  const Scene falls = load_scene(folder.write("level.obj", level));
  EXPECT_TRUE(falls.simulation.model().contact);
  EXPECT_TRUE(falls.simulation.model().pins.empty());
  const Scene turned = load_scene(folder.path() / "level.obj", {.overrides = {"gravity=[0, 0, -9.81]"}});
  EXPECT_EQ(turned.simulation.model().pins.size(), 1u);  // upright under this gravity
  const Scene hangs = load_scene(folder.write("upright.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"));
  EXPECT_EQ(hangs.simulation.model().pins.size(), 1u);
}

const std::string kFoil = kSheet + "shell = { thickness = 1e-3, moment = 1e-3, yield = 2e-3 }\n" +
                          "[[body.pin]]\nname = \"edge\"\nwhere = \"x < -0.1\"\n";

TEST(SheetScene, CreasesLoseEnergyAndRestoreWithTheSameBits) {
  Scene scene = load(kFoil, {"gravity=[0,0,-9.81]"});
  double loss = 0;
  const auto step = [&] {
    const StepReport report = scene.simulation.step();
    ASSERT_TRUE(is_success(report.status));
    EXPECT_GE(report.damping_loss, -1e-18);
    EXPECT_LT(std::abs(report.ledger_error), 1e-15);
    loss += report.damping_loss;
  };
  for (int i = 0; i < 5; ++i) step();
  EXPECT_GT(loss, 1e-5);
  const Simulation::Snapshot snapshot = scene.simulation.snapshot();
  for (int i = 0; i < 3; ++i) step();
  const std::uint64_t hash = scene.simulation.state_hash();
  scene.simulation.restore(snapshot);
  for (int i = 0; i < 3; ++i) step();
  EXPECT_EQ(scene.simulation.state_hash(), hash);
  for (const TermDerivatives& of : check_step_derivatives(scene.simulation, 1e-6))
    EXPECT_TRUE(of.report.passed()) << of.term << " " << of.state;
}

TEST(SheetScene, PinsBeyondTheLimitAreNamed) {
  Scene scene = load(
      "gravity = [0, 0, 0]\n[time]\nstep = 0.1\nduration = 0.1\n[[body]]\nname = \"sheet\"\n"
      "shape = { rectangle = { width = 0.4, height = 0.4, size = 0.1 } }\n"
      "shell = { thickness = 5e-4, limit = 1.1 }\nmaterial = { young = 1e6, poisson = 0.3 }\n"
      "[[body.pin]]\nwhere = \"X < -0.19\"\n[[body.pin]]\nwhere = \"X > 0.19\"\n"
      "motion = { linear = { velocity = [1, 0, 0] } }\n");
  const StepReport report = scene.simulation.step();
  ASSERT_EQ(report.status, Status::undefined);
  const Explanation why = explain(scene.simulation, report);
  EXPECT_THAT(why.cause, HasSubstr("beyond the limit of its stretch"));
  EXPECT_THAT(why.place, testing::ContainsRegex("triangle [0-9]+ would be stretched by .*, more than shell.limit"));
  EXPECT_THAT(why.remedy, HasSubstr("raise shell.limit"));
}

// A unit square of two triangles with texture coordinates of a square whose side is .9, one of them mirrored.
std::filesystem::path square_with_pattern(const TestFolder& folder, const std::string& shell) {
  folder.write("square.obj",
               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt .45 0\nvt .45 .45\nvt -.45 .45\nvt 0 .45\n"
               "f 1/1 2/2 3/3\nf 1/1 3/4 4/5\n");
  return folder.write("scene.toml",
                      "gravity = [0, 0, 0]\n[time]\nstep = 0.01\nduration = 0.01\n[[body]]\nname = \"square\"\nmesh = "
                      "\"square.obj\"\nmaterial = { young = 1e6, poisson = 0.3, density = 200 }\nshell = { thickness = "
                      "1e-3, moment = 0, " +
                          shell + " }\n");
}

TEST(SheetScene, PatternIsTheRestShape) {
  const TestFolder folder;
  const Scene scene = load_scene(square_with_pattern(folder, "pattern = { uv_scale = 2.0 }"));
  const Model& model = scene.simulation.model();
  EXPECT_NEAR(model.mass->total(), 200 * 1e-3 * 0.81, 1e-12);
  const double s = 1 / 0.9, mu = 1e6 / 2.6, la = 0.3e6 / 0.91;
  const double psi = mu / 2 * (2 * s * s - 2 - 4 * std::log(s)) + 2 * la * std::log(s) * std::log(s);
  EXPECT_NEAR(model.elasticity[0]->value(scene.simulation.state().q), 0.81 * 1e-3 * psi, 1e-11);
  for (int t = 0; t < 2; ++t) {
    const Mat3d F = deformation_gradient(model.mesh, t, scene.simulation.state().q);
    EXPECT_LT(squared_norm(transpose(F) * F - Mat3d{{s * s, 0, 0, 0, s * s, 0, 0, 0, 1}}), 1e-24);
    EXPECT_GT(F(0, 0), 0.9);  // without a rotation
  }
  EXPECT_THAT(scene.notes, testing::Contains(HasSubstr("the pattern has 0.81 of the area of the mesh")));
}

TEST(SheetScene, RefusesPatternsWithoutTextureCoordinates) {
  EXPECT_THAT(refusal(kSheet + "shell = { thickness = 1e-3, pattern = { uv_scale = 1.0 } }\n"),
              HasSubstr("a shape has no texture coordinates"));
  const TestFolder folder;
  const std::filesystem::path scene = square_with_pattern(folder, "pattern = { uv_scale = 2.0 }");
  EXPECT_THAT(refusal_of(scene, {.overrides = {"body.shell.pattern.uv_scale=0"}}), HasSubstr("must be > 0"));
  folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THAT(refusal_of(scene), HasSubstr("square.obj:4: a corner has no texture coordinates"));
  const std::filesystem::path off = folder.write("square.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_THAT(refusal_of(scene, {.overrides = {"body.mesh=\"" + off.string() + "\""}}),
              HasSubstr("Wavefront OBJ with UVs"));
}

// A soft cloth hangs from its upper edge.
TEST(SheetScene, StretchesStayBelowTheirLimit) {
  const auto largest = [&](const std::string& limit) {
    Scene scene =
        load(kSheet + "shell = { thickness = 1e-3" + limit + " }\n[[body.pin]]\nname = \"top\"\nwhere = \"y > 0.19\"\n",
             {"body.material.young=5e3"});
    double most = 0;
    for (int i = 0; i < 20; ++i) {
      EXPECT_TRUE(is_success(scene.simulation.step().status)) << i;
      const Model& model = scene.simulation.model();
      for (int t = 0; t < model.mesh.element_count(); ++t)
        most = std::max(most, svd3(deformation_gradient(model.mesh, t, scene.simulation.state().q)).s[0]);
    }
    return most;
  };
  EXPECT_GT(largest(""), 1.3);
  const double most = largest(", limit = 1.1");
  EXPECT_LT(most, 1.1);
  EXPECT_GT(most, 1.05);
}

TEST(SheetScene, RefusesLimitsOfStretches) {
  const auto with = [](const std::string& limit, const std::string& more = "") {
    return refusal(kSheet + "shell = { thickness = 1e-3, limit = " + limit + " }\n" + more);
  };
  EXPECT_EQ(with("1.1"), "");
  EXPECT_EQ(with("{ from = 1.0, to = 1.1 }"), "");
  EXPECT_THAT(with("1.0"), HasSubstr("limit = 1; the largest stretch must be above 1"));
  EXPECT_THAT(with("{ from = 1.2, to = 1.1 }"), HasSubstr("from = 1.2; must be at least 1 and below to = 1.1"));
  EXPECT_THAT(with("{ from = 0.9, to = 1.1 }"), HasSubstr("from = 0.9; must be at least 1"));
  EXPECT_THAT(with("{ from = 1.05 }"), HasSubstr("needs the key 'to'"));
  EXPECT_THAT(with("1.1", "deform = { scale = [1.2, 1, 1] }\n"), HasSubstr("is stretched by 1.2 at the start"));
}

TEST(SheetScene, RefusesCreasesWithoutHinges) {
  EXPECT_THAT(refusal(kFoil, {"body.shell.bending=\"mid_edge\""}), HasSubstr("yield needs bending = \"hinge\""));
  EXPECT_THAT(refusal(kFoil, {"body.shell.moment=0"}), HasSubstr("the bending stiffness is 0"));
  EXPECT_THAT(refusal(kFoil, {"time.integrator=bdf2"}), HasSubstr("does not advance the internal variables"));
}

}  // namespace
}  // namespace aspic

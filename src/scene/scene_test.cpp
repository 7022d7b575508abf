// From documents to simulations.
#include "scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "io/folder_test.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

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
  const Scene longer = load("[time]\nstep = 0.03\nduration = 0.1\n" + kCube);
  EXPECT_EQ(longer.steps, 4);
  EXPECT_THAT(longer.notes, testing::Contains(HasSubstr("the last step ends at t = 0.12 s")));
  EXPECT_EQ(load("[time]\nduration = 0\n" + kCube).steps, 0);
}

TEST(Scene, OptionsReachSimulation) {
  const Scene scene = load(
      "[time]\nintegrator = \"midpoint\"\nadaptive = { tolerance = 1e-4 }\n"
      "[solver]\ninitial_guess = \"last_increment\"\n" +
      kCube);
  const SimulationOptions& options = scene.simulation.options();
  EXPECT_EQ(options.integrator, "midpoint");
  EXPECT_EQ(options.adaptive.tolerance, 1e-4);
  EXPECT_EQ(options.initial_guess, "last_increment");
}

TEST(Scene, AdaptiveStepsOfOtherIntegratorsAreRejected) {
  EXPECT_THAT([] { load("[time]\nintegrator = \"bdf2\"\nadaptive = { tolerance = 1e-4 }\n" + kCube); },
              testing::ThrowsMessage<InvalidInput>(AllOf(HasSubstr("'bdf2'"), HasSubstr("tr_bdf2"))));
}

TEST(Scene, UnsupportedIntegratorOptionsAreErrorsWithPlace) {
  const auto refused = [](const std::string& integrator, const std::string& time, const std::string& solver) {
    return refusal("[time]\nintegrator = \"" + integrator + "\"\n" + time + "[solver]\n" + solver + kCube);
  };
  EXPECT_THAT(refused("bdf2", "adaptive = { tolerance = 1e-4 }\n", ""), HasSubstr("beam.toml:3:"));
  EXPECT_THAT(refused("rk4", "", "initial_guess = \"zero\"\n"), HasSubstr("beam.toml:4:"));
  EXPECT_THAT(refused("quasi_static", "", "initial_guess = \"extrapolated\"\n"), HasSubstr("beam.toml:4:"));
}

// The scheme has no convergence test, so its one iteration must be that of Newton's method.
TEST(Scene, LinearlyImplicitEulerRequiresNewton) {
  const auto refused = [](const std::string& solver) {
    return refusal("[time]\nintegrator = \"linearly_implicit_euler\"\n[solver]\n" + solver + kCube);
  };
  for (const char* method : {"lbfgs", "nonlinear_cg", "gradient_descent"}) {
    const std::string name = std::string("\"") + method + "\"";
    EXPECT_THAT(refused("method = " + name + "\n"),
                AllOf(HasSubstr("beam.toml:4:"), HasSubstr(method), HasSubstr("newton or newton_cg")));
    EXPECT_THAT(refused("fallback = [" + name + "]\n"), HasSubstr("beam.toml:4:"));
  }
  load("[time]\nintegrator = \"linearly_implicit_euler\"\n[solver]\nmethod = \"newton_cg\"\n" + kCube);
}

TEST(Scene, ScalesThenRotatesThenTranslatesRestShape) {
  const Scene scene = load(kCube +
                           "scale = [1, 2, 3]\nrotate = { axis = [0, 0, 5], angle_deg = 90 }\n"
                           "translate = [10, 0, 0]\n");
  // Vertex (1, 1, 1) of the box: scaled (1, 2, 3), turned (-2, 1, 3), moved (8, 1, 3).
  const Vec3d corner = rest(scene, 26);
  EXPECT_LT(distance(corner, {{8, 1, 3}}), 1e-14);
}

TEST(Scene, EulerAnglesRotateAboutXYZInOrder) {
  const Scene scene = load(kCube + "rotate = { euler_deg = [90, 0, 90] }\n");
  // (0, 1, 0) -> (0, 0, 1) about x -> (0, 0, 1) about z.
  EXPECT_LT(distance(rest(scene, 6), {{0, 0, 1}}), 1e-15);
}

TEST(Scene, DeformsAboutCenterOfRestShape) {
  const auto corner = [](const std::string& deform) {
    return vertex(positions(load(kCube + "deform = { " + deform + " }\n")), 26);
  };
  EXPECT_LT(distance(corner("scale = 2"), {{1.5, 1.5, 1.5}}), 1e-15);
  EXPECT_LT(distance(corner("scale = [1, 2, 1]"), {{1, 1.5, 1}}), 1e-15);
  EXPECT_LT(distance(corner("matrix = [[1, 1, 0], [0, 1, 0], [0, 0, 1]]"), {{1.5, 1, 1}}), 1e-15);
  EXPECT_LT(distance(corner("displacement = [\"0.1 * Y\", 0.2, 0]"), {{1.1, 1.2, 1}}), 1e-15);
  // The top turns by +90 degrees, the bottom by -90 degrees, about the axis through (0.5, 0.5).
  EXPECT_LT(distance(corner("twist = { axis = [0, 0, 1], angle_deg = 180 }"), {{0, 1, 1}}), 1e-15);
}

TEST(Scene, InitialVelocityFollowsFormulasAndSpin) {
  const Scene scene = load(kCube + "velocity = [\"Y\", 2, 0]\nangular_velocity = [0, 0, 3]\n");
  // At (1, 1, 1), half a meter from the center of mass along x and y.
  EXPECT_LT(distance(vertex(velocities(scene), 26), {{1 - 1.5, 2 + 1.5, 0}}), 1e-12);
}

TEST(Scene, GravityActsOnMassOfEachVertex) {
  Scene scene = load("gravity = [0, 0, -2]\n[time]\nstep = 0.1\n" + kCube);
  scene.simulation.step();
  for (int v = 0; v < 27; ++v) EXPECT_NEAR(scene.simulation.state().qdot[3 * v + 2], -0.2, 1e-9);
}

TEST(Scene, TractionAndPressureSumToForceTimesArea) {
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
  EXPECT_LT(distance(velocity("[[body.traction]]\nwhere = \"x < 0.001\"\ndead_pressure = \"50\"\n"), expected), 1e-12);
  EXPECT_LT(distance(velocity("[[body.force]]\nvalue = [50, 0, 0]\n"), expected), 1e-12);
  EXPECT_LT(distance(velocity("[[body.traction]]\nwhere = \"all\"\ndead_pressure = 50\n"), {{0, 0, 0}}), 1e-12);
}

TEST(Scene, PinsFollowTheirMotion) {
  const auto end = [](const std::string& motion, int steps) {
    Scene scene = load("gravity = [0, 0, 0]\n[time]\nstep = 0.1\n" + kCube +
                       "[[body.pin]]\nwhere = \"all\"\nmotion = " + motion + "\n");
    for (int i = 0; i < steps; ++i) scene.simulation.step();
    return vertex(positions(scene), 26);
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

TEST(Scene, MotionWithInitialJumpIsNoted) {
  const Scene scene = load(kCube + "[[body.pin]]\nwhere = \"y < 0.1\"\nmotion = { displacement = [0.5, 0, 0] }\n");
  EXPECT_THAT(scene.notes, Contains(HasSubstr("jumps by 0.5 m")));
}

TEST(Scene, MotionFailingDuringRunNamesPlace) {
  Scene scene =
      load(kCube + "[[body.pin]]\nwhere = \"y < 0.1\"\nmotion = { displacement = [\"t < 0.015 ? 0 : 1/0\", 0, 0] }\n");
  scene.simulation.step();
  const std::string message = message_of<InvalidInput>([&] { scene.simulation.step(); });
  EXPECT_THAT(message, AllOf(HasSubstr("beam.toml:6:27: "), HasSubstr("is inf at"), HasSubstr("t = 0.02")));
}

TEST(Scene, SelectionsContainExpectedVertices) {
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

TEST(Scene, EmptySelectionIsRejectedWithExtent) {
  EXPECT_THAT(refusal(kCube + "[[body.pin]]\nwhere = \"y > 9\"\n"),
              AllOf(HasSubstr("beam.toml:5:9"), HasSubstr("\"y > 9\""), HasSubstr("no vertex of body 'cube'"),
                    HasSubstr("from (0, 0, 0) to (1, 1, 1)")));
  EXPECT_THAT(refusal(kCube + "[[body.pin]]\nwhere = { vertices = [27] }\n"),
              AllOf(HasSubstr("27"), HasSubstr("beyond the last vertex of body 'cube', 26")));
  EXPECT_THAT(refusal(kCube + "[[body.traction]]\nwhere = { vertices = [0, 1] }\ndead_pressure = 1\n"),
              HasSubstr("no boundary triangle"));
  EXPECT_THAT(refusal(kCube + "[[body.force]]\nwhere = \"z > 5\"\nvalue = [0, 0, 0]\n"), HasSubstr("no tet"));
  EXPECT_THAT(refusal(kCube + "[[body.pin]]\nwhere = \"1 / x\"\n"), AllOf(HasSubstr(":5:"), HasSubstr("inf")));
}

TEST(Scene, VertexInTwoPinsNamesBoth) {
  EXPECT_THAT(
      refusal(kCube + "[[body.pin]]\nname = \"left\"\nwhere = \"x < 0.1\"\n[[body.pin]]\nname = \"low\"\nwhere = "
                      "\"y < 0.1\"\nmotion = { linear = { velocity = [0, 1, 0] } }\n"),
      AllOf(HasSubstr("beam.toml:9:9"), HasSubstr("'left'"), HasSubstr("'low'"), HasSubstr("(0, 0, 0)")));
}

TEST(Scene, LockingIsNoted) {
  EXPECT_THAT(load(kCube + "material = { poisson = 0.49 }\n").notes, Contains(HasSubstr("lock above 0.45")));
  EXPECT_THAT(load(kCube + "material = { poisson = 0.45 }\n").notes, Not(Contains(HasSubstr("lock"))));
}

TEST(Scene, InvertedOrFlatStartIsNoted) {
  EXPECT_THAT(load(kCube + "deform = { scale = 0 }\n").notes, Contains(HasSubstr("48 tets are inverted or flat")));
  EXPECT_THAT(load(kCube + "deform = { scale = 0.5 }\n").notes, Not(Contains(HasSubstr("inverted"))));
}

TEST(Scene, DigitsLostFarFromTheOriginAreNoted) {
  EXPECT_THAT(load(kCube + "translate = [1e12, 0, 0]\n").notes, Contains(HasSubstr("from the origin")));
  EXPECT_THAT(load(kCube + "translate = [1e5, 0, 0]\n").notes, Not(Contains(HasSubstr("from the origin"))));
}

TEST(Scene, SpringsJoinBodies) {
  Scene scene =
      load("gravity = [0, 0, 0]\n" + kCube +
           "[[body.spring]]\nbetween = [[26, 0]]\nto_body = \"other\"\nstiffness = 10\nrest_length = 0\n" +
           "[[body]]\nname = \"other\"\nshape = { box = { lower = [2, 1, 1], upper = [3, 2, 2], cells = [1, 1, "
           "1] } }\n");
  scene.simulation.step();
  EXPECT_GT(velocities(scene)[3 * 26], 0);
  EXPECT_LT(velocities(scene)[3 * 27], 0);
  EXPECT_THAT(refusal(kCube + "[[body.spring]]\nbetween = [[0, 99]]\nstiffness = 1\n"), HasSubstr("99"));
  EXPECT_THAT(refusal(kCube + "[[body.spring]]\nbetween = [[1, 1]]\nstiffness = 1\n"), HasSubstr("to itself"));
  EXPECT_THAT(refusal(kCube + "[[body.spring]]\nbetween = [[0, 1]]\nto_body = \"cub\"\nstiffness = 1\n"),
              HasSubstr("did you mean 'cube'?"));
}

const std::string kGrabbed =
    "[[body.grab]]\nstiffness = 10\npoint = [{ vertex = 13, weight = 0.0 }, { vertex = 14, "
    "weight = 0.0 }, { vertex = 17, weight = 0.25 }, { vertex = 26, weight = 0.75 }]\n";

TEST(Scene, GrabPullsDuringItsPath) {
  Scene scene = load("gravity = [0, 0, 0]\n" + kCube + kGrabbed +
                     "path = [{ time = 0.02, position = [1, 1, 1] }, { time = 0.04, position = [3, 1, 1] }]\n" +
                     "[[body.pin]]\nwhere = \"x < 0.1\"\n");
  const auto grabbed = [&] { return scene.simulation.potential_energies().back(); };
  ASSERT_EQ(scene.simulation.potential_names().back(), "grab");
  while (scene.simulation.state().time < 0.0199) scene.simulation.step();
  EXPECT_EQ(grabbed(), 0);
  EXPECT_EQ(velocities(scene)[3 * 26], 0);
  while (scene.simulation.state().time < 0.0399) scene.simulation.step();
  EXPECT_NEAR(grabbed(), 0.5 * 10 * 2.125 * 2.125, 0.05) << "the stiff cube has hardly followed the hand";
  EXPECT_GT(velocities(scene)[3 * 26], 0);
  const StepReport report = scene.simulation.step();
  EXPECT_EQ(grabbed(), 0);
  EXPECT_LT(std::abs(report.ledger_error), 1e-9) << "letting go is work of the hand";
}

TEST(Scene, GrabRequiresTetWeightsAndPath) {
  const std::string path = "path = [{ time = 0, position = [1, 1, 1] }, { time = 1, position = [3, 1, 1] }]\n";
  EXPECT_THAT(refusal(kCube + kGrabbed + "path = [{ time = 0, position = [1, 1, 1] }]\n"), HasSubstr("at least two"));
  EXPECT_THAT(
      refusal(kCube + kGrabbed + "path = [{ time = 1, position = [1, 1, 1] }, { time = 1, position = [1, 1, 1] }]\n"),
      HasSubstr("later than the previous one"));
  const auto with_point = [&](const std::string& point) {
    return refusal(kCube + "[[body.grab]]\nstiffness = 10\npoint = [" + point + "]\n" + path);
  };
  const std::string three =
      "{ vertex = 13, weight = 0.5 }, { vertex = 14, weight = 0.0 }, { vertex = 17, weight = 0.0 }";
  EXPECT_THAT(with_point(three), HasSubstr("the four of one tet"));
  EXPECT_THAT(with_point(three + ", { vertex = 26, weight = 0.6 }"), HasSubstr("must sum to 1"));
  EXPECT_THAT(with_point(three + ", { vertex = 0, weight = 0.5 }"), HasSubstr("no tet of body 'cube'"));
  EXPECT_THAT(with_point(three + ", { vertex = 99, weight = 0.5 }"), HasSubstr("99 is beyond the last vertex"));
}

TEST(Scene, SpringsToPointsPullTowardsTheirTarget) {
  Scene scene = load("gravity = [0, 0, 0]\n" + kCube +
                     "[[body.spring]]\nwhere = { vertices = [26] }\ntarget = [5, 1, 1]\nstiffness = 10\n");
  scene.simulation.step();
  EXPECT_GT(velocities(scene)[3 * 26], 0);
}

TEST(Scene, BodyWithoutElasticityFallsApart) {
  Scene scene = load("gravity = [0, 0, 0]\n" + kCube + "elastic = false\nvelocity = [\"X\", 0, 0]\n");
  scene.simulation.step();
  EXPECT_NEAR(velocities(scene)[3 * 26], 1, 1e-12);
}

TEST(Scene, GeneratedShapesAreBounded) {
  EXPECT_THAT(refusal("[[body]]\nshape = { sphere = { radius = 1, size = 1e-4 } }\n"), HasSubstr("larger size"));
  EXPECT_THAT(refusal("[[body]]\nshape = { box = { upper = [1, 1, 1], cells = [9999, 9999, 9999] } }\n"),
              HasSubstr("tets; at most"));
  EXPECT_THAT(refusal("[[body]]\nshape = { box = { upper = [1, 1, 1], size = 1e-300 } }\n"), HasSubstr("larger size"));
}

TEST(Scene, UnusedSolverOptionsAreErrorsWithPlace) {
  const auto refused = [](const std::string& lines) { return refusal("[solver]\n" + lines + kCube); };
  EXPECT_THAT(refused("method = \"lbfgs\"\ndefiniteness = \"clamped\"\n"),
              AllOf(HasSubstr("beam.toml:3:"), HasSubstr("definiteness = 'clamped'"), HasSubstr("newton, newton_cg")));
  EXPECT_THAT(refused("preconditioner = \"mass\"\n"), AllOf(HasSubstr("beam.toml:2:"), HasSubstr("nonlinear_cg")));
  EXPECT_THAT(refused("linear = \"cholesky\"\nmethod = \"newton_cg\"\n"), HasSubstr("beam.toml:2:"));
  EXPECT_THAT(refused("method = \"nonlinear_cg\"\ncriterion = \"velocity\"\n"),
              AllOf(HasSubstr("beam.toml:3:"), HasSubstr("newton or newton_cg")));
  EXPECT_THAT(refused("fallback = [\"lbfgs\", \"gradient_decent\"]\n"),
              AllOf(HasSubstr("beam.toml:2:"), HasSubstr("did you mean 'gradient_descent'")));
  EXPECT_THAT(refused("fallback = \"lbfgs\"\n"), HasSubstr("a list of names"));
}

TEST(Scene, ResolvedSolverOptionsGiveSameBits) {
  const std::string text =
      "[time]\nstep = 0.02\n[solver]\nmethod = \"lbfgs\"\npreconditioner = \"diagonal\"\n"
      "fallback = [\"newton\"]\ndefiniteness = \"progressive\"\n" +
      kCube + "[[body.pin]]\nwhere = \"x < 0.001\"\n";
  Scene scene = load(text);
  EXPECT_THAT(scene.simulation.solver_description(),
              AllOf(HasSubstr("lbfgs, preconditioner diagonal"), HasSubstr("newton")));
  Scene again = load(scene.resolved);
  for (int i = 0; i < 3; ++i) {
    scene.simulation.step();
    again.simulation.step();
  }
  EXPECT_EQ(scene.simulation.state().q, again.simulation.state().q);
}

TEST(Scene, UnusedMethodIsNoted) {
  const std::string text = "[time]\nstep = 1e-5\nintegrator = \"symplectic_euler\"\n" + kCube;
  EXPECT_THAT(load(text, {"solver.method=lbfgs"}).notes, Contains(HasSubstr("method = 'lbfgs' has no effect")));
  EXPECT_THAT(load(text).notes, Not(Contains(HasSubstr("no effect"))));
}

}  // namespace
}  // namespace aspic

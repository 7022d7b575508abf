#include "results/explanation.h"

#include <gmock/gmock.h>

#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;
using testing::HasSubstr;

// Explains the first failed step within ten.
Explanation first_failure(Simulation& simulation, Status wanted) {
  for (int i = 0; i < 10; ++i) {
    const StepReport report = simulation.step();
    if (is_success(report.status)) {
      EXPECT_TRUE(explain(simulation, report).cause.empty());
      continue;
    }
    EXPECT_EQ(report.status, wanted) << to_string(report.status);
    return explain(simulation, report);
  }
  ADD_FAILURE() << "no step failed";
  return {};
}
Explanation first_failure(const SimulationOptions& options, Status wanted) {
  Simulation simulation = simulate(beam(2), options);
  return first_failure(simulation, wanted);
}

Explanation blow_up(Model model, const char* integrator, double h) {
  Simulation simulation = simulate(std::move(model), {.h = h, .integrator = integrator});
  StepReport report;
  for (int i = 0; i < 2000 && report.status != Status::undefined; ++i) report = simulation.step();
  EXPECT_EQ(report.status, Status::undefined);
  return explain(simulation, report);
}

TEST(Explanation, ExplicitInstabilityNamesStableStep) {
  const Explanation why = blow_up(beam(2), "symplectic_euler", 0.05);
  EXPECT_THAT(why.cause, HasSubstr("blew up"));
  EXPECT_THAT(why.place, testing::AllOf(HasSubstr("vertex"), HasSubstr("vibrates fastest")));
  EXPECT_THAT(why.remedy, HasSubstr("time.step"));
}

TEST(Explanation, ExplicitInstabilityNamesSameFrequencyForEveryScheme) {
  const auto frequency = [](const char* integrator) {
    const std::string place = blow_up(beam(2), integrator, 0.05).place;
    return place.substr(place.find("at "));
  };
  EXPECT_EQ(frequency("rk4"), frequency("symplectic_euler"));
}

// Forward Euler gains energy for every time step.
TEST(Explanation, ForwardEulerInstabilitySuggestsAnotherScheme) {
  const Explanation why = blow_up(beam(2), "forward_euler", 0.05);
  EXPECT_THAT(why.cause, HasSubstr("blew up"));
  EXPECT_THAT(why.remedy, testing::StartsWith("time.integrator"));
}

TEST(Explanation, ExplicitInstabilityNamesDamping) {
  Model model = beam(2, {.young = 1e5});
  const double undamped = simulate(beam(2, {.young = 1e5})).stable_step().h;
  model.damping.push_back(make_rayleigh_damping(*model.mass, 0, model.elasticity[0].get(), 0.5));
  const Explanation why = blow_up(std::move(model), "symplectic_euler", 0.5 * undamped);
  EXPECT_THAT(why.cause, HasSubstr("longer than"));
  EXPECT_THAT(why.place, HasSubstr("damping"));
}

TEST(Explanation, ExplicitInstabilityNamesCrushingPins) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}), {.material = "neo_hookean_log"});
  Pin all{.name = "press", .motion = [](const Vec3d& X, double t) { return Vec3d{{X[0] * (1 - 10 * t), X[1], X[2]}}; }};
  for (int v = 0; v < model.mesh.vertex_count(); ++v) all.vertices.push_back(v);
  model.pins = {all};
  EXPECT_THAT(blow_up(std::move(model), "symplectic_euler", 0.01).cause, HasSubstr("pins themselves"));
}

TEST(Explanation, TightToleranceSeparatesRoundOffFromSlowness) {
  SimulationOptions tight{.solver = {.method = "lbfgs", .preconditioner = "mass"}};
  tight.solver.minimize.tolerance = 1e-18;
  const Explanation why = first_failure(tight, Status::iteration_limit);
  EXPECT_THAT(why.cause, HasSubstr("round-off"));
  EXPECT_THAT(why.remedy, HasSubstr("solver.tolerance = 1e-1"));
  SimulationOptions slow{.solver = {.method = "gradient_descent"}};
  slow.solver.minimize.tolerance = 1e-18;
  EXPECT_THAT(first_failure(slow, Status::iteration_limit).cause, HasSubstr("without the Hessian"));
}

TEST(Explanation, IterationLimitNamesParameter) {
  SimulationOptions few;
  few.solver.minimize.max_iterations = 1;
  EXPECT_THAT(first_failure(few, Status::iteration_limit).place, HasSubstr("max_iterations = 1"));

  SimulationOptions first_order;
  first_order.solver.method = "gradient_descent";
  EXPECT_THAT(first_failure(first_order, Status::iteration_limit).remedy, HasSubstr("newton"));
}

TEST(Explanation, IterationLimitNamesVertexWithLargestResidual) {
  Simulation simulation = simulate(beam(2, {.young = 1e4, .gravity = {{0, -1e3, 0}}}), {.h = 10});
  simulation.step();
  StepReport report = simulation.step();
  report.status = Status::iteration_limit;
  const Explanation why = explain(simulation, report);
  EXPECT_THAT(why.place, HasSubstr("vertex " + std::to_string(report.worst_vertex)));
  EXPECT_GT(report.worst_residual, 0);
  EXPECT_LE(report.worst_residual, report.residual);
}

TEST(Explanation, TooShortStepSuggestsLongerStep) {
  const Explanation why = first_failure({.h = 1e-9, .solver = {}}, Status::iteration_limit);
  EXPECT_THAT(why.cause, HasSubstr("round-off"));
  EXPECT_THAT(why.place, HasSubstr("time.step = 1e-09"));
  EXPECT_THAT(why.remedy, HasSubstr("increase time.step"));
}

TEST(Explanation, FreeBodyInStaticsNamesMissingPins) {
  for (const char* method : {"newton", "newton_cg", "gradient_descent"}) {
    const auto explained = [&](bool is_held) {
      Model model = beam(2);
      model.pins.clear();
      if (is_held) model.loads.push_back(make_point_springs("spring", {{0, 100, [](double) { return Vec3d{}; }}}));
      SimulationOptions options{.integrator = "quasi_static", .solver = {.method = method}};
      options.solver.minimize.max_iterations = 2;
      Simulation simulation = simulate(std::move(model), options);
      const StepReport report = simulation.step();
      EXPECT_FALSE(is_success(report.status)) << method;
      return explain(simulation, report).cause;
    };
    EXPECT_THAT(explained(false), HasSubstr("nothing holds the body")) << method;
    EXPECT_THAT(explained(true), testing::Not(HasSubstr("nothing holds the body"))) << method;
  }
}

// A beam on rollers along one edge, which leave it free to turn about that edge.
TEST(Explanation, HingedStaticsNamesFreeRotation) {
  for (const bool is_fixed : {true, false}) {
    Model model = beam(2, {.gravity = {{0, 0, -9.81}}});
    const std::vector<int> edge = vertices_where(model.mesh, [](const Vec3d& X) { return X[0] < 1e-9 && X[1] < 1e-9; });
    model.pins = {{.name = "hinge", .vertices = edge}};
    if (!is_fixed) {
      model.pins[0].directions = {{{1, 0, 0}}, {{0, 1, 0}}};
      model.pins.push_back({.name = "stop", .vertices = {edge[0]}, .directions = {{{0, 0, 1}}}});
    }
    SimulationOptions options{.integrator = "quasi_static"};
    options.solver.minimize.max_iterations = 1;
    Simulation simulation = simulate(std::move(model), options);
    const StepReport report = simulation.step();
    ASSERT_FALSE(is_success(report.status));
    const Explanation why = explain(simulation, report);
    EXPECT_THAT(why.place, HasSubstr("rotate about the axis through (0, 0, 0.5) m along (0, 0, 1)"));
    EXPECT_THAT(why.remedy, HasSubstr("pin one more vertex"));
  }
}

TEST(Explanation, StaticsOnRollersNamesFreeTranslation) {
  Model model = beam(2);
  model.pins[0].directions = {{{1, 0, 0}}, {{0, 1, 0}}};
  SimulationOptions options{.integrator = "quasi_static"};
  options.solver.minimize.max_iterations = 1;
  Simulation simulation = simulate(std::move(model), options);
  const StepReport report = simulation.step();
  ASSERT_FALSE(is_success(report.status));
  EXPECT_THAT(explain(simulation, report).place, HasSubstr("slide along (0, 0, 1)"));
}

TEST(Explanation, IteratesOutOfRangeNameMissingLineSearch) {
  SimulationOptions options{.h = 1, .solver = {}};
  options.solver.minimize.line_search.test = DecreaseTest::none;
  Simulation simulation = simulate(beam(1), options);
  StepReport report = simulation.step();
  report.status = Status::undefined;
  report.objective = 1;
  report.iterations = 3;
  const Explanation why = explain(simulation, report);
  EXPECT_THAT(why.place, HasSubstr("solver.line_search.test = \"none\""));
  EXPECT_THAT(why.remedy, HasSubstr("textbook"));
}

// Every fallback modifies more elements, though each of their systems can be solved.
TEST(Explanation, FreeBodyIsExplainedAfterEveryFallback) {
  for (const char* method : {"newton", "newton_cg"}) {
    Model model = make_model(make_sphere(0.5, 0.6), {.young = 3e7, .poisson = 0.4, .gravity = {{-14, 26, 5}}});
    SimulationOptions options{.integrator = "quasi_static",
                              .solver = {.method = method, .definiteness = "progressive"}};
    options.solver.minimize.max_iterations = 20;
    Simulation simulation = simulate(std::move(model), options);
    const StepReport report = simulation.step();
    EXPECT_FALSE(is_success(report.status)) << method;
    EXPECT_THAT(explain(simulation, report).cause, HasSubstr("nothing holds the body")) << method;
  }
}

TEST(Explanation, StrictLineSearchNamesItsParameter) {
  SimulationOptions slide;
  slide.solver.minimize.line_search.test = DecreaseTest::slide;
  slide.solver.minimize.line_search.sufficient_decrease = 0.9;
  EXPECT_THAT(first_failure(slide, Status::stuck).remedy, HasSubstr("textbook"));

  SimulationOptions greedy;
  greedy.solver.minimize.line_search.sufficient_decrease = 0.9;
  greedy.solver.minimize.max_iterations = 50;
  EXPECT_THAT(first_failure(greedy, Status::iteration_limit).place, HasSubstr("c = 0.9"));
}

TEST(Explanation, IndefiniteExactHessianNamesDefiniteness) {
  SimulationOptions options{.integrator = "quasi_static"};
  options.solver.definiteness = "exact";
  Simulation simulation = simulate(beam(2, {.young = 1e5, .gravity = {{0, -2e3, 0}}}), options);
  EXPECT_THAT(first_failure(simulation, Status::no_descent).remedy, HasSubstr("on_demand"));
}

TEST(Explanation, InaccurateAdaptiveStepNamesTolerance) {
  Simulation simulation =
      simulate(beam(1), {.h = 0.01, .integrator = "forward_euler", .adaptive = {.tolerance = 1e-16}, .solver = {}});
  const StepReport report = simulation.step();
  ASSERT_EQ(report.status, Status::inaccurate);
  EXPECT_THAT(explain(simulation, report).place, HasSubstr("time.adaptive.tolerance = 1e-16"));
}

TEST(Explanation, UnsettledFrictionNamesPair) {
  Simulation simulation = simulate(beam(2), {});
  StepReport report = simulation.step();
  report.status = Status::inaccurate;
  report.friction_passes = 50;
  report.friction_residual = 2.5;
  report.friction_pair = "ear and foot";
  const Explanation why = explain(simulation, report);
  EXPECT_THAT(why.cause, HasSubstr("2.5 N"));
  EXPECT_THAT(why.place, HasSubstr("ear and foot"));
}

TEST(Explanation, UnsettledRimNamesPressure) {
  Simulation simulation = simulate(beam(2), {});
  StepReport report = simulation.step();
  report.status = Status::inaccurate;
  report.friction_passes = 50;
  EXPECT_THAT(explain(simulation, report).place, HasSubstr("body.pressure"));
}

TEST(Explanation, AdaptiveStepDoesNotSuggestShorterSteps) {
  const Explanation why = first_failure({.adaptive = {1e-14}, .solver = {}}, Status::iteration_limit);
  EXPECT_THAT(why.remedy, testing::AllOf(HasSubstr("time.adaptive.tolerance"), testing::Not(HasSubstr("shorten"))));
}

TEST(Explanation, InvertingPinsNameTet) {
  Model model = beam(2);
  model.pins.push_back({"mirror", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] > 3 - 1e-9; }),
                        [](const Vec3d& X, double t) {
                          return X + Vec3d{{1e2 * t * (7 - 2 * X[0]), 0, 0}};
                        }});
  Simulation simulation = simulate(std::move(model));
  const StepReport report = simulation.step();
  ASSERT_FALSE(is_success(report.status));
  const Explanation why = explain(simulation, report);
  EXPECT_THAT(why.cause, HasSubstr("pins"));
  EXPECT_THAT(why.place, HasSubstr("tet "));
}

}  // namespace
}  // namespace aspic

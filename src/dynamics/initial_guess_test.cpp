#include "dynamics/initial_guess.h"

#include <gtest/gtest.h>

#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

SimulationOptions with_guess(const std::string& guess, const std::string& integrator = "backward_euler") {
  return {.integrator = integrator, .initial_guess = guess, .solver = {}};
}

TEST(InitialGuess, AllYieldSameMotion) {
  for (const char* integrator : {"backward_euler", "bdf2", "tr_bdf2", "midpoint"}) {
    std::vector<std::vector<double>> ends;
    for (const std::string& guess : initial_guess_names()) {
      SimulationOptions options = with_guess(guess, integrator);
      options.solver.minimize.tolerance = 1e-12;
      Simulation simulation = simulate(damped_beam_with_moving_pins_and_targets(), options);
      for (int i = 0; i < 5; ++i) {
        const StepReport report = simulation.step();
        EXPECT_TRUE(is_success(report.status)) << integrator << " " << guess;
        const bool needs_past = guess == "last_increment" || guess == "accelerated";
        if (guess != "best" && !(needs_past && i == 0)) {
          EXPECT_EQ(to_string(report.initial_guess), guess) << integrator;
        }
      }
      ends.push_back(simulation.state().q);
    }
    for (const std::vector<double>& end : ends)
      for (size_t i = 0; i < end.size(); ++i) EXPECT_NEAR(end[i], ends[0][i], 1e-8) << integrator;
  }
}

Simulation flying_box(const std::string& guess) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.gravity = {}});
  State start = at_rest(model.mesh);
  for (size_t i = 0; i < start.qdot.size(); i += 3) start.qdot[i] = 5;
  return Simulation(std::move(model), std::move(start), with_guess(guess));
}

TEST(InitialGuess, ExtrapolatedIsExactWithoutForces) {
  for (const auto& [guess, iterations] : {std::pair{"extrapolated", 0}, {"best", 0}, {"current", 1}, {"zero", 1}}) {
    Simulation simulation = flying_box(guess);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(simulation.step().iterations, iterations) << guess;
  }
  Simulation simulation = flying_box("last_increment");
  simulation.step();  // no previous step
  EXPECT_EQ(simulation.step().iterations, 0);
}

TEST(InitialGuess, AcceleratedIsExactInFreeFall) {
  for (const char* integrator : {"backward_euler", "midpoint"})
    for (const char* guess : {"accelerated", "best"}) {
      Simulation simulation =
          simulate(make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {}), with_guess(guess, integrator));
      simulation.step();
      for (int i = 0; i < 3; ++i) {
        const StepReport report = simulation.step();
        EXPECT_EQ(report.iterations, 0) << integrator << " " << guess;
        EXPECT_EQ(report.initial_guess, InitialGuess::accelerated) << integrator << " " << guess;
      }
    }
}

TEST(InitialGuess, BestIsRestShapeOfReturningBody) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.gravity = {}});
  model.pins.push_back({"floor", vertices_where(model.mesh, [](const Vec3d& X) { return X[1] < 1e-9; }), {}});
  State start = at_rest(model.mesh);
  for (size_t i = 1; i < start.q.size(); i += 3) start.q[i] *= 1.3;
  Simulation simulation(std::move(model), std::move(start), with_guess("zero", "quasi_static"));
  const StepReport report = simulation.step();
  EXPECT_EQ(report.initial_guess, InitialGuess::zero);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(simulation.state().q, at_rest(simulation.model().mesh).q);
}

TEST(InitialGuess, AllPlacePinnedVertices) {
  for (const std::string& guess : initial_guess_names()) {
    Simulation simulation = simulate(damped_beam_with_moving_pins_and_targets(), with_guess(guess));
    simulation.step();
    const Pin& crank = simulation.model().pins[1];
    for (const int v : crank.vertices)
      EXPECT_EQ(simulation.state().q[3 * v + 1], crank.motion(simulation.model().mesh.rest[v], 0.01)[1]) << guess;
  }
}

TEST(InitialGuess, ReplacesGuessOfInfiniteEnergy) {
  // Vertices move apart so fast that the extrapolated shape is inverted, where the energy is infinite.
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}), {.young = 1e6, .gravity = {}});
  State start = at_rest(model.mesh);
  for (size_t i = 0; i < start.q.size(); i += 3) start.qdot[i] = -150 * start.q[i];
  Simulation simulation(std::move(model), std::move(start), with_guess("extrapolated"));
  const StepReport report = simulation.step();
  EXPECT_TRUE(is_success(report.status));
  EXPECT_EQ(report.initial_guess, InitialGuess::current);
  EXPECT_GT(report.min_det_F, 0);
}

TEST(InitialGuess, LastIncrementSavesIterationsOfSteadyLoading) {
  const auto iterations = [](const std::string& guess) {
    Model model = beam(1, {.gravity = {}});
    model.pins.push_back({"hand", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] > 4 - 1e-9; }),
                          [](const Vec3d& X, double t) {
                            return X + Vec3d{{t, 0, 0}};
                          }});
    Simulation simulation =
        simulate(std::move(model), {.h = 0.1, .integrator = "quasi_static", .initial_guess = guess, .solver = {}});
    int sum = 0;
    for (int i = 0; i < 10; ++i) sum += simulation.step().iterations;
    return sum;
  };
  EXPECT_LT(iterations("last_increment"), iterations("current"));
  EXPECT_LE(iterations("best"), iterations("last_increment"));
}

TEST(InitialGuess, IsNoneForExplicitSchemes) {
  EXPECT_EQ(simulate(beam(1), {.h = 1e-4, .integrator = "rk4", .solver = {}}).step().initial_guess, InitialGuess::none);
}

}  // namespace
}  // namespace aspic

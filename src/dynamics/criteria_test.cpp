// The stopping criteria of a step: what each of them promises is kept.
#include <gmock/gmock.h>

#include "base/error.h"
#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

struct Solved {
  StepReport report;
  std::vector<double> q;
};

// The third step of a falling, bending beam.
Solved third_step(Criterion criterion, double tolerance, double length_unit = 1) {
  SimulationOptions options;
  options.solver.linear = "cholesky";
  Model model = make_model(make_box({{0, 0, 0}}, {{4 * length_unit, length_unit, length_unit}}, {8, 2, 2}),
                           {.young = 1e5 * length_unit * length_unit, .gravity = {{0, -9.81 * length_unit, 0}}});
  model.pins.push_back({"wall", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] < 1e-9; }), {}});
  Simulation simulation = simulate(std::move(model), options);
  simulation.step();
  simulation.step();
  options.solver.minimize.criterion = criterion;
  options.solver.minimize.tolerance = tolerance;
  simulation.set_solver(options.solver);
  const StepReport report = simulation.step();
  return {report, simulation.state().q};
}

double largest_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); i += 3)
    largest = std::max(largest, std::hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]));
  return largest;
}

const std::vector<double>& minimiser() {
  static const std::vector<double> q = third_step(Criterion::scale, 1e-12).q;
  return q;
}

// The step along the last direction is taken, so what is left is smaller still.
TEST(Criteria, AVelocityBoundsTheErrorOfTheVelocity) {
  const double h = 0.01;
  for (const double tolerance : {1e-2, 1e-4}) {  // [m/s]
    const Solved solved = third_step(Criterion::velocity, tolerance);
    EXPECT_EQ(solved.report.status, Status::converged);
    EXPECT_LE(largest_distance(solved.q, minimiser()), tolerance * h);
  }
}

TEST(Criteria, AnAccelerationBoundsTheErrorOfTheAcceleration) {
  const double h = 0.01;
  for (const double tolerance : {1.0, 1e-2}) {  // [m/s^2]
    const Solved solved = third_step(Criterion::acceleration, tolerance);
    EXPECT_EQ(solved.report.status, Status::converged);
    EXPECT_LE(largest_distance(solved.q, minimiser()), tolerance * h * h);
  }
}

TEST(Criteria, ATighterOneTakesMoreIterations) {
  for (const Criterion criterion : {Criterion::velocity, Criterion::acceleration, Criterion::decrement})
    EXPECT_LT(third_step(criterion, 1e3).report.iterations, third_step(criterion, 1e-9).report.iterations)
        << to_string(criterion);
}

// Lengths in another unit, with stresses and forces that fit: the same motion to scale.
TEST(Criteria, ThoseWithoutAUnitTakeTheSameIterationsInEveryUnit) {
  for (const Criterion criterion : {Criterion::scale, Criterion::first_gradient, Criterion::decrement}) {
    const int iterations = third_step(criterion, 1e-7).report.iterations;
    for (const double unit : {1e-3, 1e2}) {
      EXPECT_EQ(third_step(criterion, 1e-7, unit).report.iterations, iterations) << to_string(criterion) << unit;
    }
  }
}

TEST(Criteria, AnAbsoluteOneIsInNewtons) {
  const Solved solved = third_step(Criterion::absolute, 1e-3);
  EXPECT_EQ(solved.report.status, Status::converged);
  EXPECT_DOUBLE_EQ(solved.report.residual_threshold, 1e-3);
  EXPECT_LE(solved.report.residual, 1.01e-3);
  EXPECT_GT(solved.report.residual, 1e-11);  // no more than was asked for
}

TEST(Criteria, ThoseThatJudgeDirectionsNeedDirectionsThatEstimateTheMinimiser) {
  for (const Criterion criterion : {Criterion::velocity, Criterion::acceleration, Criterion::decrement}) {
    SimulationOptions options;
    options.solver.method = "gradient_descent";
    options.solver.minimize.criterion = criterion;
    EXPECT_THAT(([&] { simulate(beam(1), options).step(); }),
                testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("scale")));
  }
}

}  // namespace
}  // namespace aspic

// Gas and liquid in a hollow sphere.
#include "energy/cavity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "base/error.h"
#include "dynamics/incremental_potential.h"
#include "dynamics/models_test.h"
#include "dynamics/pins.h"
#include "dynamics/state.h"
#include "dynamics/step_derivatives.h"
#include "mesh/tet_nodes.h"
#include "reference/hollow_sphere.h"
#include "reference/statics.h"

namespace aspic {
namespace {

using namespace testing_models;

TetMesh ball(int order) {  // radii 1 and 2 m
  TetMesh mesh = hollow_sphere(octahedral_sphere(1), 1, 1, 2);
  return order == 2 ? raise_order(std::move(mesh)) : mesh;
}

std::vector<Face> faces_within(const TetMesh& mesh, double radius) {
  return verify::faces_where(mesh, [radius](const Vec3d& X) { return norm(X) < radius; });
}

bool is_held(const Vec3d& X) { return X[0] > 0.9 && norm(X) > 1.99; }

CavityContent content(CavityContent::Kind kind, std::function<double(double)> amount) {
  return {kind, kind == CavityContent::gas ? 2e3 : 1e6, std::move(amount)};
}

ModelBuilder ball_builder(int order) { return model_of(ball(order), {.young = 1e4, .poisson = 0.3, .gravity = {}}); }

Model filled_ball(CavityContent inside, int order = 1) {
  const TetMesh mesh = ball(order);
  return ball_builder(order)
      .load(make_cavity("cavity", mesh, faces_within(mesh, 1.01), std::move(inside), at_rest(mesh).q))
      .pin("hold", is_held)
      .build();
}

SimulationOptions statics(const std::string& linear = "auto") {
  SimulationOptions options{.h = 1, .integrator = "quasi_static"};
  options.solver.linear = linear;
  options.solver.minimize.tolerance = 1e-10;
  return options;
}

TEST(Cavity, DerivativesMatchDifferences) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.05, 0.05);
  for (const auto kind : {CavityContent::gas, CavityContent::liquid})
    for (const int order : {1, 2}) {
      Model model = filled_ball(content(kind, [](double) { return 1.7; }), order);
      std::vector<double> x = at_rest(model.mesh).q;
      for (double& xi : x) xi += noise(random);
      const Pins pins(model.pins, x);
      const IncrementalPotential E(model, pins);  // binds the terms
      const DerivativeReport report =
          check_derivatives(differentiable(ActiveTerm(*model.loads.back()), E.pattern()), x, {.length = 0.2});
      for (const DerivativeCheck* check : {&report.gradient, &report.hessian})
        EXPECT_TRUE(check->passed) << kind << " " << order << ": " << check->smallest_error;
    }
}

TEST(Cavity, PressureIsThatOfALoadWithTheSameShape) {
  for (const int order : {1, 2}) {
    Simulation filled(filled_ball(content(CavityContent::liquid, [](double) { return 1.5; }), order), statics());
    const StepReport report = filled.step();
    ASSERT_TRUE(is_success(report.status)) << to_string(report.status);
    const double p = report.cavities[0].pressure;
    EXPECT_GT(p, 500);
    const TetMesh mesh = ball(order);
    Simulation loaded(ball_builder(order)
                          .pressure("pressure", faces_within(mesh, 1.01), [p](double t) { return p * t; })
                          .pin("hold", is_held)
                          .build(),
                      statics());
    take_steps(loaded, 1, "pressure");
    EXPECT_LT(largest_difference(filled.state().q, loaded.state().q), 1e-6);
  }
}

TEST(Cavity, GasKeepsPressureTimesVolume) {
  Simulation simulation(filled_ball(content(CavityContent::gas, [](double t) { return 1 + t; })), statics());
  const double start = simulation.start_report().cavities[0].volume;
  EXPECT_NEAR(start, 4 * std::numbers::pi / 3, 0.45 * start);  // a coarse ball
  for (int i = 1; i <= 3; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(is_success(report.status));
    const auto [volume, pressure] = report.cavities[0];
    EXPECT_NEAR((2e3 + pressure) * volume, 2e3 * (1 + i) * start, 1e-9 * start);
    EXPECT_GT(volume, start);
  }
}

TEST(Cavity, LinearSolversAgreeInFewIterations) {
  std::vector<double> first;
  for (const char* linear : {"cholesky", "multigrid", "block_jacobi"}) {
    Simulation simulation(filled_ball(content(CavityContent::liquid, [](double) { return 1.3; })), statics(linear));
    const StepReport report = simulation.step();
    ASSERT_TRUE(is_success(report.status)) << linear;
    EXPECT_LE(report.iterations, 16) << linear;
    if (first.empty()) first = simulation.state().q;
    EXPECT_LT(largest_difference(simulation.state().q, first), 1e-7) << linear;
  }
}

TEST(Cavity, BalancesLedgerForEveryIntegrator) {
  for (const std::string& integrator : integrator_names()) {
    const double h = is_explicit(integrator) ? 1e-4 : 0.02;
    Simulation simulation =
        simulate(filled_ball(content(CavityContent::gas, [](double t) { return 1 + std::sin(20 * t); })),
                 {.h = h, .integrator = integrator, .solver = {}});
    double largest = 0;
    for (int i = 0; i < 10; ++i) {
      const StepReport report = simulation.step();
      ASSERT_TRUE(is_success(report.status)) << integrator << " " << to_string(report.status);
      for (const double V : report.potential) largest = std::max(largest, std::abs(V));
      EXPECT_LT(std::abs(report.ledger_error), 1e-10 * largest) << integrator;
    }
  }
}

// A liquid without compression leaves modes that keep the volume; among those of a free sphere, breathing does not.
TEST(Cavity, LiquidStiffensOneModeAlone) {
  const TetMesh mesh = ball(1);
  const Model empty = ball_builder(1).build();
  const Model filled =
      ball_builder(1)
          .load(make_cavity("cavity", mesh, faces_within(mesh, 1.01),
                            content(CavityContent::liquid, [](double) { return 1.0; }), at_rest(mesh).q))
          .build();
  const int count = 40;
  const std::vector<double> without = frequencies(empty, count), with = frequencies(filled, count);
  int raised = 0;
  for (int k = 0; k < count; ++k) {
    EXPECT_GE(with[k], without[k] * (1 - 1e-6) - 1e-3) << k;
    raised += k + 1 < count && with[k] > without[k + 1] * (1 + 1e-6) + 1e-3;
  }
  EXPECT_EQ(raised, 0);  // rank one: eigenvalues interlace
  EXPECT_GT(with[count - 1], without[count - 1] * (1 + 1e-6));
}

TEST(Cavity, RefusesTheOuterSurface) {
  const TetMesh mesh = ball(1);
  const std::vector<Face> outside = verify::faces_where(mesh, [](const Vec3d& X) { return norm(X) > 1.01; });
  EXPECT_LT(cavity_volume(mesh, outside), 0);
  EXPECT_THROW(
      make_cavity("cavity", mesh, outside, content(CavityContent::gas, [](double) { return 1.0; }), at_rest(mesh).q),
      InvalidInput);
}

}  // namespace
}  // namespace aspic

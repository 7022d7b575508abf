#include "dynamics/pressure_load.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dynamics/models_test.h"
#include "reference/statics.h"

namespace aspic {
namespace {

using namespace testing_models;

bool is_top(const Vec3d& X) { return X[2] > 1 - 1e-9; }

Model pressed_beam() {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{4, 1, 1}}, {8, 2, 2});
  return beam_builder(2, {.young = 1e5, .poisson = 0.3})
      .pressure("pressure", verify::faces_where(mesh, [](const Vec3d& X) { return is_top(X) && X[0] > 1 - 1e-9; }),
                [](double t) { return 500 * std::min(1.0, 5 * t); })
      .rayleigh_damping(0.5, 1e-3)
      .build();
}

TEST(OpenPressure, BalancesLedgerForEveryIntegrator) {
  for (const std::string& integrator : integrator_names()) {
    const double h = is_explicit(integrator) ? 1e-4 : 0.02;
    Simulation simulation = simulate(pressed_beam(), {.h = h, .integrator = integrator, .solver = {}});
    double largest = 0, without_potential = 0;
    for (int i = 0; i < 20; ++i) {
      const StepReport report = simulation.step();
      ASSERT_TRUE(is_success(report.status)) << integrator << " " << to_string(report.status);
      for (const double V : report.potential) largest = std::max(largest, std::abs(V));
      EXPECT_LT(std::abs(report.ledger_error), 1e-11 * largest) << integrator;
      EXPECT_GE(report.damping_loss, 0) << integrator;
      without_potential += report.nonconservative_work;
    }
    EXPECT_NE(without_potential, 0) << integrator;
  }
}

std::vector<double> end_of_swing(const std::string& integrator, double h) {
  Simulation simulation = simulate(pressed_beam(), {.h = h, .integrator = integrator, .solver = {}});
  take_steps(simulation, static_cast<int>(std::lround(0.16 / h)), integrator);
  return simulation.state().q;
}

TEST(OpenPressure, KeepsOrderOfIntegrators) {
  const std::vector<double> exact = end_of_swing("rk4", 2e-4);
  for (const auto& [integrator, order] : {std::pair("midpoint", 2.0), {"tr_bdf2", 2.0}, {"backward_euler", 1.0}}) {
    const double coarse = largest_difference(end_of_swing(integrator, 0.004), exact);
    const double fine = largest_difference(end_of_swing(integrator, 0.002), exact);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.25) << integrator << " " << coarse << " " << fine;
  }
}

// A face moves up, turns by an angle about its center, moves down, and turns back. The pressure p does the work
// -p A d going up and p A d cos(angle) going down, so that the loop has no potential.
TEST(OpenPressure, DoesWorkInClosedLoop) {
  constexpr double kAngle = 0.7, kWay = 0.5, kPressure = 200;
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2});
  const auto motion = [=](const Vec3d& X, double t) {
    const auto part = [t](double from) { return std::clamp(t - from, 0.0, 1.0); };
    const double angle = kAngle * (part(1) - part(3)), c = std::cos(angle), s = std::sin(angle);
    const Vec3d d = X - Vec3d{{0.5, 0.5, 1}};
    return Vec3d{{0.5 + c * d[0] + s * d[2], X[1], 1 + kWay * (part(0) - part(2)) - s * d[0] + c * d[2]}};
  };
  Model model = model_of(mesh, {.young = 1e4, .poisson = 0.3, .gravity = {}})
                    .pin(
                        "all", [](const Vec3d&) { return true; }, motion)
                    .pressure("pressure", verify::faces_where(mesh, is_top), [](double) { return kPressure; })
                    .build();
  Simulation simulation = simulate(std::move(model), {.h = 1.0 / 64, .integrator = "quasi_static", .solver = {}});
  double without_potential = 0, pins = 0, potential = 0;
  for (int i = 0; i < 256; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(is_success(report.status));
    without_potential += report.nonconservative_work;
    pins += report.pin_work;
    potential = report.potential[1];
  }
  const double expected = kPressure * kWay * (std::cos(kAngle) - 1);
  EXPECT_NEAR(potential, 0, 1e-10);
  EXPECT_NEAR(pins, -expected, 1e-9 * std::abs(expected));
  EXPECT_NEAR(without_potential, expected, 0.05 * std::abs(expected));  // of first order in the step
}

TEST(OpenPressure, FormFollowsRimAndPins) {
  const auto form_of = [](const auto& prepare, bool starts_at_rest = true) {
    Model model = beam(1);
    prepare(model);
    const std::vector<Face> end = verify::faces_where(model.mesh, [](const Vec3d& X) { return X[0] > 4 - 1e-9; });
    return add_pressure({"pressure", end, [](double) { return 1.0; }, starts_at_rest}, model);
  };
  const auto at_end = [](const Model& model) {
    return vertices_where(model.mesh, [](const Vec3d& X) { return X[0] > 4 - 1e-9; });
  };
  const auto pinned = [&](Model& model) { model.pins.push_back({"end", at_end(model), {}}); };
  const auto guided = [&](Model& model) { model.pins.push_back({"end", at_end(model), {}, {{{1, 0, 0}}}}); };
  const auto moved = [&](Model& model) {
    model.pins.push_back({"end", at_end(model), [](const Vec3d& X, double) { return X; }});
  };
  EXPECT_EQ(form_of([](Model&) {}), PressureForm::open);
  EXPECT_EQ(form_of(pinned), PressureForm::fixed_rim);
  EXPECT_EQ(form_of(pinned, false), PressureForm::open);
  EXPECT_EQ(form_of(guided), PressureForm::open);
  EXPECT_EQ(form_of(moved), PressureForm::open);
  Model model = beam(1);
  EXPECT_EQ(
      add_pressure({"all", boundary_faces(model.mesh, 0, model.mesh.tet_count()), [](double) { return 1.0; }}, model),
      PressureForm::closed);
}

}  // namespace
}  // namespace aspic

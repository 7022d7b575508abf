// Determinism, restart, interruption, failures and rejected input.
#include "dynamics/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/parallel.h"
#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

std::vector<double> state_after(const SimulationOptions& options, int threads) {
  set_thread_count(threads);
  Simulation simulation = simulate(damped_beam_with_moving_pins_and_targets(3), options);
  for (int i = 0; i < 3; ++i) simulation.step();
  std::vector<double> result = simulation.state().q;
  result.insert(result.end(), simulation.state().qdot.begin(), simulation.state().qdot.end());
  return result;
}

// Returns every integrator with the default guess and one that uses the previous step, and with adaptive steps if
// supported.
std::vector<SimulationOptions> all_ways() {
  std::vector<SimulationOptions> ways;
  for (const std::string& integrator : integrator_names()) {
    const SimulationOptions plain{.h = is_explicit(integrator) ? 1e-4 : 0.01, .integrator = integrator, .solver = {}};
    ways.push_back(plain);
    if (make_integrator(integrator)->facts().chooses_guess()) {
      ways.push_back(plain);
      ways.back().initial_guess = "last_increment";
    }
  }
  for (const std::string& integrator : adaptive_integrator_names())
    ways.push_back({.h = is_explicit(integrator) ? 5e-4 : 0.01,
                    .integrator = integrator,
                    .adaptive = {.tolerance = 1e-4},
                    .solver = {}});
  return ways;
}

std::string description(const SimulationOptions& way) {
  return way.integrator + ", " + way.initial_guess + (way.adaptive.tolerance > 0 ? ", adaptive" : "");
}

TEST(Simulation, IsBitReproducibleOverThreads) {
  const int before = thread_count();
  for (const SimulationOptions& way : all_ways()) {
    const std::vector<double> one = state_after(way, 1);
    for (const int threads : {2, 3}) EXPECT_EQ(state_after(way, threads), one) << description(way) << " " << threads;
  }
  set_thread_count(before);
}

TEST(Simulation, IsBitReproducibleAfterRestore) {
  constexpr int kSteps = 4;
  for (const SimulationOptions& way : all_ways()) {
    Simulation whole = simulate(damped_beam_with_moving_pins_and_targets(), way);
    std::vector<Simulation::Snapshot> snapshots = {whole.snapshot()};
    std::vector<StepReport> reports;
    for (int i = 0; i < kSteps; ++i) {
      reports.push_back(whole.step());
      ASSERT_TRUE(is_success(reports.back().status)) << description(way) << to_string(reports.back().status);
      snapshots.push_back(whole.snapshot());
    }
    for (int k = 0; k <= kSteps; ++k) {
      Simulation resumed = simulate(damped_beam_with_moving_pins_and_targets(), way);
      resumed.restore(snapshots[k]);
      for (int i = k; i < kSteps; ++i) {
        const StepReport report = resumed.step();
        EXPECT_EQ(report.step, reports[i].step);
        EXPECT_EQ(report.initial_guess, reports[i].initial_guess) << description(way);
        EXPECT_EQ(report.substeps, reports[i].substeps) << description(way);
        EXPECT_EQ(report.rejected, reports[i].rejected) << description(way);
        EXPECT_EQ(report.potential, reports[i].potential) << description(way);
        EXPECT_EQ(report.pin_work, reports[i].pin_work) << description(way);
      }
      EXPECT_EQ(resumed.state().q, whole.state().q) << description(way) << " from " << k;
      EXPECT_EQ(resumed.state().qdot, whole.state().qdot) << description(way) << " from " << k;
    }
  }
}

TEST(Simulation, RejectsCheckpointOfAnotherSize) {
  Simulation simulation = simulate(beam(1), {.integrator = "bdf2", .solver = {}});
  simulation.step();
  Simulation::Snapshot snapshot = simulation.snapshot();
  snapshot.previous->q.pop_back();
  EXPECT_THROW(simulation.restore(snapshot), InvalidInput);
  Simulation adaptive = simulate(beam(1), {.adaptive = {.tolerance = 1e-3}, .solver = {}});
  for (const double level : {99.0, -1.0, 1e300, static_cast<double>(NAN)}) {
    snapshot.level = level;
    EXPECT_THROW(adaptive.restore(snapshot), InvalidInput) << level;
  }
}

TEST(Simulation, InterruptedStepKeepsState) {
  Simulation simulation = simulate(beam(2));
  const State before = simulation.state();
  const StepReport report = simulation.step({}, StopToken([] { return true; }));
  EXPECT_EQ(report.status, Status::interrupted);
  EXPECT_EQ(simulation.state().q, before.q);
  EXPECT_EQ(simulation.state().time, before.time);
  EXPECT_EQ(simulation.steps_taken(), 0);
}

TEST(Simulation, RepeatedStepIsBitReproducible) {
  Simulation smooth = simulate(damped_beam_with_moving_pins_and_targets());
  Simulation disturbed = simulate(damped_beam_with_moving_pins_and_targets());
  for (int i = 0; i < 3; ++i) {
    const StepReport expected = smooth.step();
    EXPECT_EQ(disturbed.step({}, StopToken([] { return true; })).status, Status::interrupted);
    const StepReport report = disturbed.step();
    EXPECT_EQ(report.pin_work, expected.pin_work);  // also the work of targets, which must return to the start
    EXPECT_EQ(report.ledger_error, expected.ledger_error);
    EXPECT_EQ(disturbed.state().q, smooth.state().q);
  }
}

TEST(Simulation, ReportsUnconvergedStep) {
  SimulationOptions options;
  options.solver.minimize.max_iterations = 1;
  options.solver.minimize.tolerance = 1e-12;
  const StepReport report = simulate(beam(2, {.young = 1e4}), options).step();
  EXPECT_EQ(report.status, Status::iteration_limit);
  EXPECT_GT(report.residual, report.residual_threshold);
}

TEST(Simulation, OverflowIsNotSuccess) {
  State start = at_rest(beam(1).mesh);
  for (size_t i = 0; i < start.qdot.size(); i += 3) start.qdot[i] = 1e200;  // its square overflows
  for (const std::string& integrator : integrator_names()) {
    if (integrator == "quasi_static") continue;  // has no velocities
    Simulation simulation(beam(1, {.material = "neo_hookean"}), start, {.integrator = integrator, .solver = {}});
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(is_success(simulation.step().status)) << integrator;
  }
}

TEST(Simulation, TooShortStepIsNotSuccess) {
  Simulation simulation = simulate(beam(2), {.h = 1e-9, .integrator = "backward_euler", .solver = {}});
  bool success = true;
  for (int i = 0; i < 5 && success; ++i) success = is_success(simulation.step().status);
  EXPECT_FALSE(success);
}

TEST(Simulation, BodyAtRestIsSuccess) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.gravity = {}});
  State start = at_rest(model.mesh);
  for (size_t i = 0; i < start.q.size(); i += 3) {  // rotated and translated, so that no force is exactly zero
    const double x = start.q[i], y = start.q[i + 1];
    start.q[i] = 0.6 * x - 0.8 * y + 0.3;
    start.q[i + 1] = 0.8 * x + 0.6 * y - 7.1;
  }
  Simulation simulation(std::move(model), start, {});
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(is_success(simulation.step().status));
}

TEST(Simulation, TimeIsMultipleOfStep) {
  Simulation simulation = simulate(beam(1));
  for (int i = 0; i < 100; ++i) simulation.step();
  EXPECT_EQ(simulation.state().time, 100 * 0.01);
}

TEST(Simulation, ExplodingExplicitSchemeEndsUndefined) {
  Simulation simulation = simulate(beam(2), {.h = 0.1, .integrator = "forward_euler", .solver = {}});
  Status last = Status::converged;
  bool was_unstable = false;
  for (int i = 0; i < 400 && last != Status::undefined; ++i) {
    last = simulation.step().status;
    was_unstable |= last == Status::unstable;
  }
  EXPECT_EQ(last, Status::undefined);
  EXPECT_TRUE(was_unstable);
}

TEST(Simulation, BlowUpKeepsPositionsAndAdvancesTime) {
  Simulation simulation = simulate(beam(2), {.h = 0.1, .integrator = "rk4", .solver = {}});
  for (int i = 0; i < 400; ++i) {
    const State before = simulation.state();
    const StepReport report = simulation.step();
    if (is_success(report.status) || report.status == Status::unstable) continue;
    EXPECT_EQ(report.status, Status::undefined);
    EXPECT_EQ(simulation.state().q, before.q);
    EXPECT_EQ(simulation.state().time, 0.1 * (i + 1));
    EXPECT_TRUE(std::isfinite(report.kinetic + report.potential_total + report.residual));
    return;
  }
  ADD_FAILURE() << "steps far above the stability limit did not blow up";
}

TEST(Simulation, RejectsOptionsThatIntegratorIgnores) {
  const auto refusal = [](const SimulationOptions& options) -> std::string {
    try {
      simulate(beam(1), options);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "no error";
  };
  using testing::AllOf, testing::HasSubstr;
  for (const char* integrator : {"bdf2", "quasi_static"})
    EXPECT_THAT(refusal({.integrator = integrator, .adaptive = {.tolerance = 1e-3}, .solver = {}}),
                AllOf(HasSubstr(integrator), HasSubstr("tr_bdf2"), HasSubstr("rk4")));
  EXPECT_THAT(refusal({.adaptive = {.tolerance = -1}, .solver = {}}), HasSubstr("tolerance of adaptive steps is -1;"));
  EXPECT_THAT(refusal({.initial_guess = "curent", .solver = {}}), HasSubstr("did you mean 'current'"));
  for (const char* integrator : {"rk4", "forward_euler", "linearly_implicit_euler"})
    EXPECT_THAT(refusal({.integrator = integrator, .initial_guess = "zero", .solver = {}}),
                AllOf(HasSubstr("initial_guess"), HasSubstr(integrator)));
  EXPECT_THAT(refusal({.integrator = "quasi_static", .initial_guess = "extrapolated", .solver = {}}),
              HasSubstr("last_increment"));
}

TEST(Simulation, NewPinsHoldFromNextStep) {
  const auto with_pin = [](Model model, const std::string& name, std::vector<int> vertices) {
    model.pins.push_back({name, std::move(vertices), {}});
    return model;
  };
  for (const std::string& integrator : integrator_names()) {
    const SimulationOptions options{.h = is_explicit(integrator) ? 1e-4 : 0.01, .integrator = integrator, .solver = {}};
    Simulation from_start = simulate(with_pin(beam(2), "end", {24, 25, 26}), options), set = simulate(beam(2), options);
    std::vector<Pin> pins = set.model().pins;
    pins.push_back({"end", {24, 25, 26}, {}});
    set.step();
    set.set_pins(pins);
    set.restore(from_start.snapshot());
    for (int i = 0; i < 3; ++i) from_start.step(), set.step();
    EXPECT_EQ(set.state().q, from_start.state().q) << integrator;
  }
}

TEST(Simulation, RejectsBadModels) {
  const auto message = [](auto&& make) -> std::string {
    try {
      make();
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(message([] { simulate(beam(1), {.h = 0.01, .integrator = "backward_eular", .solver = {}}); }),
              testing::HasSubstr("did you mean 'backward_euler'"));
  EXPECT_THAT(message([] { simulate(beam(1, {.density = 0})); }), testing::HasSubstr("no mass"));
  EXPECT_THAT(message([] { simulate(beam(1), {.h = -1, .integrator = "backward_euler", .solver = {}}); }),
              testing::HasSubstr("h = -1"));
  EXPECT_THAT(message([] {
                Model model = beam(1);
                State start = at_rest(model.mesh);
                for (double& x : start.q) x = -x;
                Simulation(std::move(model), start, {});
              }),
              testing::HasSubstr("inverted"));
  EXPECT_THAT(message([] {
                Model model = beam(1, {.material = "fung"});
                State start = at_rest(model.mesh);
                for (size_t i = 0; i < start.q.size(); i += 3) start.q[i] *= 1000;  // overflows its exponential
                Simulation(std::move(model), start, {});
              }),
              testing::HasSubstr("exceeds the range of the material"));
}

}  // namespace
}  // namespace aspic

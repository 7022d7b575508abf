// Runs are bit-reproducible for any number of threads and after any restart: every integrator with every linear solver,
// and every modification of indefinite Hessians.
#include <gtest/gtest.h>

#include <cctype>

#include "base/hash.h"
#include "base/parallel.h"
#include "dynamics/models_test.h"
#include "dynamics/state.h"
#include "linalg/linear_solver.h"

namespace aspic {
namespace {

using namespace testing_models;

constexpr int kSteps = 50;

struct Way {
  SimulationOptions options;
  std::string name;
};

std::vector<Way> all_ways() {
  std::vector<Way> ways;
  const auto add = [&](SimulationOptions options, const std::string& name) { ways.push_back({options, name}); };
  for (const std::string& integrator : integrator_names()) {
    const SimulationOptions plain{.h = is_explicit(integrator) ? 2e-4 : 0.01, .integrator = integrator, .solver = {}};
    if (is_explicit(integrator)) {
      add(plain, integrator);
      continue;
    }
    for (const std::string& linear : linear_solver_names()) {
      add(plain, integrator + ", " + linear);
      ways.back().options.solver.linear = linear;
    }
  }
  for (const std::string& definiteness : definiteness_names()) {
    add({.solver = {.definiteness = definiteness}}, definiteness);
    add({.solver = {.linear = "block_jacobi", .definiteness = definiteness}}, definiteness + ", block_jacobi");
  }
  for (const std::string& method : minimizer_names()) {
    add({.solver = {.method = method}}, method);
    ways.back().options.solver.minimize.tolerance = 1e-3;
  }
  for (const std::string& integrator : adaptive_integrator_names())
    add({.h = is_explicit(integrator) ? 5e-4 : 0.01,
         .integrator = integrator,
         .adaptive = {.tolerance = 1e-4},
         .solver = {}},
        integrator + ", adaptive");
  return ways;
}

// 81 vertices with moving pins and loads.
Simulation small_scene(const Way& way) { return simulate(damped_beam_with_moving_pins_and_targets(2), way.options); }

class Determinism : public testing::TestWithParam<Way> {};

TEST_P(Determinism, RestartsChangeNoBit) {
  const Way& way = GetParam();
  Simulation whole = small_scene(way);
  std::vector<Simulation::Snapshot> snapshots;
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < kSteps; ++i) {
    snapshots.push_back(whole.snapshot());
    hashes.push_back(whole.step().state_hash);
  }
  for (int k = 0; k < kSteps; ++k) {
    Simulation resumed = small_scene(way);
    resumed.restore(snapshots[k]);
    // From every tenth step to the end; from other steps until all cached data have been recomputed.
    const int last = k % 10 == 1 ? kSteps : std::min(k + 3, kSteps);
    for (int i = k; i < last; ++i) ASSERT_EQ(resumed.step().state_hash, hashes[i]) << "step " << i + 1 << " from " << k;
  }
}

// 1 225 vertices: several chunks per loop.
TEST_P(Determinism, ThreadsChangeNoBit) {
  const int before = thread_count();
  std::vector<std::uint64_t> one;
  for (const int threads : {1, 2, 3, 8}) {
    set_thread_count(threads);
    Simulation simulation = simulate(damped_beam_with_moving_pins_and_targets(6), GetParam().options);
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < 2; ++i) hashes.push_back(simulation.step().state_hash);
    if (threads == 1) one = hashes;
    EXPECT_EQ(hashes, one) << threads << " threads";
  }
  set_thread_count(before);
}

INSTANTIATE_TEST_SUITE_P(Ways, Determinism, testing::ValuesIn(all_ways()), [](const auto& way) {
  std::string name = way.param.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

TEST(StateHash, DistinguishesStatesInAnyStorageOrder) {
  State state{{1, 2, 3, 4, 5, 6}, {0, 0, 0, 0, 0, 0}, 0};
  const std::uint64_t hash = state_hash(state, {});
  EXPECT_EQ(hex_digits(hash).size(), 16u);
  State stored{{4, 5, 6, 1, 2, 3}, {0, 0, 0, 0, 0, 0}, 0};
  EXPECT_NE(state_hash(stored, {}), hash);
  EXPECT_EQ(state_hash(stored, Renumbering({1, 0})), hash);
  state.qdot[5] = -0.0;  // differs only in the sign bit
  EXPECT_NE(state_hash(state, {}), hash);
}

// A clock that advances at each reading.
TEST(TimeLimit, DropsOnlyTheStepThatMissesIt) {
  for (const char* integrator : {"backward_euler", "tr_bdf2", "bdf2", "quasi_static"}) {
    double now = 0;
    SimulationOptions options{.integrator = integrator, .solver = {}, .clock = [&now] { return now += 1; }};
    Simulation whole = simulate(damped_beam_with_moving_pins_and_targets(), options);
    Simulation limited = simulate(damped_beam_with_moving_pins_and_targets(), options);
    int dropped = 0, taken = 0;
    for (int step = 0; step < 3; ++step) {
      const StepReport expected = whole.step();
      for (double limit = 1;; limit += 3) {
        const State before = limited.state();
        const StepReport report = limited.step({}, StopToken(options.clock, limit));
        if (report.status == Status::interrupted) {
          EXPECT_EQ(limited.state().q, before.q);
          EXPECT_EQ(limited.state().time, before.time);
          ++dropped;
          ASSERT_LT(limit, 1e5);
          continue;
        }
        EXPECT_EQ(report.status, expected.status);
        EXPECT_EQ(report.state_hash, expected.state_hash) << integrator << " after " << dropped << " attempts";
        ++taken;
        break;
      }
    }
    EXPECT_EQ(taken, 3);
    EXPECT_GT(dropped, 3) << integrator;
  }
}

}  // namespace
}  // namespace aspic

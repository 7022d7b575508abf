// Simulations with Maxwell branches: energies, restarts, dropped steps, refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "dynamics/models_test.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

using namespace testing_models;
using ::testing::HasSubstr;

const std::string kSupported[] = {"backward_euler", "linearly_implicit_euler", "quasi_static"};

// A bar whose end is pulled until 0.1 s, held, and released at 0.2 s.
Model bar(int order = 1, int n = 1) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{4, 1, 1}}, {4 * n, n, n});
  ModelBuilder builder = model_of(order == 2 ? raise_order(mesh) : mesh, {.young = 1e5, .poisson = 0.3});
  return builder.pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; })
      .load(make_point_springs("pull", {{mesh.vertex_count() - 1, 2e3,
                                         [](double t) {
                                           return Vec3d{{4 + (t < 0.2 ? 3 * std::min(t, 0.1) : 0), 1, 1}};
                                         }}}))
      .strain_rate_damping(20)
      .maxwell_branch(4e4, 0.03)
      .maxwell_branch(2e4, 1)
      .build();
}

void expect_closed(const SimulationOptions& options, int order) {
  Simulation simulation = simulate(bar(order), options);
  double energy = simulation.kinetic_energy(), flows = 0, stored = 0;
  for (const double V : simulation.potential_energies()) energy += V;
  for (int i = 0; i < 40; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(is_success(report.status)) << options.integrator << " " << to_string(report.status);
    ASSERT_EQ(report.potential.size(), simulation.potential_names().size());
    double largest = std::abs(report.kinetic);
    for (const double V : report.potential) largest = std::max(largest, std::abs(V));
    EXPECT_LT(std::abs(report.ledger_error), 1e-11 * largest) << options.integrator;
    flows += report.pin_work - report.damping_loss - report.numerical_loss + report.residual_work;
    EXPECT_NEAR(report.kinetic + report.potential_total, energy + flows, 1e-10 * largest) << options.integrator;
    EXPECT_EQ(report.potential.back(), simulation.potential_energies().back());
    EXPECT_GT(report.viscoelastic_loss, 0);
    EXPECT_GE(report.damping_loss, report.viscoelastic_loss * (1 - 1e-12));
    EXPECT_NE(report.energy_bound, EnergyBound::broken) << options.integrator << " step " << i;
    stored = std::max(stored, report.potential.back());
  }
  EXPECT_GT(stored, 0);
  EXPECT_EQ(simulation.potential_names().back(), "viscoelastic");
}

TEST(Viscoelastic, EnergyBalances) {
  for (const int order : {1, 2})
    for (const std::string& integrator : kSupported) expect_closed({.integrator = integrator, .solver = {}}, order);
}

TEST(Viscoelastic, EnergyBalancesOverSubsteps) { expect_closed({.adaptive = {.tolerance = 1e-3}, .solver = {}}, 1); }

TEST(Viscoelastic, EnergyBoundHolds) {
  Simulation simulation = simulate(bar());
  for (int i = 0; i < 40; ++i) EXPECT_EQ(simulation.step().energy_bound, EnergyBound::holds) << i;
}

TEST(Viscoelastic, RestoredRunHasTheSameBits) {
  for (const std::string& integrator : kSupported) {
    Simulation whole = simulate(bar(2), {.integrator = integrator, .solver = {}});
    Simulation resumed = simulate(bar(2), {.integrator = integrator, .solver = {}});
    for (int i = 0; i < 13; ++i) whole.step();
    const Simulation::Snapshot middle = whole.snapshot();
    for (int i = 0; i < 12; ++i) whole.step();
    resumed.restore(middle);
    EXPECT_EQ(resumed.state().internal, middle.state.internal);
    for (int i = 0; i < 12; ++i) resumed.step();
    EXPECT_EQ(resumed.state().q, whole.state().q);
    EXPECT_EQ(resumed.state_hash(), whole.state_hash());
    whole.restore(middle);  // back in time
    for (int i = 0; i < 12; ++i) whole.step();
    EXPECT_EQ(resumed.state_hash(), whole.state_hash());
  }
}

TEST(Viscoelastic, HashIncludesBranches) {
  Simulation simulation = simulate(bar());
  simulation.step();
  Simulation::Snapshot other = simulation.snapshot();
  const std::uint64_t hash = simulation.state_hash();
  other.state.internal[7] += 1e-9;
  simulation.restore(other);
  EXPECT_NE(simulation.state_hash(), hash);
  other.state.internal.pop_back();
  EXPECT_THROW(simulation.restore(other), InvalidInput);
}

TEST(Viscoelastic, InterruptedStepKeepsBranches) {
  Simulation simulation = simulate(bar());
  for (int i = 0; i < 15; ++i) simulation.step();
  const std::uint64_t hash = simulation.state_hash();
  const StepReport report = simulation.step({}, StopToken([] { return true; }));
  ASSERT_EQ(report.status, Status::interrupted);
  EXPECT_EQ(report.viscoelastic_loss, 0);
  EXPECT_EQ(report.ledger_error, 0);
  EXPECT_EQ(simulation.state_hash(), hash);
}

TEST(Viscoelastic, OtherIntegratorsRefuse) {
  for (const std::string& integrator : integrator_names()) {
    if (std::find(std::begin(kSupported), std::end(kSupported), integrator) != std::end(kSupported)) continue;
    try {
      simulate(bar(), {.h = 1e-4, .integrator = integrator, .solver = {}});
      ADD_FAILURE() << integrator;
    } catch (const InvalidInput& e) {
      EXPECT_THAT(e.what(), HasSubstr("choose backward_euler"));
    }
  }
}

TEST(Viscoelastic, AbsentBranchesHaveNoState) {
  Simulation simulation = simulate(beam(1));
  simulation.step();
  EXPECT_TRUE(simulation.state().internal.empty());
}

TEST(Viscoelastic, BuilderRejectsInvalidBranches) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
  EXPECT_THROW(ModelBuilder(mesh).maxwell_branch(-1, 1), InvalidInput);
  EXPECT_THROW(ModelBuilder(mesh).maxwell_branch(1, 0), InvalidInput);
}

// Order of the position of a pulled corner after 1 s of creep in quasi-static steps, from three step lengths.
double order_of_creep(const std::function<double(double)>& pull) {
  std::vector<double> x;
  for (const int steps : {10, 20, 40}) {
    const TetMesh mesh = make_box({{0, 0, 0}}, {{4, 1, 1}}, {4, 1, 1});
    Model model = model_of(mesh, {.young = 1e5, .poisson = 0.3, .gravity = {}})
                      .pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; })
                      .load(make_point_springs("pull", {{mesh.vertex_count() - 1, 2e3,
                                                         [=](double t) {
                                                           return Vec3d{{4 + pull(t), 1, 1}};
                                                         }}}))
                      .maxwell_branch(8e4, 0.5)
                      .build();
    SimulationOptions options{.h = 1.0 / steps, .integrator = "quasi_static", .solver = {}};
    options.solver.minimize.tolerance = 1e-11;
    Simulation simulation = simulate(std::move(model), options);
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(is_success(simulation.step().status));
    x.push_back(simulation.state().q[3 * (mesh.vertex_count() - 1)]);
  }
  return std::log2((x[0] - x[1]) / (x[1] - x[2]));
}

TEST(Viscoelastic, CreepIsOfSecondOrderUnderContinuousLoads) {
  EXPECT_NEAR(order_of_creep([](double t) { return t * t; }), 2, 0.1);
}

TEST(Viscoelastic, CreepAfterJumpIsOfFirstOrder) {
  EXPECT_NEAR(order_of_creep([](double) { return 1.0; }), 1, 0.1);
}

// Statics of a held strain: the stress decays as exp(-t / tau) although the body rests.
TEST(Viscoelastic, TimePassesInQuasiStatics) {
  Model model = model_of(make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}), {.young = 1, .gravity = {}})
                    .pin(
                        "ends", [](const Vec3d& X) { return X[2] < 1e-9 || X[2] > 1 - 1e-9; },
                        [](const Vec3d& X, double) {
                          return X + Vec3d{{0, 0, 0.1 * X[2]}};
                        })
                    .maxwell_branch(3, 0.5)
                    .build();
  Simulation simulation = simulate(std::move(model), {.h = 0.25, .integrator = "quasi_static", .solver = {}});
  State stretched = simulation.state();
  const double before = simulation.potential_energies().back();
  Simulation::Snapshot snapshot = simulation.snapshot();
  for (double& s : snapshot.state.internal) s = 1;
  simulation.restore(snapshot);
  const double start = simulation.potential_energies().back();
  simulation.step();
  EXPECT_EQ(before, 0);
  EXPECT_NEAR(start, (3 + 6) / (4 * 3.0), 1e-12);
  EXPECT_NEAR(simulation.potential_energies().back(), start * std::exp(-1.0), 1e-12);  // |s|^2 decays twice as fast
  EXPECT_EQ(simulation.state().q, stretched.q);
}

}  // namespace
}  // namespace aspic

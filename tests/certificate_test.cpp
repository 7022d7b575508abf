// What every step certifies, in every scene of the project: the ledger closes, and backward Euler keeps its bound.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "dynamics/ledger.h"
#include "dynamics/models_test.h"
#include "scene/scene.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using namespace testing_models;

constexpr int kManyTets = 20'000;

std::vector<fs::path> scene_files() {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(ASPIC_SOURCE_DIR) / "scenes"))
    if (entry.path().extension() == ".toml") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

double largest_term(const StepReport& report) {
  double largest = std::max({std::abs(report.kinetic), std::abs(report.pin_work), std::abs(report.damping_loss),
                             std::abs(report.numerical_loss), std::abs(report.residual_work)});
  for (const double V : report.potential) largest = std::max(largest, std::abs(V));
  return largest;
}

class CertifiedScene : public testing::TestWithParam<fs::path> {};

TEST_P(CertifiedScene, ClosesItsLedgerAndKeepsTheBound) {
  if (GetParam().stem() == "bunny" && !fs::exists(fs::path(ASPIC_SOURCE_DIR) / "assets" / "bunny.mesh"))
    GTEST_SKIP() << "no assets/bunny.mesh: ./run makes it";
  Scene scene = load_scene(GetParam());
  const int tets = scene.simulation.model().mesh.tet_count();
  for (int i = 0; i < (tets > kManyTets ? 1 : 5); ++i) {
    const StepReport report = scene.simulation.step();
    EXPECT_LE(std::abs(report.ledger_error), 1e-9 * largest_term(report)) << "step " << report.step;
    EXPECT_NE(report.energy_bound, EnergyBound::broken)
        << "step " << report.step << " by " << -report.energy_slack << " J";
    EXPECT_TRUE(is_success(report.status)) << to_string(report.status);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, CertifiedScene, testing::ValuesIn(scene_files()),
                         [](const auto& file) { return file.param.stem().string(); });

// Whatever the length of the step.
TEST(EnergyBound, HoldsForStepsOfAnyLength) {
  for (const double h : {1e-3, 1e-2, 0.1, 1.0, 10.0})
    for (const char* material : {"neo_hookean", "neo_hookean_log", "corotated"}) {
      Simulation simulation = simulate(beam(2, {.material = material, .young = 1e5}), {.h = h, .solver = {}});
      for (int i = 0; i < 5; ++i) {
        const StepReport report = simulation.step();
        EXPECT_EQ(report.energy_bound, EnergyBound::holds) << material << ", h = " << h << ", step " << report.step;
      }
    }
}

// Nothing but the body's own energies: what the bound allows to be lost is what the ledger says was lost.
TEST(EnergyBound, HasTheSlackOfItsDefinition) {
  Simulation simulation = simulate(beam(2));
  double before = simulation.kinetic_energy();
  for (const double V : simulation.potential_energies()) before += V;
  for (int i = 0; i < 5; ++i) {
    const State start = simulation.state();
    const StepReport report = simulation.step();
    std::vector<double> jump = simulation.state().qdot, Mjump(jump.size());
    for (size_t k = 0; k < jump.size(); ++k) jump[k] -= start.qdot[k];
    const double lost = kinetic_energy(*simulation.model().mass, jump, Mjump);
    EXPECT_NEAR(report.energy_slack, before - report.potential_total - lost, 1e-10 * (std::abs(before) + 1));
    before = report.kinetic + report.potential_total;
  }
}

TEST(EnergyBound, IsJudgedOnlyWhereItIsGuaranteed) {
  const BoundedEnergies energies{.allowed = 2, .reached = 1, .magnitude = 3};
  EXPECT_EQ(energy_bound(energies, 1.5), EnergyBound::holds);
  EXPECT_EQ(energy_bound(energies, 2.5), EnergyBound::not_guaranteed);
  EXPECT_EQ(energy_bound({.allowed = 2, .reached = 2.1, .magnitude = 3}, 1.5), EnergyBound::broken);
  EXPECT_EQ(energy_bound({.allowed = 2, .reached = 2 + 1e-13, .magnitude = 3}, 2), EnergyBound::holds);
  EXPECT_EQ(energy_bound({.allowed = 2, .reached = 1, .magnitude = 3, .pins_moved = true}, 1.5),
            EnergyBound::not_guaranteed);
  Simulation midpoint = simulate(beam(1), {.integrator = "midpoint", .solver = {}});
  EXPECT_EQ(midpoint.step().energy_bound, EnergyBound::none);
  Simulation moved = simulate(damped_beam_with_moving_pins_and_targets());
  EXPECT_EQ(moved.step().energy_bound, EnergyBound::not_guaranteed);
}

}  // namespace
}  // namespace aspic
